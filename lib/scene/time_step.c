/* scene/time_step.c: limits of the time step [scene/time_step.h]. */
#include "scene/time_step.h"

#include "base/text.h"
#include "contact/detect.h"
#include "shape/wall_edge.h"
#include "state/servo_box.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LASTING                                                                                    \
    (2 * OVERLAP_NEAR) /* of the smallest radius: what an acceleration may bring in a step */
#define PASSING TIME_STEP_TOLERANCE /* of it: what a body may move before an impact */
#define TURN    0.02                /* rad a step */
#define PERIOD  200                 /* steps a period */
/* Solid fractions of what has fallen, by dimension: how far the highest grains fall */
static const double SETTLED[4] = { 0, 0, 0.8, 0.6 };
/* To see how far, each horizontal direction is cut into so many parts at most, of so many of the largest
   radii at least. */
enum { COLUMNS = 16, WIDE = 6 };
#define TOUCHING 0.05 /* of the smallest radius: the gap across which a body rests on another */
#define BELOW    0.2 /* the vertical part of the normal with which a wall carries a body, at least */

const struct time_step_limit time_step_limit[LIMITS] = {
    [LIMIT_GRAVITY] = { "gravity", "gravity", "m s-2", "g dt^2 <= 0.002 r", BY_ACCELERATION,
                        LASTING },
    [LIMIT_PRESSURE] = { "pressure", "acceleration of a grain by the pressure", "m s-2",
                         "a dt^2 <= 0.002 r", BY_ACCELERATION, LASTING },
    [LIMIT_LOAD] = { "load", "acceleration of a wall or an edge by its load", "m s-2",
                     "a dt^2 <= 0.002 r", BY_ACCELERATION, LASTING },
    [LIMIT_STRAIN] = { "strain", "rate of strain of the cell", "s-1", "L 2 r dt <= 0.002 r",
                       BY_RATE, LASTING / 2 },
    [LIMIT_SPEED] = { "speed", "speed of grains at the start", "m s-1", "v dt <= 0.05 r", BY_SPEED,
                      PASSING },
    [LIMIT_FALL] = { "fall", "speed of grains after their fall", "m s-1", "v dt <= 0.05 r",
                     BY_SPEED, PASSING },
    [LIMIT_STROKE] = { "stroke", "speed of a wall when its load has pressed the grains together",
                       "m s-1", "v dt <= 0.05 r", BY_SPEED, PASSING },
    [LIMIT_WALL] = { "wall", "speed of walls", "m s-1", "v dt <= 0.05 r", BY_SPEED, PASSING },
    [LIMIT_TURN] = { "turn", "angular velocity of walls", "rad s-1", "w dt <= 0.02", BY_RATE,
                     TURN },
    [LIMIT_PERIOD] = { "period", "frequency of drives", "Hz", "f dt <= 1/200", BY_RATE,
                       1.0 / PERIOD },
};

/* ---- grains ---- */

/* Radii: half the thickness of the ellipsoid with these moments, of dim 2 of the disc with this area */
static double thinness(const struct shape *s, int dim)
{
    if (!s) return 1;
    if (dim == 2) return sqrt(s->volume / M_PI);
    double all = s->moment[0] + s->moment[1] + s->moment[2], least = 1;
    for (int k = 0; k < 3; k++) // twice the mean of x_k^2, which is h^2/5 of an ellipsoid
        least = dmin(least, (all - 2 * s->moment[k]) / 2);
    return sqrt(5 * dmax(least, 0));
}

static double smallest(const struct scene *s, const struct packing *p)
{
    double r = INFINITY;
    for (int64_t i = 0; i < p->n; i++)
        if (p->mass[i] > 0) r = dmin(r, p->radius[i] * thinness(packing_shape(p, i), p->dim));
    for (int32_t k = 0; k < s->pours; k++) {
        int32_t shape = s->pour[k].form.shape;
        r = dmin(r, s->pour[k].size.min * thinness(shape ? &s->shapes.s[shape] : NULL, p->dim));
    }
    return r;
}

/* a^dim */
static double time_step_power(double a, int dim)
{
    return dim == 1 ? a : dim == 2 ? a * a : a * a * a;
}

