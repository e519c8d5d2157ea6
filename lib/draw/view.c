/* draw/view.c: the window of a series, and its bodies and walls placed among the samples. */
#include "draw/view.h"

#include "draw/images.h"
#include "draw/raster.h"
#include "draw/wall_facets.h"
#include "state/selection.h"

#include <stdlib.h>

static bool view_is_wanted(const struct view *v, const struct packing *p, int64_t i)
{
    return !v->only || selection_body(v->only, p, i);
}

bool view_joins(const struct view *v, const struct packing *p, int32_t a, int32_t b)
{
    return view_is_wanted(v, p, b) || (a >= 0 && view_is_wanted(v, p, a));
}

static bool is_in_region(const struct view *v, const struct packing *p, int64_t i)
{
    vec3 x = v3_sub(p->x[i], v->moved);
    if (!(v3_dot(x, x) < WALLS_FAR * WALLS_FAR) || !(p->radius[i] < WALLS_FAR)) return false;
    const struct extent *r = &v->region;
    return !v->boxed || (x.x >= r->lo.x && x.x <= r->hi.x && x.y >= r->lo.y && x.y <= r->hi.y &&
                         (p->dim == 2 || (x.z >= r->lo.z && x.z <= r->hi.z)));
}

bool view_shows(const struct view *v, const struct packing *p, int64_t i)
{
    return view_is_wanted(v, p, i) && is_in_region(v, p, i);
}

/* ---- stray bodies ---- */

static int view_compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

enum { CROWD = 20 }; /* fewer bodies have no stray one */

/*
 * Bodies that have flown off must not shrink all others. Along each axis, those count that are no
 * farther outside the middle 96 % than these extend, twice. r = where bodies count.
 */
static bool find_crowd(struct extent *r, const struct packing *p)
{
    double *x = malloc((size_t)(p->n + 1) * sizeof *x), lo[3], hi[3];
    if (!x || p->n < CROWD) {
        free(x);
        return false;
    }
    for (int k = 0; k < 3; k++) {
        for (int64_t i = 0; i < p->n; i++)
            x[i] = k == 0 ? p->x[i].x : k == 1 ? p->x[i].y : p->x[i].z;
        qsort(x, (size_t)p->n, sizeof *x, view_compare);
        int64_t out = p->n / 50 + 1;
        double from = x[out], to = x[p->n - 1 - out];
        lo[k] = from, hi[k] = to;
    }
    free(x);
    double size = 2 * fmax(hi[0] - lo[0], fmax(hi[1] - lo[1], hi[2] - lo[2]));
    r->lo = v3(lo[0] - size, lo[1] - size, lo[2] - size);
    r->hi = v3(hi[0] + size, hi[1] + size, hi[2] + size);
    return true;
}

static bool view_within(const struct extent *r, vec3 x)
{
    return x.x >= r->lo.x && x.x <= r->hi.x && x.y >= r->lo.y && x.y <= r->hi.y && x.z >= r->lo.z &&
           x.z <= r->hi.z;
}

/* The bodies that count, as a packing that borrows the walls and parameters of p, and has no other arrays of bodies. */
static int gather_crowd(struct packing *crowd, const struct view *v, const struct packing *p,
                        struct failure *failure)
{
    struct extent r = { 0 };
    *crowd = *p;
    crowd->x = malloc((size_t)(p->n + 1) * sizeof *crowd->x);
    crowd->radius = malloc((size_t)(p->n + 1) * sizeof *crowd->radius);
    if (!crowd->x || !crowd->radius) {
        free(crowd->x), free(crowd->radius);
        failure_set(failure, EX_SOFTWARE, "no memory for %lld bodies", (long long)p->n);
        return EX_SOFTWARE;
    }
    bool some = !v->strays && find_crowd(&r, p);
    crowd->n = 0;
    for (int64_t i = 0; i < p->n; i++)
        if (view_is_wanted(v, p, i) && (!some || view_within(&r, p->x[i])))
            crowd->x[crowd->n] = p->x[i], crowd->radius[crowd->n++] = p->radius[i];
    return 0;
}

void view_follow(struct view *v, const struct packing *p)
{
    v->moved = v3(0, 0, 0);
    for (int64_t i = 0; v->follows && i < p->n; i++)
        if (p->id[i] == v->follow) v->moved = v3_sub(p->x[i], v->followed);
}

static int follow_first(struct view *v, const struct packing *p, struct failure *failure)
{
    for (int64_t i = 0; i < p->n; i++)
        if (p->id[i] == v->follow) {
            v->followed = p->x[i];
            return 0;
        }
    return failure_set(failure, EX_DATAERR, "no body has the id %d", v->follow);
}

