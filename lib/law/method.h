/* law/method.h: the table of the five local methods, which are in local_NAME.h. */
#ifndef NSD_METHOD_H
#define NSD_METHOD_H

#include "law/local.h"

#define EACH_METHOD(each) each(sbp) each(sal) each(ebp) each(eal) each(exact)

#define METHOD_ID(name) METHOD_##name,
enum method_id { EACH_METHOD(METHOD_ID) METHOD_COUNT };
#undef METHOD_ID

struct method {
    enum method_id id;
    const char *name, *help;
    double rho;    /* the default step is this over lambda_max(W_cc) */
    bool believes; /* has a u of its own that can be judged; else (SBP, SAL) it is the motion's */
};

/* In the order of their ids, NULL at the end */
extern const struct method *const methods[];
extern const struct method local_sbp, local_sal, local_ebp, local_eal, local_exact;

/*
 * Z and its derivatives A = dZ/dr, B = dZ/dv at (r, v), as the Newton of EAL has them [errorpred; corrected];
 * returns the branch.
 */
#if LANES == 1
enum local_status eal_linearise(double mu, double rho, const double r[3], const double v[3],
                                double Z[3], double A[3][3], double B[3][3]);
#endif

#endif