/* m^2/kg, in the plane m/kg: of the grain that a pressure accelerates most */
static double lightest(const struct packing *p)
{
    double most = 0;
    for (int64_t i = 0; i < p->n; i++)
        if (p->mass[i] > 0)
            most = dmax(most, time_step_power(2 * p->radius[i], p->dim - 1) / p->mass[i]);
    return most;
}

/* ---- the flow of a cell ---- */

/* 1/s: the edges' own rates, as a velocity gradient */
static void flow_of(const struct cell *c, vec3 inverse[3], double L[3][3])
{
    cell_inverse(c->edge, inverse);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double sum = 0;
            for (int k = 0; k < 3; k++) {
                const double rate[3] = { c->rate[k].x, c->rate[k].y, c->rate[k].z };
                const double u[3] = { inverse[k].x, inverse[k].y, inverse[k].z };
                sum += rate[i] * u[j];
            }
            L[i][j] = sum;
        }
}

static double norm_of(double L[3][3])
{
    double sum = 0;
    for (int k = 0; k < 9; k++) sum += L[k / 3][k % 3] * L[k / 3][k % 3];
    return sqrt(sum);
}

static double time_step_strain_of(const struct cell *c)
{
    vec3 inverse[3];
    double L[3][3], most;
    if (!cell_repeats(c)) return 0;
    flow_of(c, inverse, L);
    most = norm_of(L);
    for (int32_t m = 0; m < c->gradients; m++) {
        memcpy(L, c->gradient[m].L, sizeof L);
        most = dmax(most, norm_of(L));
    }
    return most;
}

/* ---- speeds ---- */

static double start_speed(const struct scene *s, const struct packing *p)
{
    vec3 inverse[3];
    double most = 0;
    cell_inverse(p->cell.edge, inverse);
    for (int64_t i = 0; i < p->n; i++) {
        vec3 v = p->v[i], d = v3_sub(p->x[i], p->cell.origin);
        for (int k = 0; k < 3 && cell_repeats(&p->cell); k++)
            v = v3_axpy(v, -v3_dot(inverse[k], d), p->cell.rate[k]);
        double spin = packing_shape(p, i) ? p->radius[i] * v3_norm(p->w[i]) : 0;
        most = dmax(most, v3_norm(v) + spin);
    }
    for (int32_t k = 0; k < s->pours; k++) most = dmax(most, v3_norm(s->pour[k].v));
    return most;
}

/* m: how high x is, along up, above the nearest plane below it; INFINITY: there is none */
static double above_planes(const struct packing *p, vec3 x, vec3 up)
{
    double least = INFINITY;
    for (int32_t k = 0; k < p->walls; k++) {
        const struct wall *w = &p->wall[k];
        if (w->shape != WALL_PLANE || !wall_there(w, p->t)) continue;
        vec3 n = wall_normal(p, w, p->t);
        double slope = v3_dot(n, up), h = v3_dot(n, v3_sub(x, wall_at(p, w, p->t)));
        if (slope > 0.5 && h >= 0) least = dmin(least, h / slope);
    }
    return least;
}

/* m: how low, along up, a surface that ends somewhere reaches; INFINITY: it does not end */
static double lowest_of(const struct packing *p, const struct wall *w, vec3 up)
{
    struct pose at = wall_pose(p, w, p->t);
    vec3 x = wall_at(p, w, p->t), n = wall_normal(p, w, p->t), a = quat_turn(at.q, w->along);
    double tilt = sqrt(dmax(0, 1 - v3_dot(n, up) * v3_dot(n, up))), low = INFINITY;
    switch (w->shape) {
    case WALL_RECTANGLE:
        return v3_dot(x, up) -
               (w->size[0] * fabs(v3_dot(a, up)) + w->size[1] * fabs(v3_dot(v3_cross(n, a), up))) /
                   2;
    case WALL_DISC:
        return v3_dot(x, up) - w->size[1] * tilt;
    case WALL_CYLINDER:
    case WALL_CONE:
        for (int end = 0; end < 2 && (w->size[2] > 0 || tilt == 1); end++) {
            double r = w->size[w->shape == WALL_CONE && end];
            low = dmin(low, v3_dot(v3_axpy(x, end * w->size[2], n), up) - r * tilt);
        }
        return low;
    case WALL_SPHERE:
        return v3_dot(x, up) - w->size[0];
    case WALL_MESH:
        for (int32_t k = 0; k < w->elements; k++)
            for (int c = 0; c < p->dim; c++) {
                vec3 v = p->mesh.vertex[p->mesh.element[w->first_element + k][c]];
                low = dmin(low, v3_dot(v3_add(x, quat_turn(at.q, v)), up));
            }
        return low;
    default:
        return INFINITY;
    }
}

