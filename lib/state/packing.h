/*
 * state/packing.h: bodies, walls and materials, and the parameters of the motion. The bodies are
 * arrays because documents store them so, a dataset each.
 *
 * In the plane (dim 2) the bodies are discs in z = 0 that turn about z.
 */
#pragma once

#include "base/failure.h"
#include "base/vec.h"
#include "shape/cell.h"
#include "shape/drive.h"
#include "shape/mesh.h"
#include "shape/shape.h"
#include "shape/wall_shape.h"
#include "state/body_columns.h"
#include "state/bond.h"
#include "state/contact.h"
#include "state/external_force.h"
#include "state/memory.h"
#include "state/names.h"
#include "state/pair_columns.h"
#include "state/pair_law.h"
#include "state/wall_load.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * What a step does about overlaps, besides keeping bodies from approaching.
 *
 *     keep         nothing: u_n >= 0, as the paper
 *     gap          u_n + max(0, g)/dt >= 0: bodies that are apart may close the gap g, not more
 *                  [Jean 1999, the quasi-shock law of LMGC90]
 *     push         u_n + g/dt >= 0: an overlap is left with a velocity
 *     project      bodies are moved apart after the step, without a velocity [step/project.h]; the
 *                  law sees the gaps of those that are near, as with gap
 *     gap-project  gap and project
 *
 * Near is a pair whose gap is at most OVERLAP_NEAR of the smaller radius, and what loads may close of
 * it in a step. What a projection opens is near: else the next step would not know the contact, and what
 * it has carried would go into an overlap. gap, push and gap-project also see pairs that are farther
 * apart and approach.
 */

enum overlap {
    OVERLAP_UNSAID, /* by a document: keep */
    OVERLAP_KEEP,
    OVERLAP_GAP,
    OVERLAP_PUSH,
    OVERLAP_PROJECT,
    OVERLAP_GAP_PROJECT,
    OVERLAP_COUNT
};

/* As options and documents have them; that of OVERLAP_UNSAID is "" */
extern const char *const overlap_name[OVERLAP_COUNT];

/* Radii of the smaller: half of what a contact is moved apart in a step, where it overlaps by little. A
   random packing has some 3 % more contacts so; with 1e-4 cells under a pressure still collapse that
   moves a grain by 0.4 % of its radius in a step. */
#define OVERLAP_NEAR 1e-3

/* Whether the law sees gaps, also those of pairs that are not near and approach; overlaps too; and
   whether bodies are moved apart */
static inline bool overlap_sees_gaps(enum overlap o)
{
    return o > OVERLAP_KEEP;
}
static inline bool overlap_meets(enum overlap o)
{
    return overlap_sees_gaps(o) && o != OVERLAP_PROJECT;
}
static inline bool overlap_pushes(enum overlap o)
{
    return o == OVERLAP_PUSH;
}
static inline bool overlap_projects(enum overlap o)
{
    return o == OVERLAP_PROJECT || o == OVERLAP_GAP_PROJECT;
}

/*
 * The account of inlets and outlets: how many each pour has brought and each
 * removal has taken, and the events since the last frame. What pours and removes is
 * scene/inlet.h.
 */

/* What one pour has brought, or one removal has taken, so far */
struct flow_count {
    int64_t bodies;
    double mass; /* kg */
};

/* A body that has come or gone */
struct event {
    int64_t step; /* the step at whose beginning it happened */
    double t;     /* s: the time of that beginning */
    int32_t id;
    int8_t came;   /* 1: poured; 0: removed */
    int32_t which; /* the pour, or the removal: its place in the scene, from 0 */
    double radius; /* m */
    double mass;   /* kg */
    vec3 x, v;     /* m, m/s: then */
};

struct events {
    int64_t n, room;
    struct event *e; /* [n] in order of time */
};

/* Returns 0 or EX_SOFTWARE. */
int events_add(struct events *events, const struct event *event, struct failure *failure);

struct whole;
struct breakage;
struct broken;

struct packing {
    int dim;      /* 2 or 3 */
    int64_t n;    /* bodies */
    int64_t step; /* steps made since the packing was built */
    double t, dt; /* s; t = t0 + (step - step0) dt, which no step adds up: packing_time() */
    double t0;    /* s: the time at step0, from which the time is counted with this dt */
    int64_t step0;
    double theta; /* of the theta-method; 1/2 is the paper's midpoint */
    vec3 g;       /* m/s^2 */
    uint64_t seed;
    enum overlap overlap;

    EACH_BODY_COLUMN(
        BODY_POINTER) /* radius, mass, inertia, id, material, shape, x, v, w, q, image: [n] */

    struct shapes shapes; /* of bodies; radius is that of the ball around them */

