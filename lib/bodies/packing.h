/*
 * bodies/packing.h: bodies, walls and the parameters of the motion: arrays, because they are the datasets.
 *
 * In the plane (dim 2) the bodies are discs in z = 0 that turn about z.
 */
#ifndef NSD_PACKING_H
#define NSD_PACKING_H

#include "base/vec.h"
#include "base/why.h"

#include <stdbool.h>
#include <stdint.h>

/* A half-space's border: bodies stay on the side that the normal points to. */
struct wall {
    vec3 x, n;    /* m: a point of it at t = 0; unit normal */
    vec3 v;       /* m/s: it travels at x + v t */
    int32_t kind; /* row of the material tables */
};

struct packing {
    int dim;      /* 2 or 3 */
    int64_t n;    /* bodies */
    int64_t step; /* steps made since the packing was built */
    double t, dt; /* s */
    double theta; /* of the theta-method; 1/2 is the paper's midpoint */
    vec3 g;       /* m/s^2 */
    uint64_t seed;

    double *radius;  /* [n] m */
    double *mass;    /* [n] kg; 0: immovable or prescribed */
    double *inertia; /* [n] kg m^2 */
    int32_t *id;     /* [n] a name that lasts */
    int32_t *kind;   /* [n] row of the material tables */
    vec3 *x;         /* [n] m */
    quat *q;         /* [n] orientation */
    vec3 *v, *w;     /* [n] m/s, rad/s */

    int32_t walls;
    struct wall *wall; /* [walls] */

    int32_t kinds;
    char **kind_name; /* [kinds] */
    double *mu, *en,
        *et; /* [kinds * kinds], symmetric: friction; restitution, normal, tangential */

    char *scene; /* the JSON it was built from, or NULL */
};

/* All zero, arrays of n bodies (identity orientation, id = index), one kind "ball" with mu = en =
   et = 0, dt = 0, theta 1/2. Returns 0 or EX_SOFTWARE when memory is short. */
int packing_init(struct packing *, int dim, int64_t n, struct why *);
void packing_free(struct packing *);

/* Room for k walls, k kinds; what was there is lost. Kinds get the names "0", "1" ... */
int packing_alloc_walls(struct packing *, int32_t k, struct why *);
int packing_alloc_kinds(struct packing *, int32_t k, struct why *);

/* to = a deep copy of from; to need not be initialised. */
int packing_copy(struct packing *to, const struct packing *from, struct why *);

/* Is every number finite and in its range (radius > 0, mass >= 0, mu >= 0, 0 <= e <= 1, dt > 0,
   unit normals ...)? Returns 0 or EX_DATAERR, naming the first body or wall that is not. */
int packing_check(const struct packing *, struct why *);

/* The position in which contacts are sought and frames taken: q + (1 - theta) dt qdot
   [globalmapapp1]. */
static inline vec3 packing_predict(const struct packing *p, int64_t i)
{
    return v3_axpy(p->x[i], (1 - p->theta) * p->dt, p->v[i]);
}

/* Which of bodies a and b (a may be a wall, < 0) can move; how many. */
static inline int packing_movable(const struct packing *p, int32_t a, int32_t b, int32_t body[2])
{
    int k = 0;
    if (a >= 0 && p->mass[a] > 0) body[k++] = a;
    if (p->mass[b] > 0) body[k++] = b;
    return k;
}

/* Mass and inertia of a solid ball (disc) of this radius (m) and density (kg m^-3, kg m^-2). */
void packing_solid(int dim, double radius, double density, double *mass, double *inertia);

#endif