/* m: the lowest place of all of them */
static double lowest_surface(const struct packing *p, vec3 up)
{
    double low = INFINITY;
    for (int32_t k = 0; k < p->walls; k++)
        if (wall_there(&p->wall[k], p->t)) low = dmin(low, lowest_of(p, &p->wall[k], up));
    return low;
}

/* Walls, and the surfaces of meshes, below bodies that fall */
struct time_step_ground {
    const struct packing *p;
    vec3 up;
    double low;              /* m: where surfaces end below */
    struct surface *surface; /* [walls] of meshes; NULL where memory is short: these are not seen */
};

static struct time_step_ground ground_of(const struct packing *p, vec3 up)
{
    struct time_step_ground g = { p, up, lowest_surface(p, up), NULL };
    struct failure failure = { 0 };
    g.surface = calloc((size_t)p->walls + 1, sizeof *g.surface);
    for (int32_t k = 0; g.surface && k < p->walls; k++) {
        const struct wall *w = &p->wall[k];
        if (w->shape != WALL_MESH || !wall_there(w, p->t)) continue;
        if (surface_init(&g.surface[k], &p->mesh, w->first_element, w->elements, w->weld, &failure))
            g.surface[k].n = 0;
    }
    return g;
}

static void ground_free(struct time_step_ground *g)
{
    for (int32_t k = 0; g->surface && k < g->p->walls; k++) surface_free(&g->surface[k]);
    free(g->surface);
}

enum { HALVINGS = 40 }; /* of the way down, to where a surface is */

/* m: how high x is above the rectangle, disc or mesh that is within `most` (m) below it; INFINITY: it is not */
static double above_surface(const struct time_step_ground *g, int32_t k, vec3 x, double most)
{
    const struct packing *p = g->p;
    const struct wall *w = &p->wall[k];
    const bool mesh = w->shape == WALL_MESH;
    const struct surface *s = mesh && g->surface ? &g->surface[k] : NULL;
    if (mesh ? !s || !s->n : w->shape != WALL_RECTANGLE && w->shape != WALL_DISC) return INFINITY;
    const struct pose at = wall_pose(p, w, p->t);
    const vec3 from = quat_turn_back(at.q, v3_sub(x, wall_at(p, w, p->t))),
               down = quat_turn_back(at.q, v3_scale(-1, g->up));
    double near = 0, far = most;
    if (!wall_between(w, p->dim, s, from, v3_axpy(from, far, down))) return INFINITY;
    for (int i = 0; i < HALVINGS; i++) {
        double middle = (near + far) / 2;
        *(wall_between(w, p->dim, s, from, v3_axpy(from, middle, down)) ? &far : &near) = middle;
    }
    return far;
}

/* m: how high x is above what is below it; INFINITY: nothing is */
static double above_ground(const struct time_step_ground *g, vec3 x)
{
    double least = above_planes(g->p, x, g->up), most = v3_dot(x, g->up) - g->low;
    most = isfinite(g->low) ? dmin(least, dmax(0, most) * (1 + 1e-9)) : least;
    for (int32_t k = 0; k < g->p->walls && most > 0 && isfinite(most); k++)
        if (wall_there(&g->p->wall[k], g->p->t)) least = dmin(least, above_surface(g, k, x, most));
    return least;
}

