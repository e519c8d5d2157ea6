/* draw/view.c: the window of a series, and its bodies and walls placed among the samples. */
#include "draw/view.h"

#include "draw/raster.h"

#include <stdlib.h>

static bool is_shown(const struct view *v, const struct packing *p, int64_t i)
{
    vec3 x = p->x[i];
    if (!(v3_dot(x, x) < WALLS_FAR * WALLS_FAR) || !(p->radius[i] < WALLS_FAR)) return false;
    const struct region *r = &v->region;
    return !v->boxed || (x.x >= r->lo.x && x.x <= r->hi.x && x.y >= r->lo.y && x.y <= r->hi.y &&
                         (p->dim == 2 || (x.z >= r->lo.z && x.z <= r->hi.z)));
}

int view_extend(struct view *v, const struct packing *p, struct why *why)
{
    struct region r;
    if (v->started && v->dim != p->dim)
        return why_set(why, EX_DATAERR, "dim %d after dim %d in one series", p->dim, v->dim);
    if (!v->started) {
        v->dim = p->dim, v->window = window_empty;
        camera_turn(&v->camera, p->dim, v->azimuth, v->elevation);
        if (v->boxed && p->dim == 2) v->region.lo.z = v->region.hi.z = 0;
    }
    paint_range(&v->paint, p);
    if (!v->boxed) {
        if (!region_of(&r, p))
            return why_set(why, EX_DATAERR, "neither bodies nor walls: nothing to see");
        v->region = v->started ? region_join(v->region, r) : r;
        for (int64_t i = 0; i < p->n; i++)
            if (is_shown(v, p, i)) window_add(&v->window, &v->camera, p->x[i], p->radius[i]);
    }
    v->started = true;
    return 0;
}

void view_fit(struct view *v, const struct packing *p)
{
    if (v->boxed) {
        const struct region *r = &v->region;
        for (int k = 0; k < 8; k++)
            window_add(
                &v->window, &v->camera,
                v3(k & 1 ? r->hi.x : r->lo.x, k & 2 ? r->hi.y : r->lo.y, k & 4 ? r->hi.z : r->lo.z),
                0);
    }
    struct walls *b = v->boxed ? NULL : malloc(sizeof *b);
    if (b) { // without memory for the walls, the window has the bodies only
        walls_build(b, p, &v->region);
        for (int i = 0; i < b->panels; i++)
            for (int k = 0; k < b->panel[i].corners; k++)
                window_add(&v->window, &v->camera, b->panel[i].corner[k], 0);
        for (int i = 0; i < b->edges; i++) {
            window_add(&v->window, &v->camera, b->edge[i].a, 0);
            window_add(&v->window, &v->camera, b->edge[i].b, 0);
        }
    }
    free(b);
    camera_fit(&v->camera, &v->window, v->boxed ? 0 : 0.03, v->width, v->height);
}

/* ---- from space to samples ---- */

/* Samples: where x (m) is seen */
static vec3 sample_of(const struct view *v, vec3 x)
{
    const struct camera *c = &v->camera;
    double s = v->samples, k = c->scale * s;
    vec3 see = camera_sees(c, x);
    return v3(0.5 * s * c->width + k * (see.x - c->u), 0.5 * s * c->height - k * (see.y - c->v),
              k * see.z);
}

/* The inverse, in m */
static vec3 place_of(const struct view *v, vec3 at)
{
    const struct camera *c = &v->camera;
    double s = v->samples, k = 1 / (c->scale * s);
    vec3 x = v3_scale(c->u + k * (at.x - 0.5 * s * c->width), c->right);
    x = v3_axpy(x, c->v - k * (at.y - 0.5 * s * c->height), c->up);
    return v3_axpy(x, k * at.z, c->toward);
}

