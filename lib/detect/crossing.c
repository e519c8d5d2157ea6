#include "detect/crossing.h"

#include "bodies/wrap.h"

#include <stdlib.h>

static const double GRAZE = 1e-2; /* of the sum of radii: how deep a way must go into the other */

static struct fast body_of(const struct packing *p, int64_t i)
{
    return (struct fast){ .id = p->id[i],
                          .shape = p->shape ? p->shape[i] : 0,
                          .radius = p->radius[i],
                          .thick = swift_thickness(p, i),
                          .mass = p->mass[i],
                          .x = p->x[i],
                          .v = p->v[i],
                          .q = p->q[i] };
}

static bool is_fast(const struct packing *p, const struct fast *b)
{
    return p->dt * p->dt * v3_dot(b->v, b->v) > b->thick * b->thick;
}

int crossing_list(struct fast_list *list, const struct packing *p, int64_t n, struct why *why)
{
    *list = (struct fast_list){ 0 };
    for (int64_t i = 0; i < n; i++) {
        const struct fast b = body_of(p, i);
        if (!is_fast(p, &b)) continue;
        if (!(list->n & (list->n - 1))) { // the room doubles
            struct fast *more =
                realloc(list->of, (size_t)(list->n ? 2 * list->n : 1) * sizeof *more);
            if (!more) {
                free(list->of), list->of = NULL;
                return why_set(why, EX_SOFTWARE, "no memory for fast bodies");
            }
            list->of = more;
        }
        list->of[list->n++] = b;
    }
    return 0;
}

/* ---- one pair ---- */

static const struct shape *hull_of(const struct packing *p, const struct fast *b)
{
    const struct shape *s = b->shape ? &p->shapes.s[b->shape] : NULL;
    return s && s->form == SHAPE_HULL ? s : NULL;
}

static double size_of(const struct fast *b)
{
    return b->shape ? b->thick : b->radius;
}

/* m: where the window begins */
static vec3 begin_of(struct window window, const struct fast *b)
{
    return v3_axpy(b->x, -window.back, b->v);
}

static bool through_ball(double radii, vec3 from, vec3 way)
{
    const double w2 = v3_dot(way, way), s = -v3_dot(from, way) / w2;
    const vec3 end = v3_add(from, way), nearest = v3_axpy(from, s, way);
    const double deep = (1 - GRAZE) * radii;
    return s > 0 && s < 1 && v3_dot(from, from) >= radii * radii &&
           v3_dot(end, end) >= radii * radii && v3_dot(nearest, nearest) < deep * deep;
}

/* Does b go through a, or a through b? */
static bool cross(const struct packing *p, struct window window, const struct fast *a,
                  const struct fast *b)
{
    const struct shape *ha = hull_of(p, a), *hb = hull_of(p, b);
    const vec3 from = v3_sub(begin_of(window, b), begin_of(window, a));
    const vec3 way = v3_scale(window.length, v3_sub(b->v, a->v));
    const double thick = a->thick + b->thick;
    const vec3 none = v3(0, 0, 0);
    if (!(v3_dot(way, way) > thick * thick)) return false;
    if (!ha && !hb) return through_ball(size_of(a) + size_of(b), from, way);
    if (ha && swift_through_hull(ha, p->dim, a->radius, a->q, from, v3_add(from, way))) return true;
    return hb && swift_through_hull(hb, p->dim, b->radius, b->q, v3_sub(none, from),
                                    v3_sub(none, v3_add(from, way)));
}

/* ---- all ---- */

static void set_reach(struct fast *b, struct window window)
{
    const double from = begin_of(window, b).x, to = from + window.length * b->v.x;
    b->lo = dmin(from, to) - b->radius, b->hi = dmax(from, to) + b->radius;
}

static int by_place(const void *a, const void *b)
{
    const struct fast *x = a, *y = b;
    if (x->lo != y->lo) return x->lo < y->lo ? -1 : 1;
    return (x->id > y->id) - (x->id < y->id);
}

/* With the images in the cells around, sorted; NULL: no memory */
static struct fast *with_images(const struct packing *p, struct window window,
                                const struct fast_list *list, int64_t *n)
{
    int reach[3];
    int64_t images = 1;
    for (int k = 0; k < 3; k++) reach[k] = p->cell.repeats[k], images *= 1 + 2 * reach[k];
    struct fast *all = calloc((size_t)(list->n * images), sizeof *all);
    *n = 0;
    for (int64_t i = 0; all && i < list->n; i++)
        for (int a = -reach[0]; a <= reach[0]; a++)
            for (int b = -reach[1]; b <= reach[1]; b++)
                for (int c = -reach[2]; c <= reach[2]; c++) {
                    const int8_t shift[3] = { (int8_t)a, (int8_t)b, (int8_t)c };
                    struct fast *to = &all[(*n)++];
                    *to = list->of[i];
                    to->x = v3_add(to->x, cell_shift(p->cell.edge, shift));
                    to->v = v3_add(to->v, cell_shift(p->cell.rate, shift));
                    set_reach(to, window);
                }
    if (!all) return NULL;
    qsort(all, (size_t)*n, sizeof *all, by_place);
    for (int64_t k = 0; k < *n; k++) all[k].most = k ? dmax(all[k - 1].most, all[k].hi) : all[k].hi;
    return all;
}

/* The first of all[n] whose way, or one before it, reaches beyond x */
static int64_t first_beyond(const struct fast *all, int64_t n, double x)
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

static bool is_fixed_hull(const struct packing *p, const struct fast *b)
{
    return b->mass == 0 && hull_of(p, b);
}

int crossing_count(struct passed *s, const struct packing *p, int64_t n,
                   const struct fast_list *list, struct window window, struct why *why)
{
    int64_t images;
    if (!list->n) return 0;
    struct fast *all = with_images(p, window, list, &images);
    if (!all) return why_set(why, EX_SOFTWARE, "no memory for fast bodies");
    for (int64_t i = 0; i < n; i++) {
        struct fast b = body_of(p, i);
        const bool fast = is_fast(p, &b);
        set_reach(&b, window);
        for (int64_t k = first_beyond(all, images, b.lo); k < images && all[k].lo <= b.hi; k++) {
            const struct fast *a = &all[k];
            if (a->hi < b.lo || a->id == b.id || (fast && a->id < b.id)) continue;
            if (a->mass == 0 && b.mass == 0) continue;
            if (is_fixed_hull(p, a) || is_fixed_hull(p, &b))
                continue; // which swift_passed() counts
            if (cross(p, window, a, &b)) swift_note(s, fast ? b.id : a->id, fast ? a->id : b.id);
        }
    }
    free(all);
    return 0;
}
