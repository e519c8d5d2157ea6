/* solve/method.c: the table of the local methods. */
#define METHOD_CODE
#include "solve/method.h"

#include "base/matrix.h"

#define METHOD(name, help, rho, believes)                                                          \
    const struct method local_##name = { METHOD_##name, #name, help, rho, believes };
EACH_METHOD(METHOD)

#define ADDRESS(name, ...) &local_##name,
const struct method *const methods[] = { EACH_METHOD(ADDRESS) NULL };

enum local_status eal_linearise(double mu, double rho, const double r[3], const double v[3],
                                double Z[3], double A[3][3], double B[3][3])
{
    return newton_linearise(mu, rho, r, v, EAL, Z, A, B);
}

double local_lambda_max(const double W[9])
{
    return eigen_largest(3, W);
}
