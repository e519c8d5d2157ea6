/*
 * state/freedom.h: degrees of freedom beyond those of the grains: a wall that a load pushes
 * along an axis or turns about one, the size of a room between walls that yields to a mean pressure,
 * an edge of the cell that yields to a stress.
 *
 * Each is one number, a speed s, with a mass m (kg; kg m^2 where it turns) and a force f (N; N m):
 * m ds/dt = f + what the contacts push. It enters the velocity of a contact, u_c += J_c s, and so
 * the contact problem like any other unknown: W = H^T M^-1 H has its rows as well. Over a step
 *
 *     s+ = s + (dt f + J^T r)/m.
 *
 * They are gathered again for each step, from the loads of the packing [shape/drive.h] and the
 * masses and the stress of its cell [shape/cell.h]: on component i of edge k acts - (stress
 * A_k)_i, where A_k, the face that the other two edges span, has its normal to the side of the
 * edge.
 *
 * All bodies follow the flow of an edge: when component i of edge k gains ds, a body at x gains
 * y_k ds along i, where y_k counts edges from the cell's origin to x. A contact then feels the edge
 * by its branch, the vector d from the centre of a to that of the image of b,
 *
 *     J_c = (d . inverse_k) i,   sum of J_c^T r_c = (sum of r_c (x) d_c) inverse_k,
 *
 * which is the contacts' stress times the face: neither the place of the border nor that of the
 * origin matters, and the bodies' momentum relative to the flow is kept [Parrinello & Rahman 1981].
 * A body of mass 0 does not follow; where one takes part, J_c counts the other body from the origin.
 *
 * The size of a room between walls is one freedom as well [state/servo_box.h]: its contacts feel J_c = - lever n.
 *
 * The size of a cell that yields to a mean stress P is one freedom: all edges grow at the rate s, so that
 * J_c = d, sum of J_c^T r_c = sum of r_c . d_c, which is dim V times the contacts' mean stress, and the force
 * is - dim V P.
 */
#pragma once

#include "base/vec.h"
#include "state/contact.h"
#include "state/packing.h"

/* In place of a wall */
enum { FREEDOM_EDGE = -1, FREEDOM_SIZE = -2, FREEDOM_ROOM = -3 };

struct freedom {
    int32_t
        wall; /* the wall that it moves; -1: the cell's edge; -2: its size; -3: the room of walls */
    int edge; /* of the cell; it yields along an axis of space */
    vec3 inverse;        /* 1/m: counts edges, inverse . d, where the contacts act */
    vec3 gain[3];        /* of the cell's rates, a unit of speed; of a wall 0 */
    bool turns;          /* about the axis, not along it */
    vec3 axis, point;    /* unit vector; m: a point on the axis, of the predicted position */
    double mass;         /* kg, or kg m^2 */
    double force;        /* N, or N m, of this step */
    double speed;        /* m/s, or rad/s; of a size 1/s */
    const double *lever; /* [walls] m: of a room, where the contacts act; else NULL */
};

struct freedoms {
    int32_t n;
    struct freedom *f; /* [n] walls first, in their order, then the room, then edges, or the size */
    double *lever;     /* [walls] of a room that may not yield; NULL: there is none */
};

/* Whether the packing has any, or a room that moves by rates alone. */
bool freedoms_in(const struct packing *p);
/* Those of a step, the one that begins where the packing is or, ended, that ends there; speeds are those that
   the packing has. half: the edges of the cell where the contacts act, m. Returns 0, or EX_SOFTWARE with
   nothing to free. */
int freedoms_init(struct freedoms *list, const struct packing *p, const vec3 half[3], bool ended,
                  struct failure *failure);
void freedoms_free(struct freedoms *list);

/* m/s: the largest that what loads move along an axis has at the end of a step by them alone */
double freedoms_speed(const struct packing *p);
/* m/s: no contact at rest approaches faster, whatever gravity and loads did to both bodies in a step. */
double freedoms_calm(const struct packing *p);

/* Do contacts of many bodies feel it, so that it is a column of W [solve/delassus.h]? Of an edge of the cell, and
   of a size. */
static inline bool freedom_common(const struct freedom *f)
{
    return f->wall < 0;
}

/* Do all bodies follow it? Of the cell. */
static inline bool freedom_of_cell(const struct freedom *f)
{
    return f->wall == -1 || f->wall == -2;
}

/* m/s: gain[3] of the cell's edges += what a change of its speed makes of their rates */
static inline void freedom_gain(const struct freedom *f, double change, vec3 gain[3])
{
    for (int k = 0; k < 3; k++)
        if (f->gain[k].x != 0 || f->gain[k].y != 0 || f->gain[k].z != 0)
            gain[k] = v3_axpy(gain[k], change, f->gain[k]);
}

/* Of the packing's contact c, whose bodies are `ahead` (s) from where it acts, the cell's edges (m) there:
   the velocity of b relative to a per unit speed: -axis for a wall that glides, -axis x (x_c - point)
   for one that turns, -lever axis for a room, (inverse . d) axis for an edge; 0 for others. */
vec3 freedom_direction(const struct freedom *f, const struct packing *p, const struct contact *c,
                       double ahead, const vec3 edge[3]);

/*
 * The speed changes where the contacts act, at the predicted position. A wall also makes its
 * way along or about the axis, dt s + theta dt change, while an edge gets theta dt change alone:
 * the rest, dt rate, is the motion of the cell. back: the inverse.
 */
void freedom_move(const struct freedom *f, struct packing *p, double change, bool back);
/* The step of a room's walls, if there is a room and no freedom of it, by its rates alone; back: the inverse. */
void freedoms_move_rates(const struct freedoms *list, struct packing *p, bool back);
/* What they move is displaced by way[n] (m; of a room in levers) along their axes, without a velocity: walls, edges, and the
   bodies that follow these. */
void freedoms_displace(const struct freedoms *list, struct packing *p, const double *way);
