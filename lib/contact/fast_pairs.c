#include "contact/fast_pairs.h"

#include <stdlib.h>

static bool is_fast(const struct packing *p, int64_t i, double thick)
{
    return p->dt * p->dt * v3_dot(p->v[i], p->v[i]) > thick * thick;
}

static struct fast body_of(const struct packing *p, int64_t i)
{
    struct fast b = { .id = p->id[i],
                      .material = p->material[i],
                      .shape = p->shape ? p->shape[i] : 0,
                      .radius = p->radius[i],
                      .thick = tunnelling_thickness(p, i),
                      .mass = p->mass[i],
                      .x = p->x[i],
                      .v = p->v[i],
                      .q = p->q[i] };
    b.fast = is_fast(p, i, b.thick);
    return b;
}

/* Of any shape: its thickness over its radius */
static double least_thickness(const struct packing *p)
{
    double least = 1;
    if (!p->shape) return least;
    for (int64_t i = 0; i < p->n; i++)
        if (p->shape[i]) least = dmin(least, tunnelling_thickness(p, i) / p->radius[i]);
    return least;
}

/* May any body be fast? Without a branch for each, for mostly none is. */
static bool fast_pairs_may_be(const struct packing *p)
{
    const double least = least_thickness(p), scale = p->dt * p->dt / (least * least);
    bool any = false;
    for (int64_t i = 0; i < p->n; i++)
        any |= scale * v3_dot(p->v[i], p->v[i]) > p->radius[i] * p->radius[i] * (1 - 1e-12);
    return any;
}

int fast_find(struct fast_list *list, const struct packing *p, const bool *of,
              struct failure *failure)
{
    *list = (struct fast_list){ 0 };
    if (!fast_pairs_may_be(p)) return 0;
    for (int64_t i = 0; i < p->n; i++) {
        if (of && !of[i]) continue;
        if (!is_fast(p, i, p->shape ? tunnelling_thickness(p, i) : p->radius[i])) continue;
        const struct fast b = body_of(p, i);
        if (!(list->n & (list->n - 1))) { // the room doubles
            struct fast *more =
                realloc(list->of, (size_t)(list->n ? 2 * list->n : 1) * sizeof *more);
            if (!more) {
                free(list->of), list->of = NULL;
                return failure_set(failure, EX_SOFTWARE, "no memory for fast bodies");
            }
            list->of = more;
        }
        list->of[list->n++] = b;
    }
    return 0;
}

const struct shape *fast_hull(const struct packing *p, const struct fast *b)
{
    const struct shape *s = b->shape ? &p->shapes.s[b->shape] : NULL;
    return s && shape_has_faces(s) ? s : NULL;
}

/* What a path of a body covers */
struct fast_pairs_box {
    vec3 lo, hi; /* m */
};

static struct fast_pairs_box fast_pairs_box_of(const struct fast *b, struct window window)
{
    const vec3 from = fast_from(window, b), to = v3_axpy(from, window.length, b->v);
    const vec3 r = v3(b->radius, b->radius, b->radius);
    return (struct fast_pairs_box){ v3_sub(v3_min(from, to), r), v3_add(v3_max(from, to), r) };
}

static bool fast_pairs_apart(const struct fast_pairs_box *a, const struct fast_pairs_box *b)
{
    return a->hi.x < b->lo.x || b->hi.x < a->lo.x || a->hi.y < b->lo.y || b->hi.y < a->lo.y ||
           a->hi.z < b->lo.z || b->hi.z < a->lo.z;
}

/* Of all of them */
static struct fast_pairs_box box_of_all(const struct packing *p, const bool *of,
                                        struct window window)
{
    struct fast_pairs_box all = { v3(INFINITY, INFINITY, INFINITY),
                                  v3(-INFINITY, -INFINITY, -INFINITY) };
    for (int64_t i = 0; i < p->n; i++) {
        if (of && !of[i]) continue;
        const struct fast b = { .radius = p->radius[i], .x = p->x[i], .v = p->v[i] };
        const struct fast_pairs_box box = fast_pairs_box_of(&b, window);
        all.lo = v3_min(all.lo, box.lo), all.hi = v3_max(all.hi, box.hi);
    }
    return all;
}

static double fast_pairs_along(int axis, vec3 x)
{
    return axis == 0 ? x.x : axis == 1 ? x.y : x.z;
}

