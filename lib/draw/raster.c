/* draw/raster.c: what is in front at each sample, band by band. */
#include "draw/raster.h"

#include "base/team.h"
#include "draw/ray.h"
#include "draw/shade.h"

#include <stdlib.h>

/* Samples of a band, about 40 bytes each. A band has at least one row of pixels. */
enum { BAND_SAMPLES = 1 << 17 };

/* ---- what is in front ---- */

/* Where a line of sight at (x, y) comes out of a ball, at *z, that it enters at `under`, once what is
   to be cut away is; false where nothing is left. */
static bool cut_ball(const struct cutting *c, double x, double y, double under, double *z)
{
    double beside = c->side[0] * x + c->side[1] * y + c->side[3], slope = c->side[2];
    if (beside + slope * *z <= 0) return true;
    if (!(slope > 0)) return false; // all that is behind is cut away too
    *z = -beside / slope;
    return *z >= under;
}

/* A body of another shape: its normal, or in the plane how deep the sample lies in it, is known here, and
   kept. */
static void raster_draw_shape(struct band *b, const struct raster *s, int64_t i)
{
    const struct spot *o = &s->spot[i];
    struct patch t = band_patch(b, o->x.x, o->x.y, o->r);
    quat q = s->q[o->body];
    double unit = 1 / o->r;
    vec3 right = quat_turn_back(q, v3_scale(unit, s->right)),
         down = quat_turn_back(q, v3_scale(-unit, s->up)), toward = quat_turn_back(q, s->toward);
    for (int y = t.y0; y < t.y1; y++)
        for (int x = t.x0; x < t.x1; x++) {
            size_t k = band_at(b, x, y);
            const double *side = s->cutting.side;
            struct ray line = { v3_axpy(v3_scale(x + 0.5 - o->x.x, right), y + 0.5 - o->x.y, down),
                                toward, INFINITY };
            double beside = side[0] * (x + 0.5) + side[1] * (y + 0.5) + side[3], at, z = o->x.z;
            vec3 n = v3(0, 0, 1);
            if (s->cutting.cuts && side[2] > 0) line.before = unit * (-beside / side[2] - o->x.z);
            if (s->flat) {
                n.x = o->r * ray_depth(o->shape, line.from);
                if (n.x < 0) continue;
            } else {
                if (!ray_meets(o->shape, &line, &at, &n)) continue;
                z += o->r * at;
                if (s->cutting.cuts && !(side[2] > 0) && beside + side[2] * z > 0) continue;
                n = v3_dot(n, n) > 0 ? quat_turn(q, n) : v3(0, 0, 0);
            }
            if (!(z > b->z[k])) continue;
            b->z[k] = z, b->what[k] = i;
            vec3 seen = v3(v3_dot(n, s->right), -v3_dot(n, s->up), v3_dot(n, s->toward));
            if (s->flat) seen = n;
            if (v3_dot(n, n) == 0) seen = s->cutting.n;
            b->n[k] = (struct normal){ (float)seen.x, (float)seen.y, (float)seen.z };
        }
}

static void draw_spot(struct band *b, const struct raster *s, int64_t i)
{
    const struct spot *o = &s->spot[i];
    if (o->shape) {
        raster_draw_shape(b, s, i);
        return;
    }
    struct patch t = band_patch(b, o->x.x, o->x.y, o->r);
    double r2 = o->r * o->r;
    for (int y = t.y0; y < t.y1; y++) {
        double dy = y + 0.5 - o->x.y, left = r2 - dy * dy;
        size_t row = band_at(b, 0, y);
        for (int x = t.x0; x < t.x1; x++) {
            double dx = x + 0.5 - o->x.x, h2 = left - dx * dx;
            if (h2 < 0) continue;
            double h = s->flat ? 0 : sqrt(h2), z = o->x.z + h;
            if (s->cutting.cuts && !cut_ball(&s->cutting, x + 0.5, y + 0.5, o->x.z - h, &z))
                continue;
            if (z > b->z[row + (size_t)x]) b->z[row + (size_t)x] = z, b->what[row + (size_t)x] = i;
        }
    }
}