/* Two unit vectors across a third; in the plane the second is z */
static void time_step_across(int dim, vec3 n, vec3 side[2])
{
    vec3 z = v3(0, 0, 1);
    side[0] = dim == 2 || fabs(n.z) < 0.5 ? v3_cross(n, z) : v3_cross(n, v3(1, 0, 0));
    side[0] = v3_scale(1 / v3_norm(side[0]), side[0]);
    side[1] = v3_cross(n, side[0]);
}

/* m: from where to where the bodies reach in a direction */
static void time_step_extent(const struct packing *p, vec3 n, double range[2])
{
    range[0] = INFINITY, range[1] = -INFINITY;
    for (int64_t i = 0; i < p->n; i++) {
        double at = v3_dot(p->x[i], n);
        range[0] = dmin(range[0], at - p->radius[i]);
        range[1] = dmax(range[1], at + p->radius[i]);
    }
}

/* ---- what rests already ---- */

/* One body on another, or on a wall */
struct support {
    double z;             /* m: the centre of the upper one */
    int32_t upper, lower; /* lower < 0: a wall */
};

static int by_height(const void *x, const void *y)
{
    const struct support *a = x, *b = y;
    return a->z < b->z ? -1 : a->z > b->z ? 1 : a->upper - b->upper;
}

/* The supports that contacts are; returns how many */
static int64_t supports_of(const struct packing *p, const struct contacts *s, vec3 up,
                           struct support *on)
{
    int64_t n = 0;
    for (int64_t i = 0; i < s->n; i++) {
        const struct contact *c = &s->c[i];
        double rise = v3_dot(c->n, up);
        if (c->a < 0 && rise < BELOW) continue;
        int32_t upper = rise < 0 ? c->a : c->b, lower = rise < 0 ? c->b : c->a;
        on[n++] = (struct support){ v3_dot(p->x[upper], up), upper, lower };
    }
    return n;
}

/* rests[n] = whether a body rests on walls, on bodies that do not move, or on others that rest. Where memory is
   short, or contacts cannot be found, none does. */
static void find_resting(const struct packing *p, vec3 up, double gap, bool *rests)
{
    struct contacts s = { 0 };
    struct failure failure = { 0 };
    bool found = !detect_contacts_at(&s, p, p->x, p->t, gap, &failure);
    struct support *on = found ? malloc((size_t)(s.n + 1) * sizeof *on) : NULL;
    int64_t n = on ? supports_of(p, &s, up, on) : 0;
    if (n) qsort(on, (size_t)n, sizeof *on, by_height);
    for (int64_t i = 0; i < p->n; i++) rests[i] = p->mass[i] == 0;
    for (int64_t i = 0; i < n; i++)
        if (on[i].lower < 0 || rests[on[i].lower]) rests[on[i].upper] = true;
    free(on);
    contacts_free(&s);
}

/* A column of bodies: where those end that fall, and how much they are */
struct stack {
    double top, bottom; /* m */
    double floor;       /* m: the top of what rests */
    double volume;      /* m^3, in the plane m^2 */
};

static double time_step_volume_of(const struct packing *p, int64_t i)
{
    const struct shape *s = packing_shape(p, i);
    double unit = s ? s->volume : p->dim == 2 ? M_PI : 4 * M_PI / 3;
    return unit * time_step_power(p->radius[i], p->dim);
}

static void column_add(struct stack *c, const struct time_step_ground *g, int64_t i, bool rests)
{
    const struct packing *p = g->p;
    double z = v3_dot(p->x[i], g->up), r = p->radius[i], h;
    if (rests && p->mass[i] > 0) {
        c->floor = dmax(c->floor, z + r);
        return;
    }
    if (!(p->mass[i] > 0)) { // does not fall, but stops what does
        c->bottom = dmin(c->bottom, z + r);
        return;
    }
    c->top = dmax(c->top, z + r), h = above_ground(g, p->x[i]);
    c->bottom = dmin(c->bottom, isfinite(h) ? z - h : dmin(z - r, g->low));
    c->volume += time_step_volume_of(p, i);
}

