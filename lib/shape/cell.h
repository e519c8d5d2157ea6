/*
 * shape/cell.h: the box that repeats. A point x is the same as x + k_0 edge[0] + k_1 edge[1] +
 * k_2 edge[2], with whole k along the edges that repeat and 0 along the others.
 *
 * Velocities are absolute: the image of a body across edge k moves at v + rate[k]. Simple shear
 * (Lees and Edwards 1972) and compression of the whole cell differ in the rate alone.
 *
 * An edge moves like a body, q_{k+1/2} = q_k + (1 - theta) dt rate_k and
 * q_{k+1} = q_{k+1/2} + theta dt rate_{k+1}, so that the image of a body keeps its distance from it
 * to rounding. What rate_{k+1} is, a velocity gradient L says, rate_{k+1} = L(t_{k+1}) q_{k+1}; or,
 * for the components of an edge that yield to a stress, the contacts do (state/freedom.h).
 *
 * Where rates change, bodies are accelerated as the flow v = L (x - origin) is that the edges make,
 * by sum of u_k (rate_{k+1} - rate_k)_k for a body u edges from the origin. Without it a body and its
 * image would differ in what they do, and a lattice that is compressed would not stay one. In simple
 * shear at a constant rate it is 0. (Yade does so for homoDeform 3.)
 *
 * Which of a body's images is the body is arbitrary, and so is which edges span the lattice:
 * state/placement.h chooses both again at the beginning of a step.
 */
#pragma once

#include "base/failure.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

/* A velocity gradient at a moment, dv_i/dx_j = L[i][j] */
struct cell_gradient {
    double t;       /* s */
    double L[3][3]; /* 1/s */
};

/* By how much loads are multiplied at a moment */
struct cell_factor {
    double t; /* s */
    double x;
};

struct cell {
    bool repeats[3];
    vec3 origin;  /* m: the corner from which the edges start */
    vec3 edge[3]; /* m, at the packing's time */
    vec3 rate[3]; /* m/s: d edge / dt, at the packing's time */

    /* The edges' given motion: linear in time between these moments, constant before and after;
       none: at rest. In the order of t. */
    int32_t gradients;
    struct cell_gradient *gradient; /* [gradients] */

    /* Components of edges that yield instead: component i of edge k has the mass mass[k][i] > 0, and
       the surroundings press on the cell with a stress, of which column k acts on edge k. */
    double mass[3][3];   /* kg; 0: moves as the gradient says */
    double stress[3][3]; /* Pa, of discs N/m: compression is positive; [i][j], symmetric */

    /* Or its size yields: all edges repeat and grow at one rate s beside a gradient whose trace is taken off,
       rate_{k+1} = (L + s_{k+1}) q_{k+1/2}, so that contacts see it change linearly in s. The mean stress of
       the surroundings presses on it. */
    double size_mass; /* kg m^2: of s, 1/s; 0: it does not yield */
    double mean;      /* Pa, of discs N/m */

    /* Stress and mean are multiplied by a factor, linear in time between these moments, constant before and
       after; none: 1. In the order of t. */
    int32_t factors;
    struct cell_factor *factor; /* [factors] */
};

static inline bool cell_repeats(const struct cell *c)
{
    return c->repeats[0] || c->repeats[1] || c->repeats[2];
}

/* m, or m/s: shift[0] e[0] + shift[1] e[1] + shift[2] e[2], of the edges or of their rates */
static inline vec3 cell_shift(const vec3 e[3], const int8_t shift[3])
{
    vec3 s = v3(0, 0, 0);
    for (int k = 0; k < 3; k++)
        if (shift[k]) s = v3_axpy(s, shift[k], e[k]);
    return s;
}

/* The cell of a packing without images: nothing repeats, unit edges. */
struct cell cell_none(void);
void cell_free(struct cell *c);
/* to = a deep copy of from; to need not be initialised; -1 when memory is short. */
int cell_copy(struct cell *to, const struct cell *from);

/*
 * Are all numbers finite, the edges not in a plane, within the plane where dim is 2, the moments in
 * order, masses not negative? Is each pair of opposite faces that repeat at least `least` (m) apart?
 * Less than the largest diameter, and a body would touch itself. Returns 0 or EX_DATAERR.
 */
int cell_check(const struct cell *c, int dim, double least, struct failure *failure);

/* 1/m: rows of the inverse of the matrix whose columns are the edges: u_k = inverse[k] . (x - origin)
   counts edges */
void cell_inverse(const vec3 edge[3], vec3 inverse[3]);
/* m, in the plane too: distances of opposite faces */
void cell_heights(const struct cell *c, double height[3]);

/* Does any component of an edge yield, or the size? */
bool cell_yields(const struct cell *c);
/* By what stress and mean are multiplied at time t (s), and the most that this comes to at any time */
double cell_factor_at(const struct cell *c, double t);
double cell_factor_most(const struct cell *c);
/* Directions of space in which a cell repeats whose size yields */
static inline int cell_dim(const struct cell *c)
{
    return c->repeats[2] ? 3 : 2;
}
/* 1/s: s of a cell whose size yields; after: of the step that has made the rates, s */
double cell_growth(const struct cell *c, double after);
/* Does edge k move, or may it at some time? */
bool cell_moves(const struct cell *c, int k);
/* rate = those of the gradient at time t (s); of what yields 0 */
void cell_set_rate(struct cell *c, double t);
/* out[3] (m): the edges half a step on, where the contacts act: after `ahead` s at their rates */
void cell_predict(const struct cell *c, double ahead, vec3 out[3]);
/* out[3] (m/s): the rates at the end of a step, at end_time (s), by the gradient; components that yield keep
   theirs, to which forces and contacts add. ahead, after (s): the parts of the step before and after the
   contacts act */
void cell_next_rate(const struct cell *c, double end_time, double ahead, double after, vec3 out[3]);
/* The edges through a step, at whose end their rates are next[3]; and back to time t, to rounding,
   where what yields had the rates that it has. */
void cell_move(struct cell *c, double ahead, double after, const vec3 next[3]);
void cell_unmove(struct cell *c, double t, double ahead, double after);

/* The acceleration of the flow in the step from time t */
struct cell_flow {
    bool changes;    /* else there is none */
    vec3 origin;     /* m */
    vec3 inverse[3]; /* 1/m: of the edges where the contacts act */
    vec3 gain[3];    /* m/s: of the edges' rates in the step */
};
/* half, gain: the edges where the contacts act, and what their rates gain in the step */
void cell_flow_init(struct cell_flow *f, const struct cell *c, const vec3 half[3],
                    const vec3 gain[3]);
/* m/s: what a body gains whose position where contacts act is x */
static inline vec3 cell_flow_gain(const struct cell_flow *f, vec3 x)
{
    vec3 d = v3_sub(x, f->origin), v = v3(0, 0, 0);
    for (int k = 0; k < 3; k++) v = v3_axpy(v, v3_dot(f->inverse[k], d), f->gain[k]);
    return v;
}

/* How many edges to take off x (m) for it to lie in the cell */
void cell_wraps(const struct cell *c, const vec3 inverse[3], vec3 x, int32_t wraps[3]);
/*
 * One cut of the cell into a less oblique one of the same lattice: edge[*to] -= n edge[*from].
 * Returns n; 0: it is not too oblique, or the new edge would not move as it must.
 */
int32_t cell_recut(struct cell *c, int *to, int *from);
