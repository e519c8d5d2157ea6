/* draw/shade.c: normals, the hidden part of the sky, and the light of balls, discs and floors. */
#include "draw/shade.h"

#include <stdlib.h>

/* The memory of a band, and the samples near a point. */

int band_clamp(double x, int lo, int hi)
{
    return !(x > lo) ? lo : x >= hi ? hi : (int)x;
}

struct patch band_patch(const struct band *b, double x, double y, double r)
{
    return (struct patch){ band_clamp(ceil(x - r - 0.5), 0, b->width),
                           band_clamp(floor(x + r - 0.5) + 1, 0, b->width),
                           band_clamp(ceil(y - r - 0.5), b->y0, b->y1),
                           band_clamp(floor(y + r - 0.5) + 1, b->y0, b->y1) };
}

bool band_init(struct band *b, const struct raster *s, int rows)
{
    size_t n = (size_t)rows * (size_t)s->width;
    *b = (struct band){ .width = s->width };
    b->z = calloc(n, sizeof *b->z), b->what = calloc(n, sizeof *b->what);
    b->n = calloc(n, sizeof *b->n);
    size_t tiles = (size_t)(s->width / SHADE_TILE + 1) * (size_t)(rows / SHADE_TILE + 1);
    b->range = malloc(tiles * sizeof *b->range);
    b->dark = calloc(n, sizeof *b->dark), b->edge = calloc(n, sizeof *b->edge);
    if (s->panes) b->veil = calloc(n, sizeof *b->veil);
    b->spot = malloc((size_t)(s->spots + 1) * sizeof *b->spot);
    return b->z && b->what && b->n && b->range && b->dark && b->edge && b->spot &&
           (b->veil || !s->panes);
}

void band_free(struct band *b)
{
    free(b->z), free(b->what), free(b->n), free(b->range), free(b->dark), free(b->edge),
        free(b->spot), free(b->veil);
}

void shade_normals(struct band *b, const struct raster *s)
{
    for (int y = b->y0; y < b->y1; y++)
        for (int x = 0; x < b->width; x++) {
            size_t k = band_at(b, x, y);
            struct normal *n = &b->n[k];
            if (b->what[k] == NOTHING || b->what[k] <= SOLID) continue; // of these it is there
            if (b->what[k] <= GROUND) {
                vec3 g = s->ground[GROUND - b->what[k]].n;
                *n = (struct normal){ (float)g.x, (float)g.y, (float)g.z };
                continue;
            }
            const struct spot *o = &s->spot[b->what[k]];
            if (o->shape) continue; // it is there
            double i = 1 / o->r;
            *n = (struct normal){ (float)(i * (x + 0.5 - o->x.x)), (float)(i * (y + 0.5 - o->x.y)),
                                  (float)(i * (b->z[k] - o->x.z)) };
            float length2 = n->x * n->x + n->y * n->y + n->z * n->z;
            if (s->cutting.cuts && length2 < 0.999F) { // inside the ball: the face of the cut
                vec3 g = s->cutting.n;
                *n = (struct normal){ (float)g.x, (float)g.y, (float)g.z };
            }
        }
}

/* ---- the sky ---- */

/* The least and largest depth in each square; lo > hi where there is nothing. */
static void find_ranges(struct band *b)
{
    int across = (b->width + SHADE_TILE - 1) / SHADE_TILE;
    int down = (b->y1 - b->y0 + SHADE_TILE - 1) / SHADE_TILE;
    for (int i = 0; i < across * down; i++) b->range[i] = (struct span){ INFINITY, -INFINITY };
    for (int y = b->y0; y < b->y1; y++)
        for (int x = 0; x < b->width; x++) {
            size_t k = band_at(b, x, y);
            if (b->what[k] == NOTHING) continue;
            struct span *r = &b->range[(y - b->y0) / SHADE_TILE * across + x / SHADE_TILE];
            r->lo = fmin(r->lo, b->z[k]), r->hi = fmax(r->hi, b->z[k]);
        }
}

