#include "measure/tensor.h"

#include <math.h>

static struct tensor symmetric(const struct tensor *T)
{
    struct tensor S;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) S.x[i][j] = 0.5 * (T->x[i][j] + T->x[j][i]);
    return S;
}

double tensor_deviator(const struct tensor *T, int dim)
{
    struct tensor S = symmetric(T);
    double mean = 0, sum = 0;
    for (int i = 0; i < dim; i++) mean += S.x[i][i] / dim;
    for (int i = 0; i < dim; i++)
        for (int j = 0; j < dim; j++) {
            double s = S.x[i][j] - (i == j ? mean : 0);
            sum += s * s;
        }
    return sqrt((dim == 2 ? 0.5 : 1.5) * sum);
}

/* Turns rows and columns i, j of the symmetric S so that S[i][j] = 0. */
static void tensor_rotate(struct tensor *S, int i, int j)
{
    double off = S->x[i][j];
    if (off == 0) return;
    double half = 0.5 * (S->x[j][j] - S->x[i][i]) / off;
    double t = (half < 0 ? -1 : 1) / (fabs(half) + sqrt(half * half + 1));
    double c = 1 / sqrt(t * t + 1), s = t * c;
    int k = 3 - i - j;
    double ki = S->x[k][i], kj = S->x[k][j];
    S->x[i][i] -= t * off, S->x[j][j] += t * off;
    S->x[i][j] = S->x[j][i] = 0;
    S->x[k][i] = S->x[i][k] = c * ki - s * kj;
    S->x[k][j] = S->x[j][k] = s * ki + c * kj;
}

/* The rotation of rotate(), of columns i and j of Q: S' = R^T S R, Q' = Q R */
static void rotate_both(struct tensor *S, struct tensor *Q, int i, int j)
{
    double off = S->x[i][j];
    if (off == 0) return;
    double half = 0.5 * (S->x[j][j] - S->x[i][i]) / off;
    double t = (half < 0 ? -1 : 1) / (fabs(half) + sqrt(half * half + 1));
    double c = 1 / sqrt(t * t + 1), s = t * c;
    tensor_rotate(S, i, j);
    for (int k = 0; k < 3; k++) {
        double ki = Q->x[k][i], kj = Q->x[k][j];
        Q->x[k][i] = c * ki - s * kj, Q->x[k][j] = s * ki + c * kj;
    }
}

struct tensor tensor_log(const struct tensor *T, int dim)
{
    struct tensor S = symmetric(T), Q = { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
    struct tensor L = { { { 0 } } };
    for (int round = 0; round < 30; round++) {
        rotate_both(&S, &Q, 0, 1);
        if (dim == 3) rotate_both(&S, &Q, 0, 2), rotate_both(&S, &Q, 1, 2);
    }
    for (int k = 0; k < dim; k++) {
        vec3 axis = v3(Q.x[0][k], Q.x[1][k], Q.x[2][k]);
        tensor_add(&L, log(S.x[k][k]), axis, axis);
    }
    return L;
}

void tensor_principal(const struct tensor *T, int dim, double value[3])
{
    struct tensor S = symmetric(T);
    for (int round = 0; round < 30; round++) {
        tensor_rotate(&S, 0, 1);
        if (dim == 3) tensor_rotate(&S, 0, 2), tensor_rotate(&S, 1, 2);
    }
    for (int i = 0; i < 3; i++) value[i] = i < dim ? S.x[i][i] : 0;
    for (int i = 1; i < dim; i++)
        for (int j = i; j > 0 && value[j] > value[j - 1]; j--) {
            double larger = value[j];
            value[j] = value[j - 1], value[j - 1] = larger;
        }
}