    int32_t walls;
    struct wall *wall;     /* [walls] */
    struct drives drives;  /* of them */
    struct drives pushes;  /* of their loads: signals that are forces, N or N m */
    struct drives pulls;   /* forces and torques on bodies [state/external_force.h] */
    double pulls_most;     /* m/s^2: no body gains more by them */
    struct mesh mesh;      /* of those that are meshes */
    struct names names;    /* of walls, of parts of them and of groups of bodies */
    struct wall_sums sums; /* over steps, of what bodies do to them */
    struct cell cell;

    int32_t materials;
    char **material_name; /* [materials] */
    EVERY_PAIR_COLUMN(
        PAIR_POINTER) /* mu, en, et, mu_s, v_s, inert: [materials * materials], symmetric */
    struct pair_law
        *law; /* [materials * materials], symmetric: what is beyond these; NULL: nothing */
    struct bonds bonds; /* what lasts of pairs by these laws */

    struct memory memory;          /* the reactions that the next step starts from */
    struct external_force outside; /* what acts from outside in the step to come */

    /* Inlets and outlets act [scene/inlet.h] where there are pours or removals. */
    int32_t pours, removals;
    struct flow_count *poured, *removed; /* [pours], [removals] */
    int32_t first_id;                    /* of the first body that is poured */
    struct events events;                /* since the last frame */

    struct breakage *breakage; /* [materials]; NULL: nothing breaks [state/breakage.h] */
    struct broken *broken;     /* [materials], where there is breakage */

    char *scene; /* the JSON it was built from, or NULL */

    const struct whole
        *whole; /* borrowed: that of which these bodies are a part; NULL: they are all */
};

/* What a part of a packing knows of all bodies */
struct whole {
    double speed, rotation_speed; /* m/s: of the fastest centre, and of the fastest point */
    double small, large;          /* m: the smallest and the largest radius */
    double apart; /* m: the widest gap at which contacts are to be sought for the bonds that hold
                                and keep no place; -INFINITY where there are none */
};
/* Of the bodies of this packing */
struct whole packing_whole(const struct packing *p);
/* kg: of the bodies that move; 1 where none does */
double packing_mean_mass(const struct packing *p);

/* n bodies (orientation 1, id = index), no wall and one material "0"; theta = 1/2; all else is zero,
   dt too. Returns 0 or EX_SOFTWARE. */
int packing_init(struct packing *p, int dim, int64_t n, struct failure *failure);
void packing_free(struct packing *p);

/* k walls, k materials, in place of the old ones; their numbers are 0 and materials are named "0", "1" ...
   Each returns 0 or EX_SOFTWARE. */
int packing_alloc_walls(struct packing *p, int32_t k, struct failure *failure);
int packing_alloc_materials(struct packing *p, int32_t k, struct failure *failure);

/* law[materials * materials], all zero, in place of the old ones. Returns 0 or EX_SOFTWARE. */
int packing_alloc_laws(struct packing *p, struct failure *failure);

/* Accounts of so many pours and removals, all zero, in place of the old ones. Returns 0 or
   EX_SOFTWARE. */
int packing_alloc_passages(struct packing *p, int32_t pours, int32_t removals,
                           struct failure *failure);

/* 1/kg: of a body; 0: it is fixed, or a wall (i < 0) */
static inline double packing_inverse_mass(const struct packing *p, int32_t i)
{
    return i >= 0 && p->mass[i] > 0 ? 1 / p->mass[i] : 0;
}

/* Are there inlets or outlets? */
static inline bool packing_flows(const struct packing *p)
{
    return p->pours > 0 || p->removals > 0;
}
/* Do bodies come and go by themselves? */
static inline bool packing_varies(const struct packing *p)
{
    return packing_flows(p) || p->breakage;
}

/* Has any pair of materials static friction of its own? */
bool packing_sticks(const struct packing *p);
/* Has any pair of materials rolling or pivoting friction? */
bool packing_rolls(const struct packing *p);
/* May an impact gain energy [step/balance.h]? It needs restitution and friction. */
bool packing_may_gain(const struct packing *p);
/* Have contacts of any pair of materials, and has this one, a stiffness [contact/spring.h]? */
bool packing_has_springs(const struct packing *p);
/* May pairs be bonded? */
bool packing_adheres(const struct packing *p);
bool packing_springs(const struct packing *p, const struct contact *c);
/* Have contacts of any pair of materials, and has this one, a stiffness that follows from the time step? */
bool packing_has_compliance(const struct packing *p);
bool packing_complies(const struct packing *p, const struct contact *c);
/* Is Newton's law to be bounded for the contact [step/balance.h]? */
bool packing_bounds(const struct packing *p, const struct contact *c);

/* Room for n bodies; those beyond the present ones are at rest at the origin, their id -1. Fewer: the
   last ones are cut off. Returns 0 or EX_SOFTWARE; then n is as before. */