/* Adds what ball i hides of the sky over the samples t. */
static void darken(struct band *b, const struct spot *o, int64_t i, struct patch t)
{
    double far2 = SHADE_REACH * SHADE_REACH * o->dark * o->dark;
    for (int y = t.y0; y < t.y1; y++) {
        double dy = o->x.y - (y + 0.5);
        size_t row = band_at(b, 0, y);
        for (int x = t.x0; x < t.x1; x++) {
            size_t k = row + (size_t)x;
            double dx = o->x.x - (x + 0.5), dz = o->x.z - b->z[k];
            double d2 = dx * dx + dy * dy + dz * dz;
            if (!(d2 < far2) || b->what[k] == i || b->what[k] == NOTHING) continue;
            double toward = b->n[k].x * dx + b->n[k].y * dy + b->n[k].z * dz;
            if (toward <= 0) continue;
            // (r/d)^2 less its value at the reach, so that the shadow ends smoothly
            double part = o->dark * o->dark * (1 / d2 - 1 / far2);
            b->dark[k] += (float)(toward / sqrt(d2) * fmin(part, 1));
        }
    }
}

void shade_near(struct band *b, const struct raster *s)
{
    if (s->flat) return;
    find_ranges(b);
    int across = (b->width + SHADE_TILE - 1) / SHADE_TILE;
    for (int64_t k = 0; k < b->spots; k++) {
        int64_t i = b->spot[k];
        const struct spot *o = &s->spot[i];
        double reach = SHADE_REACH * o->dark;
        if (o->r < 1) continue; // smaller than a sample can show
        struct patch t = band_patch(b, o->x.x, o->x.y, reach);
        int line = (t.y0 - b->y0) / SHADE_TILE;
        for (int y = t.y0; y < t.y1; line++) {
            int below = b->y0 + (line + 1) * SHADE_TILE, column = t.x0 / SHADE_TILE;
            for (int x = t.x0; x < t.x1; column++) {
                int beside = (column + 1) * SHADE_TILE;
                const struct span *r = &b->range[line * across + column];
                struct patch here = { x, beside < t.x1 ? beside : t.x1, y,
                                      below < t.y1 ? below : t.y1 };
                if (o->x.z + reach > r->lo && o->x.z - reach < r->hi) darken(b, o, i, here);
                x = beside;
            }
            y = below;
        }
    }
}

/* ---- light ---- */

static const vec3 lamp = { -0.38, -0.52, 0.765 }; // unit vector to the lamp; y points down

/* Floors and edges are drawn faint, so their grey depends on the background. */
static bool bright_background(const struct raster *s)
{
    return s->background.r + s->background.g + s->background.b > 0.6F;
}

static struct rgb scaled(struct rgb a, float t, float plus)
{
    return (struct rgb){ a.r * t + plus, a.g * t + plus, a.b * t + plus };
}

/* The camera's axes right, up, toward in the axes of a body: a rotation kept for its next sample */
struct shade_turn {
    int64_t body;
    vec3 x, y, z;
};

/* (x, y, z) of the camera, in the axes of the body */
static vec3 camera_to_body(struct shade_turn *t, const struct raster *s, int64_t body, double x,
                           double y, double z)
{
    if (t->body != body) { // neighbouring samples mostly show the same body
        quat q = s->q[body];
        t->body = body;
        t->x = quat_turn_back(q, s->right), t->y = quat_turn_back(q, s->up),
        t->z = quat_turn_back(q, s->toward);
    }
    return v3_axpy(v3_axpy(v3_scale(x, t->x), y, t->y), z, t->z);
}

/* A solid facet: as a ball is lit, without a reflection, which would make it flicker where it turns */
static struct rgb solid_light(const struct band *b, const struct raster *s, size_t k)
{
    struct normal n = b->n[k];
    double lambert = fmax(0, n.x * lamp.x + n.y * lamp.y + n.z * lamp.z);
    double open = 1 / (1 + 2 * b->dark[k]);
    double light = open * (0.40 + 0.16 * fmax(0, -n.y)) + sqrt(open) * 0.60 * lambert;
    return scaled(s->pane[SOLID - b->what[k]].own, (float)light, 0);
}

static struct rgb ball_light(const struct band *b, const struct raster *s, size_t k,
                             struct shade_turn *t)
{
    const struct spot *o = &s->spot[b->what[k]];
    struct normal n = b->n[k];
    bool facets = o->shape && shape_has_faces(o->shape); // which show themselves how it turns
    vec3 at = camera_to_body(t, s, o->body, n.x, -n.y, n.z);
    if (o->shape && o->shape->form == SHAPE_CAPSULE) at = v3(at.y, at.z, at.x); // poles at its ends
    struct rgb own = facets ? o->own : paint_ball(s->paint, o->own, at);
    double lambert = fmax(0, n.x * lamp.x + n.y * lamp.y + n.z * lamp.z);
    double open = 1 / (1 + 2 * b->dark[k]);
    // Blinn: h is half way between the lamp and the viewer
    double hz = lamp.z + 1, h = 1 / sqrt(lamp.x * lamp.x + lamp.y * lamp.y + hz * hz);
    double shine = fmax(0, h * (n.x * lamp.x + n.y * lamp.y + n.z * hz));
    for (int i = 0; i < 5; i++) shine *= shine; // to the 32nd power
    double light = open * (0.34 + 0.16 * fmax(0, -n.y)) + sqrt(open) * 0.72 * lambert;
    return scaled(own, (float)light, (float)(0.16 * shine * open));
}

