/* draw/images.c: bodies on either side of the cell's border, and the border [draw/images.h]. */
#include "draw/images.h"

#include "state/placement.h"

#include <stdlib.h>
#include <string.h>

/* Whether body i has an image by shift[] that reaches into the cell */
static bool reaches(const struct packing *p, const vec3 inverse[3], int64_t i,
                    const int8_t shift[3])
{
    vec3 d = v3_sub(p->x[i], p->cell.origin);
    for (int k = 0; k < 3; k++) {
        double u = v3_dot(inverse[k], d) + shift[k], r = p->radius[i] * v3_norm(inverse[k]);
        if (shift[k] && (u + r < 0 || u - r > 1)) return false;
    }
    return true;
}

/* shift[] = the k-th of 26, by -1, 0 or 1 edges; whether all of these repeat */
static bool shift_of(const struct cell *c, int k, int8_t shift[3])
{
    bool repeats = true;
    for (int j = 0; j < 3; j++, k /= 3) {
        shift[j] = (int8_t)(k % 3 - 1);
        repeats = repeats && (!shift[j] || c->repeats[j]);
    }
    return repeats && (shift[0] || shift[1] || shift[2]);
}

/* Body `to` of q = body i of p, moved */
static void images_copy_body(struct packing *q, int64_t to, const struct packing *p, int64_t i,
                             vec3 by)
{
    packing_copy_body(q, to, p, i);
    q->x[to] = v3_add(p->x[i], by);
}

/* Fills q, or counts only where it is NULL: the bodies, then their images. */
static int64_t images_fill(struct packing *q, int64_t *of, const struct packing *p)
{
    vec3 inverse[3];
    int8_t shift[3];
    int64_t n = p->n;
    cell_inverse(p->cell.edge, inverse);
    for (int64_t i = 0; q && i < p->n; i++) images_copy_body(q, i, p, i, v3(0, 0, 0)), of[i] = i;
    for (int k = 0; k < 27; k++) {
        if (!shift_of(&p->cell, k, shift)) continue;
        for (int64_t i = 0; i < p->n; i++) {
            if (!reaches(p, inverse, i, shift)) continue;
            if (q) images_copy_body(q, n, p, i, cell_shift(p->cell.edge, shift)), of[n] = i;
            n++;
        }
    }
    return n;
}

int images_append(struct packing *p, int64_t **of, struct failure *failure)
{
    struct packing q;
    *of = NULL;
    if (!cell_repeats(&p->cell)) return 0;
    packing_wrap(p, NULL);
    int64_t n = images_fill(NULL, NULL, p);
    if (packing_init(&q, p->dim, n, failure)) return failure->status;
    uint32_t optional = packing_optional(p) & ~(1u << BODY_image);
    if (packing_alloc_optional(&q, optional, failure)) {
        packing_free(&q);
        return failure->status;
    }
    *of = malloc(((size_t)n + 1) * sizeof **of);
    if (!*of) {
        packing_free(&q);
        return failure_set(failure, EX_SOFTWARE, "no memory for %lld bodies", (long long)n);
    }
    images_fill(&q, *of, p);
    // all that a packing has beside its bodies changes hands
    struct packing all = packing_with_bodies(p, &q, 0, n),
                   rest = packing_with_bodies(&q, p, 0, p->n);
    *p = all;
    packing_free(&rest);
    return 0;
}

void images_outline(struct walls *b, const struct packing *p)
{
    const struct cell *c = &p->cell;
    double lo[3] = { 0, 0, 0 }, hi[3] = { 1, 1, 1 };
    vec3 inverse[3];
    if (!cell_repeats(c)) return;
    cell_inverse(c->edge, inverse);
    for (int k = 0; k < p->dim; k++) {
        if (c->repeats[k] || !p->n) continue;
        lo[k] = INFINITY, hi[k] = -INFINITY;
        for (int64_t i = 0; i < p->n; i++) {
            double u = v3_dot(inverse[k], v3_sub(p->x[i], c->origin));
            lo[k] = fmin(lo[k], u), hi[k] = fmax(hi[k], u);
        }
    }
    for (int k = 0; k < p->dim; k++) // the edges along k, from the corners of the other two
        for (int m = 0; m < (p->dim == 2 ? 2 : 4); m++) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            if (p->dim == 2) i = 1 - k, j = 2;
            // an edge between faces of which none repeats is no border
            if ((!c->repeats[i] && !c->repeats[j]) || b->edges == WALLS_EDGES) continue;
            double u[3] = { 0 };
            u[i] = m & 1 ? hi[i] : lo[i], u[j] = p->dim == 2 ? 0 : m & 2 ? hi[j] : lo[j];
            vec3 from = v3_axpy(v3_axpy(c->origin, u[i], c->edge[i]), u[j], c->edge[j]);
            b->edge[b->edges++] =
                (struct edge){ v3_axpy(from, lo[k], c->edge[k]), v3_axpy(from, hi[k], c->edge[k]) };
        }
}