/* m: how far the highest bodies fall until they rest on those below them, or on walls */
static double fall_of_bodies(const struct packing *p, vec3 up)
{
    struct stack column[COLUMNS * COLUMNS];
    double large = packing_whole(p).large, from[2] = { 0 }, width[2] = { 1, 1 }, most = 0;
    struct time_step_ground ground = ground_of(p, up);
    int n[2] = { 1, 1 };
    vec3 side[2];
    time_step_across(p->dim, up, side);
    for (int a = 0; a < p->dim - 1; a++) {
        double range[2];
        time_step_extent(p, side[a], range);
        from[a] = range[0];
        n[a] = (int)dmax(1, dmin(COLUMNS, (range[1] - range[0]) / (WIDE * large)));
        width[a] = (range[1] - range[0]) / n[a];
    }
    for (int k = 0; k < n[0] * n[1]; k++)
        column[k] = (struct stack){ -INFINITY, INFINITY, -INFINITY, 0 };
    bool *rests = calloc((size_t)p->n + 1, sizeof *rests);
    if (rests) find_resting(p, up, TOUCHING * packing_whole(p).small, rests);
    for (int64_t i = 0; i < p->n; i++) {
        int at[2] = { 0, 0 };
        for (int a = 0; a < p->dim - 1; a++)
            at[a] = (int)dmin(n[a] - 1, (v3_dot(p->x[i], side[a]) - from[a]) / width[a]);
        column_add(&column[at[0] * n[1] + at[1]], &ground, i, rests && rests[i]);
    }
    for (int k = 0; k < n[0] * n[1]; k++) {
        double settled = column[k].volume / (SETTLED[p->dim == 2 ? 2 : 3] * width[0] * width[1]);
        double bottom = dmax(column[k].floor, column[k].bottom);
        if (settled > 0) most = dmax(most, column[k].top - bottom - settled);
    }
    free(rests);
    ground_free(&ground);
    return most;
}

/* m: from the highest place of an opening to what is below it, or to the lowest body */
static double fall_of_pour(const struct scene_pour *pour, const struct packing *p, vec3 up)
{
    vec3 x = pour->center, reach = v3(0, 0, 0);
    double range[2], low;
    if (!pour->disc) {
        const double *lo = pour->box.lo, *hi = pour->box.hi;
        x = v3((lo[0] + hi[0]) / 2, (lo[1] + hi[1]) / 2, p->dim == 2 ? 0 : (lo[2] + hi[2]) / 2);
        reach = v3_sub(v3(hi[0], hi[1], p->dim == 2 ? 0 : hi[2]), x);
    }
    struct time_step_ground ground = ground_of(p, up);
    double h = above_ground(&ground, x);
    ground_free(&ground);
    time_step_extent(p, up, range);
    low = isfinite(h) ? h : dmax(0, p->n ? v3_dot(x, up) - range[0] : 0);
    return low + fabs(up.x * reach.x) + fabs(up.y * reach.y) + fabs(up.z * reach.z);
}

static double fall_speed(const struct scene *s, const struct packing *p, double start)
{
    double g = v3_norm(p->g);
    if (!(g > 0)) return 0;
    vec3 up = v3_scale(-1 / g, p->g);
    double h = fall_of_bodies(p, up);
    for (int32_t k = 0; k < s->pours; k++) h = dmax(h, fall_of_pour(&s->pour[k], p, up));
    return h > 0 ? sqrt(start * start + 2 * g * h) : 0;
}

/* ---- walls and what pushes them ---- */

/* N, N m: the largest that the load of a wall comes to */
static double load_most(const struct packing *p, const struct wall *w)
{
    double most = fabs(w->load.force);
    for (int32_t i = w->first_push; i < w->first_push + w->pushes; i++) {
        const struct drive *k = &p->pushes.drive[i];
        double one = fabs(k->value);
        for (int32_t r = 0; r < k->rows; r++) one = dmax(one, fabs(p->pushes.row[k->first + r].s));
        most += one;
    }
    return w->load.spread ? most * wall_face(p, w, p->t) : most;
}

/* m^2, in the plane m: the face that a wall can press on, as wide as the bodies are */
static double pressed_area(const struct packing *p, vec3 axis)
{
    vec3 side[2];
    double area = 1, range[2];
    time_step_across(p->dim, axis, side);
    for (int a = 0; a < p->dim - 1; a++) {
        time_step_extent(p, side[a], range);
        area *= range[1] - range[0];
    }
    return area;
}

