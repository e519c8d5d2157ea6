/*
 * shape/drive.h: motions that are prescribed, each a signal in time along or about an axis.
 *
 * The way s(t) is closed in t, so that a wall is where its time says, however it came there.
 * Over a step the velocity is the mean, (s(then) - s(t))/dt: bodies at rest on a wall then
 * stay on it, whatever its acceleration.
 *
 * The same signals say what the force of a load is in time [shape/drive.h]; then the way is a force, N
 * along the axis or N m about it.
 */
#pragma once

#include "base/failure.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * What a wall yields to that is free along or about one axis: a force, as a
 * piston at constant pressure, or a torque.
 *
 * How it moves besides is prescribed: the load's speed adds to the wall's own velocity.
 *
 * The walls of a room [state/servo_box.h] have one load together: the size of the room.
 */

/* A plane turns about its normal, in which it stays the plane that it is. */
enum load_way { LOAD_NONE, LOAD_GLIDES, LOAD_TURNS, LOAD_ROOM, LOAD_WAYS };

struct load {
    int32_t way; /* enum load_way */
    vec3 axis;   /* unit vector */
    vec3 point;  /* m: a point on the axis, of one that turns; of a room its centre */
    double
        mass; /* kg that move along the axis; kg m^2 about it; kg m^2: its part of a room's, of all of
                     which 0 stands for a room that does not yield */
    double force; /* N along the axis, N m about it; its weight is in it. Pushes add to it. */
    int32_t
        spread; /* 1: force and pushes are pressures, Pa, in the plane N/m, on the face that the walls
                       beside it leave [wall_face()] */
    double speed; /* m/s, rad/s; of a room 1/s: the growth of its size, of all its walls the same */
    double rate;  /* 1/s: strain rate that is prescribed along the axis, of a room's wall; else 0 */
    double travel; /* m, rad: how far it has come */
};

/* Does a room change by a tenth of its size in a step of dt (s)? Its walls would go through grains. */
static inline bool load_grows_too_fast(const struct load *l, double dt)
{
    double part = (l->speed + l->rate) * dt;
    return !(part < 0.1 && part > -0.1);
}

/* DRIVE_SPEED: s = value t, from `from` on. DRIVE_SINE: s = value sin(2 pi frequency t + phase).
   DRIVE_TABLE: s linear between the rows of a table, constant before and after. */
enum drive_signal { DRIVE_SPEED, DRIVE_SINE, DRIVE_TABLE, DRIVE_SIGNALS };

struct drive {
    int32_t wall;        /* that it moves, or pushes */
    int32_t turns;       /* 1: about the axis, 0: along it */
    int32_t signal;      /* enum drive_signal */
    vec3 axis, point;    /* unit vector; m: a point on the axis, of one that turns */
    double value;        /* m/s, rad/s of a speed; m, rad of a sine */
    double frequency;    /* Hz */
    double phase;        /* rad */
    double from, until;  /* s: the way is made between them; perhaps infinite */
    double clock;        /* s: added to the packing's time, in which all others are said */
    int32_t first, rows; /* of a table */
};

/* A row of a table: time (s) and way (m or rad) */
struct drive_row {
    double t, s;
};

struct drives {
    int32_t n, rows;
    struct drive *drive;   /* [n] those of a wall follow one another, in the order they act */
    struct drive_row *row; /* [rows] */
};

/* Room for so many, all zero, in place of the old ones. Returns 0 or EX_SOFTWARE. */
int drives_alloc(struct drives *d, int32_t n, int32_t rows, struct failure *failure);
void drives_free(struct drives *d);
/* to = a copy; EX_SOFTWARE with nothing to free */
int drives_copy(struct drives *to, const struct drives *from, struct failure *failure);
enum { DRIVES_MOST = 1000 }; /* of one wall: each place of it asks them all */
/* Are all of them drives, in a packing of so many walls? what: they are called in messages. Returns 0 or
   EX_DATAERR. */
int drives_check(const struct drives *d, int32_t walls, int dim, const char *what,
                 struct failure *failure);

/* m, rad: the way at the packing's time t (s) */
double drive_way(const struct drives *d, const struct drive *k, double t);
/* m/s, rad/s: no step's mean is faster */
double drive_top_speed(const struct drives *d, const struct drive *k);

/* A rigid motion: a point that is at x goes to q x + shift. */
struct pose {
    quat q;
    vec3 shift; /* m */
};
static inline vec3 pose_of(const struct pose *p, vec3 x)
{
    return v3_add(quat_turn(p->q, x), p->shift);
}

/* What drives first .. first+n-1 have made of a wall at time t (s), one after the other */
struct pose drives_pose(const struct drives *d, int32_t first, int32_t n, double t);
/* A time step from t to `then`, which is t + dt but for its rounding [packing_time()] */
struct drive_step {
    double t, then, dt; /* s */
};
/* m/s: the mean velocity in the step of the material that is at x (m) midway: dt times it is the way
   from where drives_pose() is at t to where it is then. */
vec3 drives_velocity(const struct drives *d, int32_t first, int32_t n, struct drive_step step,
                     vec3 x);
/* rad/s: its mean angular velocity */
vec3 drives_spin(const struct drives *d, int32_t first, int32_t n, struct drive_step step);
