#include "scene/shelves.h"

#include <stdlib.h>

/* Where the next cell begins, and where the present row and shelf end; [k] along axis k */
struct cursor {
    int dim;
    const struct scene_box *box;
    double at[3], end[3];
};

static int shelves_larger_first(const void *one, const void *other)
{
    const struct grain *a = *(struct grain *const *)one, *b = *(struct grain *const *)other;
    if (a->r != b->r) return a->r > b->r ? -1 : 1;
    return a < b ? -1 : a > b; // as drawn: qsort alone promises no order
}

/* Does [at, at + edge] end within the box along axis k? Rounding is forgiven: 6.3 mm hold six cells
   of 1.05 mm. */
static bool fits(const struct cursor *c, int k, double edge)
{
    double lo = c->box->lo[k], hi = c->box->hi[k];
    return c->at[k] + edge <= hi + 1e-12 * (isfinite(hi) ? hi - lo : 0);
}

/* The row, or the shelf, is full along axis k: on to the next; false: there is none. */
static bool move_on(struct cursor *c, int k)
{
    if (k == c->dim - 1 || c->at[k] == c->box->lo[k]) return false; // wider than the box
    for (int i = 0; i <= k; i++) c->at[i] = c->end[i] = c->box->lo[i];
    c->at[k + 1] = c->end[k + 1];
    return true;
}

/* Finds room for a cell at the cursor: in its row, else in a new row, else on a new shelf. */
static bool random_start_place(struct cursor *c, double edge)
{
    for (int k = 0; k < c->dim; k++) {
        if (fits(c, k, edge)) continue;
        if (!move_on(c, k)) return false;
        k = -1; // does it fit there?
    }
    for (int k = 1; k < c->dim; k++) c->end[k] = fmax(c->end[k], c->at[k] + edge);
    return true;
}

/* Grain g into a cell of its own, moved at random as far as it stays in it. */
static void random_start_settle(struct grain *g, const struct cursor *c, double edge, double jitter,
                   gsl_rng *rng)
{
    double x[3] = { 0 };
    for (int k = 0; k < c->dim; k++)
        x[k] =
            c->at[k] + 0.5 * edge + jitter * (0.5 * edge - g->r) * (2 * gsl_rng_uniform(rng) - 1);
    g->x = v3(x[0], x[1], x[2]);
}

int shelves_fill(struct grains *out, const struct scene_bodies *b, int dim, gsl_rng *rng,
                 struct failure *failure)
{
    for (int64_t i = 0; i < b->count; i++) {
        struct grain g = grain_at(v3(0, 0, 0), scene_size_draw(&b->size, rng));
        if (grains_add(out, &g, failure)) return failure->status;
    }
    struct grain **sorted = malloc(((size_t)out->n + 1) * sizeof(struct grain *));
    if (!sorted) return failure_set(failure, EX_SOFTWARE, "no memory for a lattice");
    for (int64_t i = 0; i < out->n; i++) sorted[i] = &out->g[i];
    qsort(sorted, (size_t)out->n, sizeof(struct grain *), shelves_larger_first);
    struct cursor c = { .dim = dim, .box = &b->box };
    struct scene_box open = b->box;
    int64_t went =
        -1; /* bodies that found room; the others are stacked on top, to say how high they are */
    open.hi[dim - 1] = INFINITY;
    for (int k = 0; k < dim; k++) c.at[k] = c.end[k] = b->box.lo[k];
    for (int64_t i = 0; i < out->n && !failure->status; i++) {
        double edge = 2 * b->spacing * sorted[i]->r;
        bool placed = random_start_place(&c, edge);
        if (!placed && went < 0) went = i, c.box = &open, placed = random_start_place(&c, edge);
        if (!placed)
            failure_set(failure, EX_DATAERR, "the box is narrower than a cell of %.4g m", edge);
        else
            random_start_settle(sorted[i], &c, edge, b->jitter, rng);
        c.at[0] += edge;
    }
    if (went >= 0 && !failure->status)
        failure_set(failure, EX_DATAERR,
                "the box has cells for %lld of %lld bodies: they need a height of %.4g m along %c",
                (long long)went, (long long)out->n, c.end[dim - 1] - b->box.lo[dim - 1],
                "xyz"[dim - 1]);
    free(sorted);
    return failure->status;
}