static struct rgb disc_light(const struct raster *s, const struct spot *o, float depth, double x,
                             double y, struct shade_turn *t)
{
    if (o->shape) { // a rim of 0.7 pixels
        double least = fmin(0.3 * o->r, fmax(0.04 * o->r, s->samples * 0.7));
        return scaled(o->own, depth < least ? 0.25F : 0.9F, 0);
    }
    double dx = (x - o->x.x) / o->r, dy = (o->x.y - y) / o->r, d2 = dx * dx + dy * dy;
    struct rgb own = paint_disc(s->paint, o->own, camera_to_body(t, s, o->body, dx, dy, 0));
    double rim = 1 - fmax(0.08, s->samples * 0.7 / o->r); // at least 0.7 pixels
    return scaled(own, rim > 0 && d2 > rim * rim ? 0.25F : 0.95F - 0.2F * (float)d2, 0);
}

static struct rgb ground_shown(const struct band *b, const struct raster *s, size_t k, double x,
                               double y)
{
    const struct ground *g = &s->ground[GROUND - b->what[k]];
    double sum = 0;
    double over = g->over[0] + g->over[1] * x + g->over[2] * y;
    for (int i = 0; i < 2; i++)
        sum += floor((g->square[i][0] + g->square[i][1] * x + g->square[i][2] * y) / over);
    bool odd = sum - 2 * floor(0.5 * sum) > 0.5;
    float light = bright_background(s) ? (odd ? 0.73F : 0.86F) : (odd ? 0.05F : 0.08F);
    light /= 1 + 1.3F * b->dark[k];
    return (struct rgb){ light, light, light };
}

static struct rgb behind_glass(struct rgb seen, const struct veil *v)
{
    if (!(v->parts > 0)) return seen;
    static const struct rgb glass = { 0.62F, 0.74F, 0.86F };
    float light = v->lights / v->parts;
    return rgb_mix(seen, scaled(glass, light, 0), 1 - v->passes);
}

static struct rgb shade_sample(const struct band *b, const struct raster *s, int x, int y,
                               struct shade_turn *t)
{
    size_t k = band_at(b, x, y);
    int64_t what = b->what[k];
    struct rgb c = what == NOTHING  ? s->background
                   : what <= SOLID  ? solid_light(b, s, k)
                   : what <= GROUND ? ground_shown(b, s, k, x + 0.5, y + 0.5)
                   : s->flat        ? disc_light(s, &s->spot[what], b->n[k].x, x + 0.5, y + 0.5, t)
                                    : ball_light(b, s, k, t);
    if (what >= 0 && s->pale > 0) c = rgb_mix(c, s->background, s->pale);
    if (s->panes) c = behind_glass(c, &b->veil[k]);
    if (!(b->edge[k] > 0)) return c;
    float line = bright_background(s) ? 0.08F : 0.4F;
    return rgb_mix(c, (struct rgb){ line, line, line }, b->edge[k]);
}

void shade_pixels(const struct band *b, const struct raster *s, struct picture *p)
{
    struct shade_turn t = { .body = -1 };
    const int n = s->samples;
    const float mean = 1.0F / (float)(n * n);
    for (int row = b->y0 / n; row < b->y1 / n; row++)
        for (int column = 0; column < p->width; column++) {
            struct rgb sum = { 0, 0, 0 };
            for (int y = 0; y < n; y++)
                for (int x = 0; x < n; x++) {
                    struct rgb c = shade_sample(b, s, column * n + x, row * n + y, &t);
                    // brighter than white counts as white, or outlines would be ragged
                    sum.r += fminf(c.r, 1), sum.g += fminf(c.g, 1), sum.b += fminf(c.b, 1);
                }
            unsigned char *out = p->rgb + 3 * ((size_t)row * (size_t)p->width + (size_t)column);
            out[0] = rgb_byte(sum.r * mean);
            out[1] = rgb_byte(sum.g * mean);
            out[2] = rgb_byte(sum.b * mean);
        }
}
