/* state/wall_motion.c: where walls are, and how they move [state/packing.h]. */
#include "state/packing.h"

double wall_lever(const struct packing *p, const struct wall *w, double t)
{
    const struct load *l = &w->load;
    vec3 x = v3_axpy(w->x, t, w->v); // a room's wall does not turn
    if (w->drives) x = v3_add(x, drives_pose(&p->drives, w->first_drive, w->drives, t).shift);
    double lever = v3_dot(v3_sub(x, l->point), l->axis) + l->travel;
    return lever / (1 - (t - p->t) * (l->speed + l->rate));
}

/* Does the load move it along the axis? */
static bool glides(const struct load *l)
{
    return l->way == LOAD_GLIDES || l->way == LOAD_ROOM;
}

/* m, rad: how far the load has brought it along or about the axis by time t (s) */
static double load_travel(const struct packing *p, const struct wall *w, double t)
{
    const struct load *l = &w->load;
    double way = (t - p->t) * l->speed;
    if (l->way == LOAD_ROOM) way = (t - p->t) * (l->speed + l->rate) * wall_lever(p, w, t);
    return l->travel + way;
}

struct pose wall_pose(const struct packing *p, const struct wall *w, double t)
{
    const struct load *l = &w->load;
    struct pose all = drives_pose(&p->drives, w->first_drive, w->drives, t);
    all.shift = v3_axpy(all.shift, t, w->v);
    double travel = load_travel(p, w, t);
    if (glides(l)) all.shift = v3_axpy(all.shift, travel, l->axis);
    if (l->way != LOAD_TURNS) return all;
    quat q = quat_rotation(v3_scale(travel, l->axis));
    all.shift = v3_add(l->point, quat_turn(q, v3_sub(all.shift, l->point)));
    all.q = quat_unit(quat_mul(q, all.q));
    return all;
}

/* Planes that only glide, which most walls are: no rotation, whose rounding would show */
static bool only_glides(const struct wall *w)
{
    return !w->drives && (w->load.way != LOAD_TURNS || w->shape == WALL_PLANE);
}

vec3 wall_at(const struct packing *p, const struct wall *w, double t)
{
    if (!only_glides(w)) {
        struct pose pose = wall_pose(p, w, t);
        return pose_of(&pose, w->x);
    }
    vec3 x = v3_axpy(w->x, t, w->v);
    if (!glides(&w->load)) return x;
    return v3_axpy(x, load_travel(p, w, t), w->load.axis);
}

vec3 wall_normal(const struct packing *p, const struct wall *w, double t)
{
    return only_glides(w) ? w->n : quat_turn(wall_pose(p, w, t).q, w->n);
}

static struct drive_step step_of(const struct packing *p)
{
    return (struct drive_step){ p->t, packing_next_time(p), p->dt };
}

/* m/s: the velocity along the axis of a room's wall at this rate (1/s), of its growth or its strain, where the
   contacts act */
static vec3 room_velocity(const struct packing *p, const struct wall *w, double rate)
{
    return v3_scale(rate * wall_lever(p, w, p->t + step_ahead(p)), w->load.axis);
}

vec3 wall_held(const struct packing *p, const struct wall *w, vec3 x)
{
    const struct load *l = &w->load;
    if (l->way == LOAD_ROOM && l->rate != 0) {
        vec3 v = w->v;
        if (w->drives)
            v = v3_add(v, drives_velocity(&p->drives, w->first_drive, w->drives, step_of(p), x));
        return v3_add(v, room_velocity(p, w, l->rate));
    }
    if (!w->drives) return w->v;
    vec3 y = v3_axpy(x, -(p->t + p->dt / 2), w->v);
    // drives move the wall first, and what they made the load moves
    double travel = l->travel + p->dt / 2 * l->speed;
    quat q = { 1, 0, 0, 0 };
    if (l->way == LOAD_GLIDES) y = v3_axpy(y, -travel, l->axis);
    if (l->way == LOAD_TURNS) {
        q = quat_rotation(v3_scale(travel, l->axis));
        y = v3_add(l->point, quat_turn_back(q, v3_sub(y, l->point)));
    }
    vec3 v = drives_velocity(&p->drives, w->first_drive, w->drives, step_of(p), y);
    return v3_add(w->v, l->way == LOAD_TURNS ? quat_turn(q, v) : v);
}

vec3 wall_velocity(const struct packing *p, const struct wall *w, vec3 x)
{
    const struct load *l = &w->load;
    vec3 v = wall_held(p, w, x);
    if (l->way == LOAD_GLIDES) return v3_axpy(v, l->speed, l->axis);
    if (l->way == LOAD_ROOM) return v3_add(v, room_velocity(p, w, l->speed));
    if (l->way != LOAD_TURNS) return v;
    return v3_axpy(v, l->speed, v3_cross(l->axis, v3_sub(x, l->point)));
}

vec3 wall_belt(const struct packing *p, const struct wall *w, vec3 n)
{
    if (w->belt.x == 0 && w->belt.y == 0 && w->belt.z == 0) return w->belt;
    const vec3 b = quat_turn(wall_pose(p, w, p->t + p->dt / 2).q, w->belt);
    return v3_axpy(b, -v3_dot(b, n), n);
}

vec3 wall_spin(const struct packing *p, const struct wall *w)
{
    vec3 s = drives_spin(&p->drives, w->first_drive, w->drives, step_of(p));
    return w->load.way == LOAD_TURNS ? v3_axpy(s, w->load.speed, w->load.axis) : s;
}

/* Of numbers that are to be at right angles to each other */
#define UPRIGHT 1e-9

