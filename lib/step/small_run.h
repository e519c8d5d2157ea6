/*
 * step/small_run.h: the small steps of an interval, while they are made [step/small_loop.h].
 */
#pragma once

#include "state/freedom.h"
#include "state/placement.h"
#include "step/small_list.h"

#include <pthread.h>

/* A wall in a small step */
struct small_wall {
    bool there;
    struct pose pose;
    vec3 at, v, spin; /* m; m/s, rad/s: of its material at that point */
    vec3 held;        /* rad/s: of the spin, what is prescribed */
    vec3 belt;        /* m/s */
    double top;       /* m/s: of its fastest point */
    double way;       /* m: that it has gone in the interval */
};

/* The cell in a small step [step/small_cell.h] */
struct small_cell {
    bool moves, relative;      /* ways of bodies are those relative to the flow */
    struct cell cell;          /* where the small step begins; its arrays are borrowed */
    vec3 edge[3], next[3];     /* m: where contacts act; m/s: rates at the end of the step */
    struct cell_flow flow;     /* what the rates gain in the step; */
    struct cell_flow peculiar; /* and their flow where it begins */
    double strain;             /* 1/s */
    double work;               /* J: of the edges in the interval, by images */
    bool yields;               /* to a stress [step/small_stress.h]: */
    struct freedoms list;
    double push[3][3]; /* N m s: of reactions, in what sweeps see of the rates; */
    double loads;      /* J: of the stress in the interval */
};

/* What loads move in a small step [step/small_load.h] */
struct small_loads {
    struct freedoms list; /* of the step in hand */
    int32_t *of; /* [walls] the freedom that moves a wall; -1: none. NULL: nothing is loaded */
    /* [list.n] m/s, rad/s, 1/s: by how much the step changes the speed; of that, without reactions; what persists of the
       last step's reactions */
    double *change, *free, *kept;
    struct load *had; /* [walls] loads where the interval begins */
    double work;      /* J: of the loads in the interval */
    int64_t room;
    struct small_loaded *touch; /* of the freedom in hand */
    int64_t meeting_room;
    struct small_meeting **meeting; /* of the freedom in hand */
    bool tries; /* the speed of the freedom in hand is `trial` more; pushes of points leave it */
    double trial;
};

/* What a thread looks for points with */
struct small_scratch {
    struct contacts found;
    struct small_point *point;
    int64_t room;
};

/* The places where bodies are held [step/small_meet.h] */
struct small_shares {
    struct contacts places;
    struct small_point **point; /* [places.n] */
    struct attraction *of;      /* [places.n] */
    int64_t point_room, of_room;
};

/* Bodies as meetings have them, where there are any [step/small_point.h] */
struct small_shapes {
    quat *q;              /* [n] */
    double (*inverse)[6]; /* [n] 1/(kg m^2): world inertia, inverse: xx, yy, zz, yz, xz, xy */
    double *spread;       /* [n] 1/(kg m^2): its largest eigenvalue */
    double *way;          /* [n] m: that the fastest point of a body has gone in the interval */
    struct placed placed;
    struct situation at;
    int threads;
    struct small_scratch *scratch; /* [threads] */
    struct small_shares shares;
    struct small_dues *dues; /* [step/small_bond_point.c] */
    _Atomic bool failed;     /* memory was short */
};

/* Forces on a body in the small step in hand [step/small_pull.h] */
struct small_pull {
    double dv[3], dw[3]; /* m/s, rad/s: its free motion, with gravity and the flow of the cell; */
    double gain[3];      /* m/s: that of the flow */
    /* In the interval, before this step and half of it */
    double work, carried; /* J: of the forces, and of the flow */
    double impulse[3];    /* N s: of the flow, with all of this step */
};

/* The small steps of an interval */
struct small_run {
    struct packing *p; /* its dt and t are those of the small step in hand */
    struct small_list *l;
    struct small_part *part; /* of several processes, this one's [step/small_part.h]; NULL: alone */
    const struct small_kernels *kernel;
    struct small_wall *wall; /* [walls] */
    vec3 *x, *v, *turned;    /* [n] m, m/s; rad: by which bodies have turned */
    struct small_pull *pull; /* [n] NULL: no forces on bodies, and no cell that moves */
    struct small_cell cell;
    struct small_loads loads;
    double stored;          /* J: by attraction, where the interval begins */
    struct face_sums *sums; /* [p->sums.n] NULL: none are kept */
    bool meets;             /* there may be meetings: a body with a shape, or a mesh; */
    bool bonds;             /* and bonds at their points */
    struct small_shapes shapes;
    double thin;             /* m: the smallest size of a body */
    double h, ahead;         /* s */
    double overlap;          /* radii of the smallest body: what is permitted */
    double fall;             /* m/s: in a small step, by all forces that are not reactions */
    double weight, load;     /* N s: of all bodies, in it; of the mean body, over its weight */
    int64_t free;            /* bodies that move */
    int64_t n, made, sweeps; /* small steps, and those made; sweeps of all */
    int64_t unsolved;        /* small steps that have ended with the limit of sweeps */
    int32_t swept;           /* of the step in hand */
    bool begins, stop;       /* the first step; the list serves no longer, or the step fails */
    bool uneven;             /* bodies have masses so different that sweeps are slow */
    bool judged;             /* its errors are summed up [step/small_error.h] */
    double *missing; /* [2 bodies] N s: of a small step, missing and load, where it is bounded */
    bool exceeds;
    double bound; /* of what is missing of the reactions of all bodies in a small step; 0: none */
    bool gains,
        gained;       /* gains of energy are bounded [step/small_gain.h]; and there has been one */
    bool compares;    /* the last one is compared with converged sweeps [step/small_converge.h]: */
    int32_t compared; /* in so many sweeps */
    double distance;  /* of the reactions from those then, over these */
    bool failed;      /* the interval is to be made at once */
    bool lost;        /* memory was short */
    _Atomic bool far; /* a sweep has changed a body by more than is allowed */
    pthread_mutex_t lock; /* of what follows */
    double fastest;       /* m^2/s^2: of bodies */
    double strays; /* m^2: the square of how far bodies are beside their ways [step/small_list.h] */
    int64_t shaken; /* by how much the last step has changed velocities [step/small_loop.c] */
};

/* Does a load move the wall of a touch? */
static inline bool small_is_loaded(const struct small_run *r, const struct small_touch *t)
{
    return r->loads.of && r->loads.of[t->wall] >= 0;
}

/* Does a load move the wall of a meeting? */
static inline bool small_meeting_loaded(const struct small_run *r, const struct small_meeting *m)
{
    return m->key.a < 0 && r->loads.of && r->loads.of[-1 - m->key.a] >= 0;
}

/* m/s: at most, of a point of body i, of a ball its centre */
static inline double small_point_speed(const struct small_run *r, int64_t i)
{
    const struct body *b = &r->l->s.body[i];
    const double arm = packing_shape(r->p, i) ? r->p->radius[i] : 0;
    return v3_norm(small_vec(b->v)) + arm * v3_norm(small_vec(b->w));
}