/* Extends the region and the window to the bodies of this packing. */
static int extend_window(struct view *v, const struct packing *p, struct failure *failure)
{
    struct extent r;
    const bool seen = v->strays ? region_of(&r, p) : region_near(&r, p);
    if (!seen) return failure_set(failure, EX_DATAERR, "neither bodies nor walls: nothing to see");
    v->region = v->started ? region_join(v->region, r) : r;
    for (int64_t i = 0; i < p->n; i++)
        if (is_in_region(v, p, i)) window_add(&v->window, &v->camera, p->x[i], p->radius[i]);
    return 0;
}

/* The same, of the bodies that count. */
static int extend_crowd(struct view *v, const struct packing *p, struct failure *failure)
{
    struct packing crowd;
    if (gather_crowd(&crowd, v, p, failure)) return failure->status;
    extend_window(v, &crowd, failure);
    free(crowd.x), free(crowd.radius);
    return failure->status;
}

int view_extend(struct view *v, const struct packing *p, struct failure *failure)
{
    if (v->started && v->dim != p->dim)
        return failure_set(failure, EX_DATAERR, "dim %d after dim %d in one series", p->dim,
                           v->dim);
    if (!v->started) {
        v->dim = p->dim, v->window = window_empty;
        vec3 up = v3_norm(v->up) > 0 ? v3_scale(1 / v3_norm(v->up), v->up) : walls_up(p);
        camera_turn(&v->camera, p->dim, up, v->azimuth, v->elevation);
        if (v->boxed && p->dim == 2) v->region.lo.z = v->region.hi.z = 0;
        if (v->follows && follow_first(v, p, failure)) return failure->status;
    }
    paint_range(&v->paint, p);
    bool whole = v->boxed || (v->started && v->follows); // a window that is given
    if (!whole && extend_crowd(v, p, failure)) return failure->status;
    v->started = true;
    return 0;
}

void view_fit(struct view *v, const struct packing *p)
{
    if (v->boxed) {
        const struct extent *r = &v->region;
        for (int k = 0; k < 8; k++)
            window_add(
                &v->window, &v->camera,
                v3(k & 1 ? r->hi.x : r->lo.x, k & 2 ? r->hi.y : r->lo.y, k & 4 ? r->hi.z : r->lo.z),
                0);
    }
    struct walls *b = v->boxed ? NULL : malloc(sizeof *b);
    if (b) { // without memory for the walls, the window has the bodies only
        walls_build(b, p, &v->region);
        images_outline(b, p);
        for (int i = 0; i < b->panels; i++)
            for (int k = 0; k < b->panel[i].corners; k++)
                window_add(&v->window, &v->camera, b->panel[i].corner[k], 0);
        for (int i = 0; i < b->edges; i++) {
            vec3 from = b->edge[i].a, to = b->edge[i].b;
            if (!extent_clip(&v->region, &from, &to)) continue;
            window_add(&v->window, &v->camera, from, 0);
            window_add(&v->window, &v->camera, to, 0);
        }
    }
    free(b);
    camera_perspective(&v->camera, &v->window, v->dim == 2 ? 0 : v->angle);
    camera_fit(&v->camera, &v->window, v->boxed ? 0 : 0.03, v->width, v->height);
}

/* ---- from space to samples ---- */

/* Samples: where x (m) is seen, and in *near how much smaller than in the plane in front (0: not) */
static vec3 sample_near(const struct view *v, vec3 x, double *near)
{
    const struct camera *c = &v->camera;
    double s = v->samples, k = c->scale * s;
    vec3 see = camera_sees(c, x);
    *near = camera_shrinks(c, see.z);
    if (*near != 1) {
        see.x = c->u + *near * (see.x - c->u), see.y = c->v + *near * (see.y - c->v);
        see.z = c->front + *near * (see.z - c->front);
    }
    return v3(0.5 * s * c->width + k * (see.x - c->u), 0.5 * s * c->height - k * (see.y - c->v),
              k * see.z);
}

static vec3 view_sample_of(const struct view *v, vec3 x)
{
    double near;
    return sample_near(v, x, &near);
}

/*
 * The inverse, in m, is (x_0 + x_1 at) / over with affine functions of `at`: x = what is above the
 * bar, less origin over. Without perspective over = 1.
 */
static vec3 place_over(const struct view *v, vec3 at, vec3 origin, double *over)
{
    const struct camera *c = &v->camera;
    double s = v->samples, k = 1 / (c->scale * s), a = k * (at.x - 0.5 * s * c->width),
           b = -k * (at.y - 0.5 * s * c->height);
    if (isinf(c->eye)) {
        *over = 1;
        vec3 x = v3_axpy(v3_scale(c->u + a, c->right), c->v + b, c->up);
        return v3_sub(v3_axpy(x, k * at.z, c->toward), origin);
    }
    double below = k * at.z - c->front;
    *over = 1 + below / c->eye;
    vec3 middle = v3_axpy(v3_axpy(v3_scale(c->u, c->right), c->v, c->up), c->front, c->toward);
    vec3 x = v3_axpy(v3_axpy(v3_scale(a, c->right), b, c->up), below, c->toward);
    return v3_axpy(x, *over, v3_sub(middle, origin));
}