/* Places the bodies that may be in the picture, in their order; -1: no memory. */
static int place_spots(struct raster *s, const struct view *v, const struct packing *p)
{
    s->spot = malloc((size_t)(p->n + 1) * sizeof *s->spot);
    if (!s->spot) return -1;
    const double k = v->camera.scale * v->samples, far = 1e100; // squares stay finite
    for (int64_t i = 0; i < p->n; i++) {
        if (!is_shown(v, p, i)) continue;
        vec3 x = sample_of(v, p->x[i]);
        double r = fmax(k * p->radius[i], M_SQRT1_2); // so large that every body has a sample
        if (!(fabs(x.z) < far && r < far)) continue;
        if (!(x.x + r > 0 && x.x - r < s->width && x.y + r > 0 && x.y - r < s->height)) continue;
        s->spot[s->spots++] = (struct spot){ x, r, i, paint_body(&v->paint, p, i) };
    }
    return 0;
}

/* 1, 2 or 5 times a power of ten */
static double round_length(double x)
{
    double power = pow(10, floor(log10(x))), m = x / power;
    return power * (m < 2 ? 1 : m < 5 ? 2 : 5);
}

static void place_ground(struct ground *g, const struct view *v, const struct panel *f)
{
    vec3 n = camera_sees(&v->camera, f->n), foot = sample_of(v, f->corner[0]);
    g->n = v3(n.x, -n.y, n.z);
    g->plane[1] = -g->n.x / g->n.z, g->plane[2] = -g->n.y / g->n.z;
    g->plane[0] = foot.z - g->plane[1] * foot.x - g->plane[2] * foot.y;
    g->corners = f->corners;
    for (int k = 0; k < f->corners; k++) {
        vec3 at = sample_of(v, f->corner[k]);
        g->x[k] = at.x, g->y[k] = at.y;
    }
    const struct region *r = &v->region;
    double size = fmax(fmax(r->hi.x - r->lo.x, r->hi.y - r->lo.y), 1e-150);
    vec3 e = fabs(f->n.x) < 0.9 ? v3(1, 0, 0) : v3(0, 1, 0);
    vec3 along[2] = { v3_axpy(e, -v3_dot(e, f->n), f->n) };
    along[0] = v3_scale(1 / (round_length(size / 6) * v3_norm(along[0])), along[0]);
    along[1] = v3_cross(f->n, along[0]);
    // square[] is affine, so three points determine it
    vec3 at[3] = { { 0, 0, g->plane[0] },
                   { 1, 0, g->plane[0] + g->plane[1] },
                   { 0, 1, g->plane[0] + g->plane[2] } };
    for (int k = 0; k < 3; k++) at[k] = v3_sub(place_of(v, at[k]), f->origin);
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
    if (allocated) walls_build(b, p, &v->region);
    for (int i = 0; allocated && i < b->panels; i++)
        if (v3_dot(b->panel[i].n, v->camera.toward) > 1e-3)
            place_ground(&s->ground[s->grounds++], v, &b->panel[i]);
    for (int i = 0; allocated && i < b->edges; i++)
        s->edge[s->edges++] =
            (struct edge){ sample_of(v, b->edge[i].a), sample_of(v, b->edge[i].b) };
    free(b);
    return allocated ? 0 : -1;
}

int view_draw(const struct view *v, const struct packing *p, struct picture *pic, struct why *why)
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
        .thick = v->samples * fmax(0.5, longer / 1200.0),
    };
    *pic = (struct picture){ 0 };
    if (v->dim != p->dim)
        why_set(why, EX_DATAERR, "dim %d after dim %d in one series", p->dim, v->dim);
    else if (place_spots(&s, v, p) || place_walls(&s, v, p))
        why_set(why, EX_SOFTWARE, "no memory for %lld bodies", (long long)p->n);
    else if (!picture_init(pic, c->width, c->height, why) && raster_draw(&s, pic, why))
        picture_free(pic);
    free(s.spot), free(s.ground), free(s.edge);
    return why->status;
}
