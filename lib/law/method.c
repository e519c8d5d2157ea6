/* law/method.c: the table of the local methods. */
#include "law/method.h"

#include "base/eigen.h"
#include "law/local_eal.h"

const struct method local_sbp = { METHOD_sbp, "sbp",
                                  "standard bi-potential: one projected step of Uzawa", 1.75,
                                  false };
const struct method local_sal = { METHOD_sal, "sal",
                                  "simple augmented Lagrangian: one projected step of the gradient",
                                  1.75, false };
const struct method local_ebp = { METHOD_ebp, "ebp",
                                  "enhanced bi-potential: Newton on r = proj(tau, cone)", 1, true };
const struct method local_eal = { METHOD_eal, "eal",
                                  "enhanced augmented Lagrangian: Newton on r = proj(tau, disc)", 1,
                                  true };
const struct method local_exact = { METHOD_exact, "exact",
                                    "the one-contact problem solved outright", 1, true };

#define METHOD(name) &local_##name,
const struct method *const methods[] = { EACH_METHOD(METHOD) NULL };

enum local_status eal_linearise(double mu, double rho, const double r[3], const double v[3],
                                double Z[3], double A[3][3], double B[3][3])
{
    return newton_linearise(mu, rho, r, v, EAL, Z, A, B);
}

double local_lambda_max(const double W[9])
{
    return eigen_largest(3, W);
}