int packing_resize(struct packing *p, int64_t n, struct failure *failure);
/* The array of a column, all zero, in place of the old one. Returns 0 or EX_SOFTWARE. */
int packing_alloc_column(struct packing *p, int column, struct failure *failure);
/* The optional arrays that p has, bit k for body_columns[k]; and those of such a set, all zero */
uint32_t packing_optional(const struct packing *p);
int packing_alloc_optional(struct packing *p, uint32_t columns, struct failure *failure);
/* shape[n], all balls; image[n], all zero */
static inline int packing_alloc_shapes(struct packing *p, struct failure *failure)
{
    return packing_alloc_column(p, BODY_shape, failure);
}
static inline int packing_alloc_images(struct packing *p, struct failure *failure)
{
    return packing_alloc_column(p, BODY_image, failure);
}
/* Body `to` of p = body i of from, all numbers that both have */
void packing_copy_body(struct packing *p, int64_t to, const struct packing *from, int64_t i);
/* p with n bodies and arrays of `bodies`, from row `first` on; all is borrowed, from both. */
struct packing packing_with_bodies(const struct packing *p, const struct packing *bodies,
                                   int64_t first, int64_t n);

/*
 * The time is a function of the step, with one rounding of the product and one of the sum: it does not
 * depend on where a run was interrupted, and does not drift.
 */
enum {
    STEPS_LOG2 = 53
}; /* a step beyond 2^53, up or down, is no exact double: files with one are refused */
/* s: the time of a step */
static inline double packing_time(const struct packing *p, int64_t step)
{
    return p->t0 + (double)(step - p->step0) * p->dt;
}
/* s: the time when the step in hand has been made */
static inline double packing_next_time(const struct packing *p)
{
    return packing_time(p, p->step + 1);
}
/* Goes on with another dt from the packing's time on, counted from the same t0 where that gives the same
   times. With half of a dt it always does, and with twice a dt after an even number of steps: times that are
   multiples of both are the same double. */
void packing_set_dt(struct packing *p, double dt);
/* Counts from (t0, step0) if that gives the packing its time, as it is where nobody has changed t, step
   or dt since; else from its own time and step. */
void packing_count_from(struct packing *p, double t0, int64_t step0);
/* Does dt still change the time, or is it less than the distance of t to the next number? Returns 0 or
   EX_DATAERR. */
int packing_check_clock(const struct packing *p, struct failure *failure);

/* to = a deep copy of from; to need not be initialised. Returns 0 or EX_SOFTWARE. */
int packing_copy(struct packing *to, const struct packing *from, struct failure *failure);

/* Is every number finite and in its range (radius > 0, mass >= 0, mu >= 0, 0 <= e <= 1, dt > 0,
   unit normals ...)? Returns 0, or EX_DATAERR with the first body or wall that fails. */
int packing_check(const struct packing *p, struct failure *failure);
/* Of its bodies alone; the first one is the whole's body `first`. Returns the same. */
int packing_check_bodies(const struct packing *p, int64_t first, struct failure *failure);

/* Is the wall still there at time t (s)? */
static inline bool wall_there(const struct wall *w, double t)
{
    return t < w->until;
}

/* m: where the wall's point of reference is at time t (s), which is not before the packing's */
vec3 wall_at(const struct packing *p, const struct wall *w, double t);
/* The motion that has brought it there from where its shape is described */
struct pose wall_pose(const struct packing *p, const struct wall *w, double t);
/* Its normal or axis then */
vec3 wall_normal(const struct packing *p, const struct wall *w, double t);

/* m/s: of the wall's material at point x (m), the mean over the step from the packing's time: what is
   prescribed, and with what its load makes of it */
vec3 wall_held(const struct packing *p, const struct wall *w, vec3 x);
vec3 wall_velocity(const struct packing *p, const struct wall *w, vec3 x);
/* m/s: what its belt adds to that where its normal is n, in the step from the packing's time */
vec3 wall_belt(const struct packing *p, const struct wall *w, vec3 n);
/* rad/s: its mean angular velocity */
vec3 wall_spin(const struct packing *p, const struct wall *w);
/* m^2, in the plane m: the face of a plane across its normal, between planes upright to it and to each other, or
   across the cell, where it repeats, at time t (s); 0: it is not bounded so. */
double wall_face(const struct packing *p, const struct wall *w, double t);
/* m: of a room's wall, how far it is along its normal from the room's centre at time t (s) [state/servo_box.h] */
double wall_lever(const struct packing *p, const struct wall *w, double t);
/* N, N m: what its load is at time t (s), the middle of a step */
double wall_force(const struct packing *p, const struct wall *w, double t);
/* m/s: no point of the wall within its reach is faster, nor, of a mesh or a shape without an end,
   within that of the bodies */
double wall_top_speed(const struct packing *p, const struct wall *w);