vec3 view_sees(const struct view *v, vec3 x, double *size)
{
    double near, s = v->samples;
    vec3 at = sample_near(v, v3_sub(x, v->moved), &near);
    *size = near * v->camera.scale;
    return v3_scale(1 / s, at);
}

/* Places the bodies that may be in the picture, in their order; -1: no memory. */
static int place_spots(struct raster *s, const struct view *v, const struct packing *p)
{
    s->spot = malloc((size_t)(p->n + 1) * sizeof *s->spot);
    if (!s->spot) return -1;
    const double k = v->camera.scale * v->samples, far = 1e100; // squares stay finite
    for (int64_t i = 0; i < p->n; i++) {
        if (!view_shows(v, p, i)) continue;
        if (v->cuts && v3_dot(v->cut, p->x[i]) - p->radius[i] > v->cut_at) continue;
        double near;
        vec3 x = sample_near(v, v3_sub(p->x[i], v->moved), &near);
        double r = fmax(k * near * p->radius[i], M_SQRT1_2); // so large that each has a sample
        if (!(near > 0 && fabs(x.z) < far && r < far)) continue;
        if (!(x.x + r > 0 && x.x - r < s->width && x.y + r > 0 && x.y - r < s->height)) continue;
        const struct shape *shape = packing_shape(p, i);
        double fill = shape ? shape->volume / p->shapes.s[0].volume : 1;
        s->spot[s->spots++] = (struct spot){ x,     r,
                                             i,     paint_body(&v->paint, p, i),
                                             shape, shape ? r * cbrt(fill) : r };
    }
    return 0;
}

/* f = the affine function of a sample that is (n . x - d) over, x what is seen there */
static void affine_of(const struct view *v, vec3 n, vec3 origin, double f[4], double over[4])
{
    static const vec3 at[4] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    for (int k = 0; k < 4; k++) {
        f[k] = v3_dot(n, place_over(v, at[k], origin, &over[k]));
        if (k) f[k] -= f[0], over[k] -= over[0];
    }
}

static void place_cutting(struct cutting *c, const struct view *v)
{
    double side[4], over[4];
    vec3 n = camera_sees(&v->camera, v->cut);
    affine_of(v, v->cut, v3_sub(v3_scale(v->cut_at, v->cut), v->moved), side, over);
    *c = (struct cutting){ true, { side[1], side[2], side[3], side[0] }, { n.x, -n.y, n.z } };
}

static void place_ground(struct ground *g, const struct view *v, const struct panel *f)
{
    vec3 n = camera_sees(&v->camera, f->n),
         foot = view_sample_of(v, v3_sub(f->corner[0], v->moved));
    g->n = v3(n.x, -n.y, n.z);
    if (isinf(v->camera.eye)) {
        g->plane[1] = -g->n.x / g->n.z, g->plane[2] = -g->n.y / g->n.z;
        g->plane[0] = foot.z - g->plane[1] * foot.x - g->plane[2] * foot.y;
    } else {
        double side[4], over[4];
        affine_of(v, f->n, v3_sub(f->corner[0], v->moved), side, over);
        for (int k = 0; k < 3; k++) g->plane[k] = -side[k] / side[3];
    }
    g->corners = f->corners;
    for (int k = 0; k < f->corners; k++) {
        vec3 at = view_sample_of(v, v3_sub(f->corner[k], v->moved));
        g->x[k] = at.x, g->y[k] = at.y;
    }
    const struct extent *r = &v->region;
    double size = fmax(fmax(r->hi.x - r->lo.x, r->hi.y - r->lo.y), 1e-150);
    vec3 e = fabs(f->n.x) < 0.9 ? v3(1, 0, 0) : v3(0, 1, 0);
    vec3 along[2] = { v3_axpy(e, -v3_dot(e, f->n), f->n) };
    along[0] = v3_scale(1 / (camera_round(size / 6) * v3_norm(along[0])), along[0]);
    along[1] = v3_cross(f->n, along[0]);
    // square[] and over are affine, so three points determine them
    vec3 at[3] = { { 0, 0, g->plane[0] },
                   { 1, 0, g->plane[0] + g->plane[1] },
                   { 0, 1, g->plane[0] + g->plane[2] } };
    for (int k = 0; k < 3; k++)
        at[k] = place_over(v, at[k], v3_sub(f->origin, v->moved), &g->over[k]);
    g->over[1] -= g->over[0], g->over[2] -= g->over[0];
    for (int i = 0; i < 2; i++) {
        g->square[i][0] = v3_dot(along[i], at[0]);
        g->square[i][1] = v3_dot(along[i], v3_sub(at[1], at[0]));
        g->square[i][2] = v3_dot(along[i], v3_sub(at[2], at[0]));
    }
}

