/*
 * step/small_meet.h: meetings of small steps: pairs of bodies that are not both balls, shaped bodies with walls, and all bodies
 * with meshes. A meeting has several points, which the narrow phase [contact/detect.h] finds in each small step. A point
 * is known by its feature and keeps its reaction from step to step; one that goes leaves it to a new point beside it
 * [step/small_point.h].
 *
 * Groups of meetings share no body that moves, so that any number of threads gives the same bits.
 */
#pragma once

#include "solve/small.h"
#include "state/memory.h"
#include "state/packing.h"

/* f, kept, q, sum and m: as in struct small_bundle [solve/small.h] */
struct small_point {
    int32_t feature; /* below 0: a bond */
    bool there;      /* the narrow phase has found it when it last looked */
    bool near;       /* its gap is in reach in the step in hand */
    bool beside;     /* a bond holds where it is */
    bool left;       /* it has left its reaction to another in the step in hand */
    bool starts;     /* its bodies do not have its f yet */
    bool seam;       /* it is none: at a seam of surfaces, or where a bond is */
    double f[3], kept, q[3], sum[3], m[3], turned[3]; /* turned: the sum of m */
    double mu, e[2];
    double soft;                 /* C over W in the step in hand; 0: an impact */
    vec3 had;                    /* N s: f before the sweep of an impact */
    double spring[SPRING_COUNT]; /* where the contact has a stiffness */
    double pulls;                /* N s: the attraction of the step in hand, along -n; */
    vec3 pull;                   /* that which bodies have */
    /* Where it is, or was last */
    vec3 x, n, t1; /* m: midway in the gap; of the basis (n, t1, t2) */
    double gap;    /* m */
    vec3 a, b;     /* m: arms from the centres, that of the image that a meets */
    vec3 was[2];   /* m: those at which f was made */
    vec3 v;        /* m/s: of the wall's material there, without its load; */
    vec3 D, had_D; /* and per unit of the load's speed; that at which f was made */
    double W[9];   /* 1/kg, in the basis */
    /* Of a bond [step/small_anchor.h] */
    double area;      /* m^2; 0: it has no place yet */
    vec3 at[2], axis; /* its place, as in struct bond */
    bool fresh;       /* made in this interval */
    int32_t from;     /* 1 + the feature that it has in documents; 0: its own */
};

struct small_meeting {
    struct contact_key key; /* without a feature */
    double most[2];         /* m: mu_p, mu_r */
    bool looked;
    double wide, way; /* m: points were looked for to this gap; and what both had gone then */
    int64_t points, room;
    struct small_point
        *point; /* [points] by feature: those that are there, or have pushed in this interval */
    int rounds; /* of its points in the sweep in hand, at most; 0: none is in reach */
    double hold[HOLD_COUNT]; /* where something attracts */
    bool pressed;            /* springs have pushed in the interval before; */
    double rest;             /* m: g_0 of its springs */
    double work;             /* J: on a wall or a body that does not move, in this interval */
};

struct small_meetings {
    int64_t n, room;
    struct small_meeting *of; /* [n] by key */
    int64_t groups, serial,
        *group;     /* [groups + 1] of order[]; those from `serial` on are of one meeting each */
    int64_t *order; /* [n] meetings */
    int64_t *held_first,
        *held; /* [bodies + 1] meetings of a body that moves with what does not: held[held_first[i]] ... */
};

/* Do bodies a (wall -1-w where a < 0) and b meet in several places, or otherwise than balls do? */
static inline bool small_meets(const struct packing *p, int32_t a, int32_t b)
{
    if (packing_shape(p, b)) return true;
    return a < 0 ? p->wall[-1 - a].shape == WALL_MESH : packing_shape(p, a) != NULL;
}

void small_meetings_free(struct small_meetings *m);
/* A meeting without points. False when memory is short, as all that follow. */
bool small_meetings_add(struct small_meetings *m, const struct packing *p, struct contact_key key);
/* Order, groups and held ones, when all have been added; those of `from` that have pushed in this interval are added, too. */
bool small_meetings_lay(struct small_meetings *m, const struct packing *p,
                        const struct small_meetings *from);
/* NULL: none has this key, whatever its feature. */
struct small_meeting *small_meetings_find(const struct small_meetings *m, struct contact_key key);
/* Points go over to the meetings of the same bodies. */
void small_meetings_carry(struct small_meetings *to, struct small_meetings *from);
/* A point starts with a reaction that the packing remembers, and its moment, `part` of them. */
bool small_meeting_recall(struct small_meeting *m, const struct recall *r, double part);
int64_t small_meetings_points(const struct small_meetings *m);
/* N s: of what does not move in the interval, on the body that does; body[]: as of struct small */
vec3 small_meeting_impulse(const struct small_meeting *m, const struct body *body);

/*
 * What attracts bodies at the points of their meetings: a constant pull within a range and liquid bridges
 * [solve/small_hold.h]. A meeting has one bridge, and its points share its pull as the places of a pair do in a step
 * made at once [state/attraction.h].
 */
struct small_run;
/* Points pull in the small step in hand, by t->pull; after they have been looked for, by one thread */
void small_attract(struct small_run *r);
void small_attract_free(struct small_run *r);

/* m: points of the meeting are attracted up to this gap; 0: none is */
double small_attract_reach(const struct small_meeting *m);
/* J: stored in it */
double small_attract_energy(const struct small_meeting *m);
/* m: the smallest gap of its points; infinite without one */
double small_attract_gap(const struct small_meeting *m);
