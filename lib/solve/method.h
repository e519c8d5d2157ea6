/*
 * solve/method.h: the table of the five local methods, which are in local_NAME.h. A method is that file, its row
 * here and its include at the end.
 */
#ifndef NSD_METHOD_H
#define NSD_METHOD_H

#include "solve/local.h"

#include <stdbool.h>

/*
 * X(name, help, rho, believes)
 *
 *   rho       the default step is this over lambda_max(W_cc)
 *   believes  the method has a u of its own that can be judged; else (SBP, SAL) it is the motion's
 */
#define EACH_METHOD(X)                                                                             \
    X(sbp, "standard bi-potential: one projected step of Uzawa", 1.75, false)                      \
    X(sal, "simple augmented Lagrangian: one projected step of the gradient", 1.75, false)         \
    X(ebp, "enhanced bi-potential: Newton on r = proj(tau, cone)", 1, true)                        \
    X(eal, "enhanced augmented Lagrangian: Newton on r = proj(tau, disc)", 1, true)                \
    X(exact, "exact solution of the one-contact problem", 1, true)

#define METHOD_ID(name, ...) METHOD_##name,
enum method_id { EACH_METHOD(METHOD_ID) METHOD_COUNT };
#undef METHOD_ID

struct method {
    enum method_id id;
    const char *name, *help;
    double rho;
    bool believes;
};

/* In the order of their ids, NULL at the end */
extern const struct method *const methods[];
#define METHOD_NAME(name, ...) extern const struct method local_##name;
EACH_METHOD(METHOD_NAME)
#undef METHOD_NAME

/*
 * Z and its derivatives A = dZ/dr, B = dZ/dv at (r, v), as the Newton of EAL has them [errorpred; corrected];
 * returns the branch.
 */
#if LANES == 1
enum local_status eal_linearise(double mu, double rho, const double r[3], const double v[3],
                                double Z[3], double A[3][3], double B[3][3]);
#endif

#endif

/* The code of the methods, for the files that run it: #define METHOD_CODE before */
#ifdef METHOD_CODE
#include "solve/local_eal.h"
#include "solve/local_ebp.h"
#include "solve/local_exact.h"
#include "solve/local_sal.h"
#include "solve/local_sbp.h"
#endif
