/* measure/tensor.h: tensors of space, their invariants and principal values. */
#pragma once

#include "base/vec.h"

struct tensor {
    double x[3][3]; /* [row][column] */
};

/* T += s a b^T */
static inline void tensor_add(struct tensor *T, double s, vec3 a, vec3 b)
{
    v3_outer(T->x, s, a, b);
}

static inline void tensor_scale(struct tensor *T, double s)
{
    for (int k = 0; k < 9; k++) T->x[k / 3][k % 3] *= s;
}

static inline double tensor_trace(const struct tensor *T)
{
    return T->x[0][0] + T->x[1][1] + T->x[2][2];
}

/*
 * Of the symmetric part in dim dimensions: the deviator s = T - tr(T)/dim and its size, in space
 * q = sqrt(3/2 s:s), which for principal values (a, b, b) is |a - b|; in the plane half the
 * difference of the principal values, sqrt(s:s/2).
 */
double tensor_deviator(const struct tensor *T, int dim);

/* Principal values of the symmetric part, the largest first; in the plane the third is 0. By
   rotations of Jacobi. */
void tensor_principal(const struct tensor *T, int dim, double value[3]);
/* The logarithm of the symmetric part, whose principal values are positive; in the plane that of the first two rows
   and columns, the rest 0. */
struct tensor tensor_log(const struct tensor *T, int dim);