/* Places edges, and floors seen from above (from below they would hide bodies); -1: no memory. */
static int place_walls(struct raster *s, const struct view *v, const struct packing *p)
{
    struct walls *b = malloc(sizeof *b);
    s->ground = malloc(WALLS_PANELS * sizeof *s->ground);
    s->edge = malloc(WALLS_EDGES * sizeof *s->edge);
    bool allocated = b && s->ground && s->edge;
    const struct extent r = { v3_add(v->region.lo, v->moved), v3_add(v->region.hi, v->moved) };
    if (allocated) walls_build(b, p, &r), images_outline(b, p);
    for (int i = 0; allocated && i < b->panels; i++)
        if (v3_dot(b->panel[i].n, v->camera.toward) > WALLS_FACING)
            place_ground(&s->ground[s->grounds++], v, &b->panel[i]);
    for (int i = 0; allocated && i < b->edges; i++)
        s->edge[s->edges++] = (struct edge){ view_sample_of(v, v3_sub(b->edge[i].a, v->moved)),
                                             view_sample_of(v, v3_sub(b->edge[i].b, v->moved)) };
    free(b);
    return allocated ? 0 : -1;
}

/* f's plane and corners among the samples; false where a corner is not before the eye. */
static bool place_pane(struct pane *g, const struct view *v, const struct facet *f)
{
    vec3 at[3], n = camera_sees(&v->camera, f->n);
    for (int k = 0; k < 3; k++) {
        double near;
        at[k] = sample_near(v, v3_sub(f->corner[k], v->moved), &near);
        g->x[k] = at[k].x, g->y[k] = at[k].y;
        if (!(near > 0)) return false;
    }
    vec3 across = v3_cross(v3_sub(at[1], at[0]), v3_sub(at[2], at[0]));
    if (fabs(across.z) < 1e-6) return false; // seen edgewise, it covers no sample
    g->plane[1] = -across.x / across.z, g->plane[2] = -across.y / across.z;
    g->plane[0] = at[0].z - g->plane[1] * at[0].x - g->plane[2] * at[0].y;
    double to = n.z < 0 ? -1 : 1; // the side that is seen
    g->n = v3(to * n.x, -to * n.y, to * n.z), g->own = f->own;
    g->part = glass_part(n.z);
    g->light = (float)(0.75 + 0.25 * fabs(n.z));
    return true;
}

static int place_panes(struct raster *s, const struct view *v, const struct packing *p)
{
    struct glass glass;
    struct failure failure = { 0 };
    const struct glass_opt opt = { { v3_add(v->region.lo, v->moved),
                                     v3_add(v->region.hi, v->moved) },
                                   v->camera.toward,
                                   v->solid,
                                   v->glass };
    if (!v->glass && !v->solid) return 0;
    if (glass_init(&glass, p, &opt, &failure)) return -1;
    s->pane = malloc((size_t)(glass.facets + 1) * sizeof *s->pane);
    for (int64_t i = 0; s->pane && i < glass.facets; i++)
        s->panes += place_pane(&s->pane[s->panes], v, &glass.facet[i]);
    glass_free(&glass);
    return s->pane ? 0 : -1;
}

int view_draw(const struct view *v, const struct packing *p, struct picture *pic,
              struct failure *failure)
{
    const struct camera *c = &v->camera;
    int longer = c->width > c->height ? c->width : c->height;
    struct raster s = {
        .width = c->width * v->samples,
        .height = c->height * v->samples,
        .samples = v->samples,
        .threads = v->threads,
        .flat = v->dim == 2,
        .background = v->background,
        .paint = &v->paint,
        .q = p->q,
        .right = c->right,
        .up = c->up,
        .toward = c->toward,
        .pale = v->pale,
        .thick = v->samples * fmax(0.5, longer / 1200.0),
    };
    if (v->cuts) place_cutting(&s.cutting, v);
    *pic = (struct picture){ 0 };
    if (v->dim != p->dim)
        failure_set(failure, EX_DATAERR, "dim %d after dim %d in one series", p->dim, v->dim);
    else if (place_spots(&s, v, p) || place_walls(&s, v, p) || place_panes(&s, v, p))
        failure_set(failure, EX_SOFTWARE, "no memory for %lld bodies", (long long)p->n);
    else if (!picture_init(pic, c->width, c->height, failure) && raster_draw(&s, pic, failure))
        picture_free(pic);
    free(s.spot), free(s.ground), free(s.edge), free(s.pane);
    return failure->status;
}