/* The one along which it is longest: sorted along it, the fewest paths are side by side. */
static int longest_axis(const struct fast_pairs_box *b)
{
    const vec3 d = v3_sub(b->hi, b->lo);
    return d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
}

/* A fast body, or an image of it, with its path */
struct placed_path {
    const struct fast *of;
    vec3 x, v;
    struct fast_pairs_box box;
    double lo,
        most; /* m: of the box, along the sweep's axis; no path that begins before it reaches farther */
};

static int fast_pairs_by_place(const void *a, const void *b)
{
    const struct placed_path *x = a, *y = b;
    if (x->lo != y->lo) return x->lo < y->lo ? -1 : 1;
    return (x->of->id > y->of->id) - (x->of->id < y->of->id);
}

/* With the images in the cells around that come into the box, sorted along an axis; NULL: no memory */
static struct placed_path *with_images(const struct packing *p, const struct fast_pairs_box *here,
                                       int axis, struct window window, const struct fast_list *list,
                                       int64_t *n)
{
    int reach[3];
    int64_t images = 1;
    for (int k = 0; k < 3; k++) reach[k] = p->cell.repeats[k], images *= 1 + 2 * reach[k];
    struct placed_path *all = malloc((size_t)(list->n * images) * sizeof *all);
    *n = 0;
    for (int64_t i = 0; all && i < list->n; i++)
        for (int a = -reach[0]; a <= reach[0]; a++)
            for (int b = -reach[1]; b <= reach[1]; b++)
                for (int c = -reach[2]; c <= reach[2]; c++) {
                    const int8_t shift[3] = { (int8_t)a, (int8_t)b, (int8_t)c };
                    struct fast image = list->of[i];
                    image.x = v3_add(image.x, cell_shift(p->cell.edge, shift));
                    image.v = v3_add(image.v, cell_shift(p->cell.rate, shift));
                    const struct fast_pairs_box box = fast_pairs_box_of(&image, window);
                    if (fast_pairs_apart(&box, here)) continue;
                    all[(*n)++] = (struct placed_path){ &list->of[i],
                                                        image.x,
                                                        image.v,
                                                        box,
                                                        fast_pairs_along(axis, box.lo),
                                                        fast_pairs_along(axis, box.hi) };
                }
    if (!all) return NULL;
    qsort(all, (size_t)*n, sizeof *all, fast_pairs_by_place);
    for (int64_t k = 1; k < *n; k++) all[k].most = dmax(all[k - 1].most, all[k].most);
    return all;
}

/* The first of all[n] whose path, or one before it, reaches beyond x */
static int64_t first_beyond(const struct placed_path *all, int64_t n, double x)
{
    int64_t lo = 0, hi = n;
    while (lo < hi) {
        int64_t m = lo + (hi - lo) / 2;
        if (all[m].most < x)
            lo = m + 1;
        else
            hi = m;
    }
    return lo;
}

bool fast_is_fixed_hull(const struct packing *p, const struct fast *b)
{
    return b->mass == 0 && fast_hull(p, b);
}

int fast_pairs(const struct packing *p, const bool *of, const struct fast_list *list,
               struct window window, fast_visit *visit, void *arg, struct failure *failure)
{
    int64_t images;
    if (!list->n) return 0;
    const struct fast_pairs_box here = box_of_all(p, of, window);
    const int axis = longest_axis(&here);
    struct placed_path *all = with_images(p, &here, axis, window, list, &images);
    if (!all) return failure_set(failure, EX_SOFTWARE, "no memory for fast bodies");
    for (int64_t i = 0; i < p->n && images; i++) {
        if (of && !of[i]) continue;
        const struct fast b = body_of(p, i);
        const struct fast_pairs_box box = fast_pairs_box_of(&b, window);
        for (int64_t k = first_beyond(all, images, fast_pairs_along(axis, box.lo));
             k < images && all[k].lo <= fast_pairs_along(axis, box.hi); k++) {
            const struct placed_path *path = &all[k];
            if (fast_pairs_apart(&path->box, &box) || path->of->id == b.id ||
                (b.fast && path->of->id < b.id) || (path->of->mass == 0 && b.mass == 0) ||
                p->inert[path->of->material * p->materials + b.material] != 0)
                continue;
            struct fast a = *path->of;
            a.x = path->x, a.v = path->v;
            visit(arg, &a, &b);
        }
    }
    free(all);
    return 0;
}