/* Samples of a row, from x to before end */
struct raster_run {
    int x, end;
};

/* Those of the row y with their middle inside a polygon */
static struct raster_run row_inside(const struct band *b, const double *px, const double *py,
                                    int corners, int y)
{
    double x0 = INFINITY, x1 = -INFINITY, at = y + 0.5;
    for (int k = 0; k < corners; k++) { // where its sides cross this row
        int l = (k + 1) % corners;
        if ((py[k] <= at) == (py[l] <= at)) continue;
        double x = px[k] + (at - py[k]) / (py[l] - py[k]) * (px[l] - px[k]);
        x0 = fmin(x0, x), x1 = fmax(x1, x);
    }
    return (struct raster_run){ band_clamp(ceil(x0 - 0.5), 0, b->width),
                                band_clamp(ceil(x1 - 0.5), 0, b->width) };
}

static void draw_ground(struct band *b, const struct raster *s, int i)
{
    const struct ground *g = &s->ground[i];
    for (int y = b->y0; y < b->y1; y++) {
        const struct raster_run run = row_inside(b, g->x, g->y, g->corners, y);
        double at = y + 0.5;
        for (int x = run.x; x < run.end; x++) {
            size_t k = band_at(b, x, y);
            double z = g->plane[0] + g->plane[1] * (x + 0.5) + g->plane[2] * at;
            if (z > b->z[k]) b->z[k] = z, b->what[k] = GROUND - i;
        }
    }
}

/* Pane i: one that is solid hides what is behind it, one of glass veils it. */
static void draw_pane(struct band *b, const struct raster *s, int64_t i)
{
    const struct pane *p = &s->pane[i];
    const bool solid = p->own.r >= 0;
    const double *side = s->cutting.side;
    int y0 = band_clamp(ceil(fmin(p->y[0], fmin(p->y[1], p->y[2])) - 0.5), b->y0, b->y1);
    int y1 = band_clamp(ceil(fmax(p->y[0], fmax(p->y[1], p->y[2])) - 0.5), b->y0, b->y1);
    for (int y = y0; y < y1; y++) {
        const struct raster_run run = row_inside(b, p->x, p->y, 3, y);
        double at = y + 0.5;
        for (int x = run.x; x < run.end; x++) {
            double z = p->plane[0] + p->plane[1] * (x + 0.5) + p->plane[2] * at;
            size_t k = band_at(b, x, y);
            if (!(solid ? z >= b->z[k] : z > b->z[k])) continue; // solid: also in a floor's place
            if (s->cutting.cuts && side[0] * (x + 0.5) + side[1] * at + side[2] * z + side[3] > 0)
                continue;
            if (solid) {
                b->z[k] = z, b->what[k] = SOLID - i;
                b->n[k] = (struct normal){ (float)p->n.x, (float)p->n.y, (float)p->n.z };
                continue;
            }
            struct veil *v = &b->veil[k];
            v->passes *= 1 - p->part, v->parts += p->part, v->lights += p->part * p->light;
        }
    }
}

/* The depth of what is seen at k; of a floor that of its plane at (-x, -y) from there. */
static double depth_beside(const struct band *b, const struct raster *s, size_t k, double x,
                           double y)
{
    if (b->what[k] > GROUND) return b->z[k];
    const double *plane = b->what[k] <= SOLID ? s->pane[SOLID - b->what[k]].plane
                                              : s->ground[GROUND - b->what[k]].plane;
    return b->z[k] - plane[1] * x - plane[2] * y;
}