/* Pa, in the plane N/m */
static double pressure_of(const struct packing *p)
{
    double most = 0;
    if (cell_yields(&p->cell))
        for (int k = 0; k < 9; k++) most = dmax(most, fabs(p->cell.stress[k / 3][k % 3]));
    most = dmax(most, fabs(p->cell.mean));
    if (p->cell.factors) most *= cell_factor_most(&p->cell);
    for (int32_t k = 0; k < p->walls && p->n; k++) {
        const struct wall *w = &p->wall[k];
        if (w->load.way == LOAD_GLIDES || (servo_box_has(w) && w->load.spread))
            most = dmax(most, load_most(p, w) / pressed_area(p, w->load.axis));
    }
    return most;
}

/* The same of the walls of a room, the farthest from its centre of which is fastest */
static void of_room(struct time_step *t, const struct packing *p)
{
    double torque = 0, farthest = 0, mass = servo_box_mass(p);
    if (!(mass > 0) || !p->n) return;
    for (int32_t k = 0; k < p->walls; k++) {
        const struct wall *w = &p->wall[k];
        if (!servo_box_has(w)) continue;
        double lever = fabs(wall_lever(p, w, p->t));
        torque += lever * load_most(p, w), farthest = dmax(farthest, lever);
    }
    for (int32_t k = 0; k < p->walls; k++) {
        const struct wall *w = &p->wall[k];
        if (!servo_box_has(w)) continue;
        double h = fall_of_bodies(p, v3_scale(w->load.force > 0 ? -1 : 1, w->load.axis));
        t->x[LIMIT_STROKE] = dmax(t->x[LIMIT_STROKE], sqrt(2 * h * farthest * torque / mass));
    }
    t->x[LIMIT_LOAD] = dmax(t->x[LIMIT_LOAD], farthest * torque / mass);
}

/* What loads do: m/s^2, of a wall or an edge; of one that turns, of the body that is farthest from the
   axis. And the m/s that a wall then has which glides. */
static void of_loads(struct time_step *t, const struct packing *p)
{
    of_room(t, p);
    for (int32_t k = 0; k < p->walls && p->n; k++) {
        const struct wall *w = &p->wall[k];
        double force = load_most(p, w), arm = 1, h;
        if (!w->load.way || servo_box_has(w)) continue;
        for (int64_t i = 0; i < p->n && w->load.way == LOAD_TURNS; i++)
            arm =
                dmax(i ? arm : 0, v3_norm(v3_cross(w->load.axis, v3_sub(p->x[i], w->load.point))));
        t->x[LIMIT_LOAD] = dmax(t->x[LIMIT_LOAD], arm * force / w->load.mass);
        if (w->load.way != LOAD_GLIDES) continue;
        h = fall_of_bodies(p, v3_scale(w->load.force > 0 ? -1 : 1, w->load.axis));
        t->x[LIMIT_STROKE] = dmax(t->x[LIMIT_STROKE], sqrt(2 * h * force / w->load.mass));
    }
    double height[3], size = 1;
    cell_heights(&p->cell, height);
    for (int k = 0; k < p->dim; k++) size *= height[k];
    for (int k = 0; k < 9; k++) {
        double mass = p->cell.mass[k % 3][k / 3]; // component k / 3 of edge k % 3
        if (!(mass > 0)) continue;
        double force = fabs(p->cell.stress[k / 3][k % 3]) * size / height[k % 3];
        if (p->cell.factors) force *= cell_factor_most(&p->cell);
        t->x[LIMIT_LOAD] = dmax(t->x[LIMIT_LOAD], force / mass);
    }
    double growth = p->dim * size * fabs(p->cell.mean) * cell_factor_most(&p->cell);
    for (int k = 0; k < p->dim && p->cell.size_mass > 0; k++)
        t->x[LIMIT_LOAD] =
            dmax(t->x[LIMIT_LOAD], growth / p->cell.size_mass * v3_norm(p->cell.edge[k]));
}

