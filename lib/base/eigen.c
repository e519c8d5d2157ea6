/* base/eigen.c: Jacobi's method, with square roots alone [base/eigen.h]. */
#include "base/eigen.h"

#include <math.h>
#include <stdbool.h>

/* Times through all pairs: it converges quadratically, and fewer serve for six rows. */
enum { ROUNDS = 8 };

/* Turns rows and columns p and q so that S[p][q] becomes 0. */
static inline void matrix_rotate(int n, double S[EIGEN_MOST][EIGEN_MOST], int p, int q)
{
    double h = 0.5 * (S[q][q] - S[p][p]) / S[p][q];
    double t = copysign(1 / (fabs(h) + sqrt(1 + h * h)), h), c = 1 / sqrt(1 + t * t), s = t * c;
    S[p][p] -= t * S[p][q], S[q][q] += t * S[p][q];
    S[p][q] = S[q][p] = 0;
    for (int k = 0; k < n; k++) {
        if (k == p || k == q) continue;
        double a = S[k][p], b = S[k][q];
        S[k][p] = S[p][k] = c * a - s * b;
        S[k][q] = S[q][k] = s * a + c * b;
    }
}

/* Is what is beside the diagonal so small that no rotation changes the largest entry of the diagonal, not even in
   its last bit? */
static inline bool settled(int n, double S[EIGEN_MOST][EIGEN_MOST])
{
    double most = 0, beside = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            double *to = i == j ? &most : &beside;
            *to = fmax(*to, fabs(S[i][j]));
        }
    return beside <= 1e-20 * most;
}

/* Pairs one apart, then two apart ..., round the corner */
static inline double eigen_jacobi(int n, const double *A)
{
    double S[EIGEN_MOST][EIGEN_MOST] = { { 0 } }, most;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) S[i][j] = 0.5 * (A[n * i + j] + A[n * j + i]);
    for (int round = 0; round < ROUNDS && !settled(n, S); round++)
        for (int apart = 1; apart <= n / 2; apart++)
            for (int k = 1; k <= n; k++) {
                int p = k % n, q = (k + apart) % n;
                if (S[p][q] != 0) matrix_rotate(n, S, p, q);
            }
    most = S[0][0];
    for (int i = 1; i < n; i++) most = fmax(most, S[i][i]);
    return most;
}

double eigen_largest(int n, const double *A)
{
    return n == 3 ? eigen_jacobi(3, A) : eigen_jacobi(n, A); // contacts' matrices in straight code
}