/* m: from plane to plane along d, unless the cell repeats along it; 0: there are not two that face each other */
static double width_along(const struct packing *p, vec3 d, double t)
{
    double lo = -INFINITY, hi = INFINITY;
    for (int k = 0; k < 3; k++) {
        const vec3 e = p->cell.edge[k];
        if (p->cell.repeats[k] && v3_norm(v3_cross(e, d)) <= UPRIGHT * v3_norm(e))
            return v3_norm(e);
    }
    for (int32_t i = 0; i < p->walls; i++) {
        const struct wall *w = &p->wall[i];
        if (w->shape != WALL_PLANE || !wall_there(w, t)) continue;
        double along = v3_dot(wall_normal(p, w, t), d), at = v3_dot(wall_at(p, w, t), d);
        if (along > 1 - UPRIGHT) lo = fmax(lo, at);
        if (along < -1 + UPRIGHT) hi = fmin(hi, at);
    }
    return isfinite(lo) && isfinite(hi) && hi > lo ? hi - lo : 0;
}

/* A direction along which the face ends: the normal of a plane, or an edge of the cell, upright to n; false: none */
static bool direction_across(const struct packing *p, vec3 n, double t, vec3 *d)
{
    for (int k = 0; k < 3; k++) {
        const vec3 e = p->cell.edge[k];
        *d = v3_scale(1 / v3_norm(e), e);
        if (p->cell.repeats[k] && fabs(v3_dot(*d, n)) <= UPRIGHT) return true;
    }
    for (int32_t i = 0; i < p->walls; i++) {
        if (p->wall[i].shape != WALL_PLANE) continue;
        *d = wall_normal(p, &p->wall[i], t);
        if (fabs(v3_dot(*d, n)) <= UPRIGHT) return true;
    }
    return false;
}

double wall_face(const struct packing *p, const struct wall *w, double t)
{
    vec3 n = wall_normal(p, w, t), d;
    if (!direction_across(p, n, t, &d)) return 0;
    double face = width_along(p, d, t);
    return p->dim == 2 ? face : face * width_along(p, v3_cross(n, d), t);
}

double wall_force(const struct packing *p, const struct wall *w, double t)
{
    double force = w->load.force;
    for (int32_t k = w->first_push; k < w->first_push + w->pushes; k++)
        force += drive_way(&p->pushes, &p->pushes.drive[k], t);
    if (w->load.spread) force *= wall_face(p, w, t);
    if (p->outside.push) force += p->outside.push[w - p->wall];
    return force;
}

/* m: of its points that bodies may touch from a place */
static double wall_motion_farthest(const struct packing *p, const struct wall *w, vec3 from)
{
    double reach = wall_reach(w), most2 = 0;
    if (isfinite(reach)) return v3_norm(v3_sub(w->x, from)) + reach;
    for (int64_t i = 0; i < p->n; i++) {
        const vec3 d = v3_sub(p->x[i], from);
        most2 = dmax(most2, v3_dot(d, d));
    }
    return sqrt(most2);
}

/* m/s, rad/s: of a drive, from time t (s) on, until its way ends or the next row of its table comes */
static double drive_speed_at(const struct drives *d, const struct drive *k, double t)
{
    t += k->clock;
    if (t < k->from || t >= k->until) return 0;
    if (k->signal != DRIVE_TABLE) return drive_top_speed(d, k);
    const struct drive_row *r = &d->row[k->first];
    for (int32_t i = 1; i < k->rows; i++)
        if (t >= r[i - 1].t && t < r[i].t)
            return fabs((r[i].s - r[i - 1].s) / (r[i].t - r[i - 1].t));
    return 0;
}

/* m/s: of all drives of a wall, from time t on until one of them changes */
static double drives_speed_at(const struct packing *p, const struct wall *w, const double *arm,
                              double t)
{
    double sum = 0;
    for (int32_t i = 0; i < w->drives; i++)
        sum += arm[i] * drive_speed_at(&p->drives, &p->drives.drive[w->first_drive + i], t);
    return sum;
}

enum { AT_ONCE_MOST = 64 }; /* drives, and rows of their tables, of which each time is looked at */

/* m/s: the largest sum of the speeds of drives that act at the same time. Speeds change where a drive begins or a row
   of its table lies. Of many: the sum of all */
static double drives_top_speed(const struct packing *p, const struct wall *w)
{
    const struct drives *d = &p->drives;
    double all = 0, most = 0, arm[AT_ONCE_MOST];
    int64_t changes = 0;
    for (int32_t i = 0; i < w->drives; i++) {
        const struct drive *k = &d->drive[w->first_drive + i];
        double reach = k->turns ? wall_motion_farthest(p, w, k->point) : 1;
        if (i < AT_ONCE_MOST) arm[i] = reach;
        all += drive_top_speed(d, k) * reach, changes += 1 + k->rows;
    }
    if (w->drives < 2 || changes > AT_ONCE_MOST) return all;
    for (int32_t i = 0; i < w->drives; i++) {
        const struct drive *k = &d->drive[w->first_drive + i];
        double first = isfinite(k->from) ? k->from : -1e300;
        most = dmax(most, drives_speed_at(p, w, arm, first - k->clock));
        for (int32_t r = 0; r < k->rows; r++)
            most = dmax(most, drives_speed_at(p, w, arm, d->row[k->first + r].t - k->clock));
    }
    return most;
}

double wall_top_speed(const struct packing *p, const struct wall *w)
{
    double most = v3_norm(w->v);
    if (w->load.way == LOAD_ROOM)
        most += fabs((w->load.speed + w->load.rate) * wall_lever(p, w, p->t));
    else
        most += fabs(w->load.speed) *
                (w->load.way == LOAD_TURNS ? wall_motion_farthest(p, w, w->load.point) : 1);
    return most + drives_top_speed(p, w);
}