static void of_walls(struct time_step *t, const struct packing *p)
{
    for (int32_t k = 0; k < p->walls; k++)
        t->x[LIMIT_WALL] = dmax(t->x[LIMIT_WALL], wall_top_speed(p, &p->wall[k]));
    for (int32_t k = 0; k < p->drives.n; k++) {
        const struct drive *d = &p->drives.drive[k];
        if (d->turns) t->x[LIMIT_TURN] = dmax(t->x[LIMIT_TURN], drive_top_speed(&p->drives, d));
        if (d->signal == DRIVE_SINE)
            t->x[LIMIT_PERIOD] = dmax(t->x[LIMIT_PERIOD], fabs(d->frequency));
    }
    for (int32_t k = 0; k < p->pushes.n; k++)
        if (p->pushes.drive[k].signal == DRIVE_SINE)
            t->x[LIMIT_PERIOD] = dmax(t->x[LIMIT_PERIOD], fabs(p->pushes.drive[k].frequency));
}

double time_step_wall_mass(const struct packing *p, const struct wall *w)
{
    double mass = 0, face = 0;
    for (int64_t i = 0; i < p->n; i++)
        if (p->mass[i] > 0)
            mass += p->mass[i], face += time_step_power(2 * p->radius[i], p->dim - 1);
    return face > 0 ? mass / face * pressed_area(p, w->load.axis) : 0;
}

double time_step_edge_mass(const struct packing *p)
{
    double mass = 0;
    for (int64_t i = 0; i < p->n; i++) mass += p->mass[i];
    return 3 / (4 * M_PI * M_PI) * mass;
}

/* ---- the step ---- */

static double limit_dt(const struct time_step_limit *l, double r, double x)
{
    if (!(x > 0)) return INFINITY;
    switch (l->way) {
    case BY_ACCELERATION:
        return sqrt(l->share * r / x);
    case BY_SPEED:
        return l->share * r / x;
    default:
        return l->share / x;
    }
}

static double rounded(double dt)
{
    char text[40];
    if (!isfinite(dt)) return dt;
    number_write(text, sizeof text, 15, 'e', dt); // d.ddddddddddddddde-NN
    char *rest = strchr(text, 'e');
    memmove(text + 3, rest, strlen(rest) + 1);
    return number_read(text, NULL);
}

/* The largest of 1, 2, 5, 10, ... that is at most dt, but for rounding */
static double time_step_round(double dt)
{
    char text[40];
    if (!isfinite(dt)) return dt;
    number_write(text, sizeof text, 15, 'e', dt * (1 + 1e-9)); // d.ddde-NN
    *text = *text < '2' ? '1' : *text < '5' ? '2' : '5';
    memmove(text + 1, strchr(text, 'e'), strlen(strchr(text, 'e')) + 1);
    return number_read(text, NULL);
}

void time_step_of(struct time_step *t, const struct scene *s, const struct packing *p)
{
    *t = (struct time_step){ .radius = smallest(s, p), .by = -1, .best = INFINITY };
    t->x[LIMIT_GRAVITY] = v3_norm(p->g);
    t->pressure = pressure_of(p);
    t->x[LIMIT_PRESSURE] = t->pressure * lightest(p);
    of_loads(t, p);
    t->x[LIMIT_STRAIN] = time_step_strain_of(&p->cell);
    t->x[LIMIT_SPEED] = start_speed(s, p);
    t->x[LIMIT_FALL] = fall_speed(s, p, t->x[LIMIT_SPEED]);
    of_walls(t, p);
    for (int k = 0; k < LIMITS; k++) {
        t->dt[k] =
            isfinite(t->radius) ? limit_dt(&time_step_limit[k], t->radius, t->x[k]) : INFINITY;
        if (t->dt[k] < t->best) t->best = t->dt[k], t->by = k;
    }
    t->best = rounded(t->best), t->interval = INFINITY;
    for (int k = 0; k <= LIMIT_STRAIN; k++) t->interval = dmin(t->interval, t->dt[k]);
    t->interval = time_step_round(isfinite(t->interval) ? t->interval : t->best);
}
