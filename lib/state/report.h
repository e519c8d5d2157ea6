/*
 * state/report.h: what a solve reports. Only seconds, elapsed and detection come from a clock,
 * and no document gets these.
 */
#pragma once

#include "state/contact.h"
#include "state/packing.h"

#include <stdbool.h>
#include <stdint.h>

enum criterion {
    CRITERION_GLOB,
    CRITERION_SCALED,
    CRITERION_NATURAL,
    CRITERION_VELOCITY,
    CRITERION_COUNT
};
extern const char *const criterion_name[CRITERION_COUNT]; /* as documents and logs have them */

/* The paper's error and its four terms, each the mean over the contacts [estimator, corrected]. */
struct terms {
    double eps_glob;    /* the sum of the four */
    double motion;      /* |u~ - u~_free - W~ r|, m/s: how far the local u is from the motion's */
    double proj;        /* |r - proj(r, K_mu)|, N */
    double bipotential; /* |u~.r + mu r_n |u~_t||, W */
    double penetration; /* -min(0, u~_n), m/s */
};

struct err {
    int64_t contacts;
    struct terms paper;          /* reactions as forces, r/dt */
    struct terms scaled;         /* u over g dt, r over m g dt: no units */
    double max_penetration;      /* m/s: max -u~_n of the local u, as the paper's tables have it */
    double max_penetration_true; /* m/s: max -u~_n of the motion that r makes */
    double max_overlap;          /* m: max -gap; 0 where there are no gaps (FCLIB) */
    double natural;              /* |r - P(r - rho_a u^)| / |r|, rho_a = 1/lambda_max(W_aa) */
    double natural_siconos;      /* |r - P(r - u^)| / |q|, step 1: not scale-free */
    double natural_q;            /* |(r - P(r - rho_a u^))/rho_a| / |q| */
    double velocity;       /* velocity_error over the scene's own velocity [solve/problem.h] */
    double velocity_error; /* m/s: the largest |(r - P(r - rho_a u^))/rho_a| of a contact */
    int64_t jammed; /* contacts that are left out of these, for their reactions grow without end */
    double stray;   /* natural_q's over max(|q|, sqrt(n) g dt); of an FCLIB problem velocity */
};

/* Radii: as deep as a run fails for [state/account.h]; what an impact leaves for a step is less */
#define DEPTH_PINCHED 0.1

/* How deep bodies are in one another */
struct depth {
    double deepest;     /* radii; 0: nothing overlaps */
    int32_t pair[2];    /* the ids of a and b there; wall w is -1-w */
    int64_t pinched;    /* bodies */
    int32_t pinched_id; /* the first of them */
};

/* Energy and momentum over a step [step/balance.h] */
struct balance {
    double kinetic;   /* J: after the step; of the bodies and of what loads move */
    double change;    /* J: of kinetic, in the step */
    double potential; /* J: - sum m g . x, after the step, of the bodies */
    double gravity, drives, loads, dissipation; /* J: in the step */
    /* J, where pairs are tied [contact/contact_law.h]: of what is stored, in the step; what is stored then; what
       broken bonds and joining liquid have given up, in the step */
    double bond_change, bond_energy, broken;
    double
        implicit;  /* J: lost by the implicit step of springs, in the step; a part of dissipation */
    double rise;   /* J: given in the step by initial overlaps that rise [contact/spring.h] */
    double gained; /* J: by impacts, in the step; a part of -dissipation */
    double
        projection; /* J: against gravity, by moving bodies apart after the step; where that is done */
    double spun[3]; /* N m s: of angular momentum, by that */
    /* J, where the cell moves: of translation, by the velocities relative to its flow [state/rotation.h], after the
       step; and its change in the step */
    double peculiar, peculiar_change;
    double
        breaking; /* J: kinetic and potential, of the dust of grains that broke before the step; where grains may */
    double momentum[3]; /* N s: of the bodies, after the step */
    double impulse[3];  /* N s: of walls and fixed bodies on the others, in the step */
};

/* What would be infinite or no number after a step, for which the step is not made; the first found */
struct endless {
    enum endless_what {
        ENDLESS_NOTHING,
        ENDLESS_POSITION,
        ENDLESS_VELOCITY,
        ENDLESS_SPIN,
        ENDLESS_ENERGY,
        ENDLESS_WALL,
        ENDLESS_CELL,
        ENDLESS_REPORT
    } what;
    int32_t id; /* of the body; a wall w is -1-w */
};

struct report {
    char method[16];
    char *options; /* JSON object: every option that shaped the result; to be freed, may be NULL */
    int64_t step;
    double t; /* s, after the step */
    struct err err;
    bool balanced;          /* balance is known: where there is a packing */
    bool tied;              /* its terms of bonds too: where pairs have other laws */
    bool soft;              /* and of springs: where contacts have a stiffness */
    bool may_gain;          /* and of impacts that gain: where they may */
    bool projected;         /* and of moving bodies apart: where the overlap rule does */
    bool sheared;           /* and of the peculiar velocities: where the cell moves */
    bool breaks;            /* and of grains that break: where they may */
    struct balance balance; /* of the step that the reactions make */
    struct depth depth;     /* of the contacts of a packing */
    enum criterion criterion;
    double eps; /* what was asked */
    int32_t sweeps;
    bool converged;
    int32_t unsolved
        [2]; /* where it has not converged: the ids of the bodies of the contact that is farthest
                            from its law; a wall w is -1-w */
    int64_t newton;        /* Newton steps in all */
    int64_t safeguarded;   /* local solves that ended with the exact solution instead */
    int64_t gave_up;       /* local solves that did not satisfy the law */
    bool watched;          /* there is what bodies may pass [contact/tunnelling.h] */
    int64_t fast;          /* bodies that moved by more than they are thick */
    int32_t fast_id;       /* the first of them */
    int64_t substeps;      /* parts that the step was made in */
    int64_t small;         /* small steps, of which it is made; 0: it was made at once */
    int64_t small_limited; /* those of them that have ended at the limit of their sweeps */
    bool fine;             /* small steps were asked for, and what follows is known */
    bool judged;           /* and reactions are compared with converged ones */
    double missing_mean,
        missing; /* what is missing of reactions, over the load: of all bodies, and of the worst */
    int32_t missing_id; /* the worst */
    int32_t
        compared; /* sweeps in which the last small step's reactions have converged, on a copy; 0: not looked at */
    double distance;         /* |f - f_c| over |f_c| of all of them, f_c converged */
    struct endless endless;  /* for which the step was not made */
    double work;             /* ns, counted and not timed, of the whole solve [solve/solver.h] */
    const char *given_up;    /* why it ended before its limits, a literal; or NULL */
    const char *on_cpu;      /* why the device asked for did not solve it, a literal; or NULL */
    double bus_to, bus_from; /* bytes to the device, and from it */
    int64_t kernels;         /* started there */
    double seconds;          /* s of CPU, of all threads, in the solve */
    double elapsed;          /* s on the wall, in the solve */
    double detection;        /* s of CPU to find the contacts, where the step did so itself */
    struct terms *history;   /* [sweeps] under --history, else NULL; to be freed */
};

/* s on the clock: of CPU in all threads of this process; on the wall */
enum report_clock { CLOCK_CPU, CLOCK_WALL };
double report_seconds(enum report_clock clock);

void report_free(struct report *r);

/* Was the step made? Else its solve diverged, or something would not be finite, and nothing has moved. */
bool report_made(const struct report *r);
/* Writes "step 12: the velocity of body 3 would not be finite" into text of that room, where it was not made. */
void report_says_end(const struct report *r, char *text, size_t room);