/*
 * The theta method: the contacts of a step act where bodies are after step_ahead() at their first velocities,
 * and the rest, step_after(), goes by the velocities that the reactions make. No other place knows theta.
 */
/* s: (1 - theta) dt, and theta dt */
static inline double step_ahead(const struct packing *p)
{
    return (1 - p->theta) * p->dt;
}
static inline double step_after(const struct packing *p)
{
    return p->theta * p->dt;
}
/* N; N m where `turns`: what pulls body i at time t (s), in space */
static inline vec3 packing_pull(const struct packing *p, int64_t i, double t, bool turns)
{
    return pulls_on(&p->pulls, p->id[i], t, turns);
}
/* m/s: what gravity, pulls and forces from outside make of the velocity of body i, whose mass is above 0, in a step */
static inline vec3 packing_fall(const struct packing *p, int64_t i)
{
    vec3 dv = v3_scale(p->dt, p->g);
    if (p->outside.force) dv = v3_axpy(dv, p->dt / p->mass[i], p->outside.force[i]);
    if (!p->pulls.n) return dv;
    return v3_axpy(dv, p->dt / p->mass[i], packing_pull(p, i, p->t + p->dt / 2, false));
}
/* m/s: no body gains more by them */
static inline double packing_most_fall(const struct packing *p)
{
    return p->dt * v3_norm(p->g) + p->dt * (p->outside.most + p->pulls_most);
}

/* m: the position at which contacts are detected, q + (1 - theta) dt qdot [globalmapapp1]. */
static inline vec3 packing_predict(const struct packing *p, int64_t i)
{
    return v3_axpy(p->x[i], step_ahead(p), p->v[i]);
}

/* Is the wall along the periodic edge k, or between its faces, farther from them than `thick` (m), for ever [shape/wall_in_cell.h]? */
bool packing_wall_fits_edge(const struct packing *p, const struct wall *w, int k, double thick);
/* Do all walls, and do edges along them stand still? thick (m): of the largest body. Returns 0 or EX_DATAERR. */
int packing_check_walls(const struct packing *p, double thick, struct failure *failure);
/* The acceleration of the flow that the cell's edges make, in the step to come */
struct cell_flow packing_flow(const struct packing *p);

/* Where mu, en, et and law have what body a (< 0: wall -1-a) and body b do to each other */
static inline int32_t packing_pair(const struct packing *p, int32_t a, int32_t b)
{
    return (a < 0 ? p->wall[-1 - a].material : p->material[a]) * p->materials + p->material[b];
}

/* May body a (< 0: wall -1-a) and body b have contacts: does one of them move, and do their materials act on each other? */
static inline bool packing_may_meet(const struct packing *p, int32_t a, int32_t b)
{
    return (p->mass[b] > 0 || (a >= 0 && p->mass[a] > 0)) && p->inert[packing_pair(p, a, b)] == 0;
}

/* The contact's friction and restitution, of the materials of its bodies */
static inline void packing_set_law(const struct packing *p, struct contact *c)
{
    int32_t k = packing_pair(p, c->a, c->b);
#define SET(member, ...) c->member = p->member[k];
    EACH_PAIR_COLUMN(SET)
#undef SET
}

/* m: of the bodies of a contact */
static inline double packing_smaller_radius(const struct packing *p, const struct contact *c)
{
    return c->a < 0 ? p->radius[c->b] : fmin(p->radius[c->a], p->radius[c->b]);
}

/* body[] = those of bodies a and b that can move (mass > 0; a < 0 is a wall); returns how many. */
static inline int packing_movable(const struct packing *p, int32_t a, int32_t b, int32_t body[2])
{
    int k = 0;
    if (a >= 0 && p->mass[a] > 0) body[k++] = a;
    if (p->mass[b] > 0) body[k++] = b;
    return k;
}

/* The shape of body i; NULL: a ball or disc */
static inline const struct shape *packing_shape(const struct packing *p, int64_t i)
{
    return p->shape && p->shape[i] > 0 ? &p->shapes.s[p->shape[i]] : NULL;
}
/* What a new body is */
struct new_body {
    vec3 x, v, w;
    quat q;
    double radius, density; /* m, kg/m^3; in 2D kg/m^2 */
    double mass;            /* kg, in place of the density, where it is given */
    bool weighed;           /* it is */
    bool fixed;             /* mass and inertia are 0 */
    int32_t material, shape, group;
};
/* Body i, whose arrays exist. False: its radius is so small, or so large, that it has no mass. */
bool packing_set_body(struct packing *p, int64_t i, const struct new_body *body);

/* Mass (kg) and inertia (kg m^2) of a solid ball or disc: radius in m, density in kg m^-3, of a
   disc in kg m^-2. */
void packing_solid(int dim, double radius, double density, double *mass, double *inertia);
