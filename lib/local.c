#include "local.h"

#include <string.h>

const struct method *const methods[] = { &local_sbp, &local_sal,   &local_ebp,
                                         &local_eal, &local_exact, NULL };

const struct method *method_find(const char *name)
{
    for (const struct method *const *m = methods; *m; m++)
        if (!strcmp((*m)->name, name)) return *m;
    return NULL;
}

/* Jacobi's rotations; eight rounds are more than any 3 x 3 matrix wants. */
double local_lambda_max(const double W[9])
{
    double S[3][3];
    for (int i = 0; i < 9; i++) S[i / 3][i % 3] = 0.5 * (W[i] + W[3 * (i % 3) + i / 3]);
    for (int i = 0; i < 24; i++) {
        int k = i % 3, p = (k + 1) % 3, q = (k + 2) % 3;
        if (S[p][q] == 0) continue;
        double h = 0.5 * (S[q][q] - S[p][p]) / S[p][q];
        double t = copysign(1 / (fabs(h) + hypot(1, h)), h), c = 1 / sqrt(1 + t * t), s = t * c;
        double a = S[k][p], b = S[k][q];
        S[p][p] -= t * S[p][q], S[q][q] += t * S[p][q];
        S[p][q] = S[q][p] = 0;
        S[k][p] = S[p][k] = c * a - s * b;
        S[k][q] = S[q][k] = s * a + c * b;
    }
    return fmax(S[0][0], fmax(S[1][1], S[2][2]));
}