/* An edge is hidden by what is in front of it, and faint over bodies behind it. */
static void draw_edge(struct band *b, const struct raster *s, const struct edge *e)
{
    double dx = e->b.x - e->a.x, dy = e->b.y - e->a.y, length2 = dx * dx + dy * dy;
    double h = s->thick + 0.5 * s->samples; // with its soft border
    int y0 = band_clamp(floor(fmin(e->a.y, e->b.y) - h), b->y0, b->y1);
    int y1 = band_clamp(ceil(fmax(e->a.y, e->b.y) + h), b->y0, b->y1);
    for (int y = y0; y < y1; y++) {
        // the row crosses a slanting edge in a short piece, `half` to each side of `middle`
        double py = y + 0.5 - e->a.y, half = h * sqrt(length2) / fabs(dy), middle = py * dx / dy;
        double lo = fmin(0, dx) - h, hi = fmax(0, dx) + h;
        if (fabs(dy) > 1e-9) lo = fmax(lo, middle - half), hi = fmin(hi, middle + half);
        int end = band_clamp(ceil(e->a.x + hi), 0, b->width);
        for (int x = band_clamp(floor(e->a.x + lo), 0, b->width); x < end; x++) {
            double px = x + 0.5 - e->a.x, t = length2 > 0 ? (px * dx + py * dy) / length2 : 0;
            t = fmin(fmax(t, 0), 1);
            double ox = px - t * dx, oy = py - t * dy;
            double d = sqrt(ox * ox + oy * oy);
            if (d >= h) continue;
            size_t k = band_at(b, x, y);
            if (e->a.z + t * (e->b.z - e->a.z) < depth_beside(b, s, k, ox, oy) - 3 * h) continue;
            float full = b->what[k] >= 0 ? 0.3F : 1;
            b->edge[k] = fmaxf(b->edge[k], full * fminf((float)(h - d) / (float)s->samples, 1));
        }
    }
}

/* ---- a band ---- */

static void band_draw(struct band *b, const struct raster *s, struct picture *p)
{
    size_t n = (size_t)(b->y1 - b->y0) * (size_t)b->width;
    for (size_t k = 0; k < n; k++)
        b->z[k] = -INFINITY, b->what[k] = NOTHING, b->dark[k] = b->edge[k] = 0;
    for (size_t k = 0; s->panes && k < n; k++) b->veil[k] = (struct veil){ 1, 0, 0 };
    b->spots = 0;
    for (int64_t i = 0; i < s->spots; i++) { // those that are seen in it or darken it
        const struct spot *o = &s->spot[i];
        double reach = SHADE_REACH * o->r;
        if (o->x.y + reach > b->y0 && o->x.y - reach < b->y1) b->spot[b->spots++] = i;
    }
    for (int i = 0; i < s->grounds; i++) draw_ground(b, s, i);
    for (int64_t i = 0; i < b->spots; i++) draw_spot(b, s, b->spot[i]);
    for (int64_t i = 0; i < s->panes; i++)
        if (s->pane[i].own.r >= 0) draw_pane(b, s, i);
    for (int64_t i = 0; i < s->panes; i++)
        if (s->pane[i].own.r < 0) draw_pane(b, s, i);
    for (int i = 0; i < s->edges; i++) draw_edge(b, s, &s->edge[i]);
    shade_normals(b, s);
    shade_near(b, s);
    shade_pixels(b, s, p);
}

/* The bands of a picture, which threads take one after another */
struct bands {
    const struct raster *s;
    struct picture *p;
    int rows; /* of pixels, a band */
    _Atomic int next;
    _Atomic bool failed; /* for want of memory */
};

static void draw_bands(void *arg, int me, int threads)
{
    struct bands *d = arg;
    struct band b;
    (void)me, (void)threads;
    bool allocated = band_init(&b, d->s, d->rows * d->s->samples);
    if (!allocated) d->failed = true;
    for (int y; allocated && (y = atomic_fetch_add(&d->next, d->rows)) < d->p->height;) {
        int end = y + d->rows < d->p->height ? y + d->rows : d->p->height;
        b.y0 = y * d->s->samples, b.y1 = end * d->s->samples;
        band_draw(&b, d->s, d->p);
    }
    band_free(&b);
}

int raster_draw(const struct raster *s, struct picture *p, struct failure *failure)
{
    int rows = BAND_SAMPLES / (s->width * s->samples);
    struct bands d = { s, p, rows < 1 ? 1 : rows > p->height ? p->height : rows, 0, false };
    team_do(s->threads, draw_bands, &d);
    return d.failed ? failure_set(failure, EX_SOFTWARE, "no memory for the picture") : 0;
}
