/* state/offset.c: gaps as velocities [state/offset.h]. */
#include "state/offset.h"

#include "state/freedom.h"
#include "state/kinematics.h"

/* Of the body's radius: what a wall bends away in a step, at most; there dt is too large for it. */
#define BEND_MOST 0.5

/* Whether it is a ball at a wall that may be concave, and overlap is not left to grow or to a velocity */
static bool may_bend(const struct packing *p, const struct contact *c)
{
    if (c->a >= 0 || !overlap_sees_gaps(p->overlap) || overlap_pushes(p->overlap)) return false;
    int32_t shape = p->wall[-1 - c->a].shape;
    bool round = shape == WALL_CYLINDER || shape == WALL_CONE || shape == WALL_SPHERE;
    return round && !packing_shape(p, c->b);
}

/*
 * m, at least 0: how much smaller the gap of a ball is a step on, with the velocities that it and the wall
 * have, than their opening says: on a concave wall v_t^2 dt^2/2 over the difference of the radii. With
 * u_n dt = this the ball goes along a chord from where the contact acts to where the next one does, and
 * keeps its speed; with u_n = 0 each step takes from it the part along the next normal.
 */
static double bend_of(const struct packing *p, const struct contact *c)
{
    const struct wall *w = &p->wall[-1 - c->a];
    const double r = p->radius[c->b], ahead = step_ahead(p);
    const struct pose pose = wall_pose(p, w, p->t + ahead + p->dt);
    // from the contact's own place: a step that is judged later begins where bodies were moved apart
    vec3 x = v3_axpy(v3_axpy(c->x, c->gap + r, c->n), p->dt, p->v[c->b]);
    vec3 at = v3_sub(quat_turn_back(pose.q, v3_sub(x, pose.shift)), w->x);
    struct touch t;
    if (!wall_nearest(w, p->dim, at, r, &t)) return 0;
    double bend = c->gap + p->dt * opening_of(p, c, ahead) - (t.distance - r);
    return fmin(fmax(0, bend), BEND_MOST * r);
}

bool offset_in(const struct packing *pack, const struct contact *c)
{
    if (packing_springs(pack, c)) return false; // its springs see the gap
    return (overlap_sees_gaps(pack->overlap) && (c->gap > 0 || overlap_pushes(pack->overlap))) ||
           may_bend(pack, c);
}

/*
 * Signorini's condition on the gap at the next predicted position, g + dt u_n - bend. Not of an impact
 * that rebounds: its velocities are Newton's, wherever in the step it falls. Newton's law is one of
 * u_n - bend/dt, so that a ball that goes round neither bounces nor gains.
 */
double offset_of(const struct packing *pack, const struct contact *c, double un)
{
    if (!offset_in(pack, c)) return 0;
    double bend = may_bend(pack, c) ? bend_of(pack, c) / pack->dt : 0;
    bool gap = c->gap > 0 || overlap_pushes(pack->overlap);
    bool impact = c->en > 0 && -(un + bend) > freedoms_calm(pack);
    return (gap && !impact ? c->gap / pack->dt : 0) - (1 - c->en) * bend;
}
