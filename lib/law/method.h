/* law/method.h: the five local methods as a table; the texts are in local_NAME.h. */
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
    double rho;    /* default rho = this / lambda_max(W_cc) */
    bool believes; /* u is the method's own; else the motion's (SBP, SAL) */
};

/* In the order of their ids; NULL ends it. */
extern const struct method *const methods[];
extern const struct method local_sbp, local_sal, local_ebp, local_eal, local_exact;
const struct method *method_find(const char *name); /* NULL when there is none */

/* One contact alone, in one lane, not relaxed; its v follows from r and b. */
#if LANES == 1
void method_solve(const struct method *, struct local *, const struct local_opt *);

/*
 * Z and its derivatives A = dZ/dr, B = dZ/dv at (r, v), for the Newton of EBP and EAL [errorpred,
 * predbipo; corrected]; returns the branch taken. Public so that the tests can differentiate them.
 */
enum local_status ebp_linearise(double mu, double rho, const double r[3], const double v[3],
                                double Z[3], double A[3][3], double B[3][3]);
enum local_status eal_linearise(double mu, double rho, const double r[3], const double v[3],
                                double Z[3], double A[3][3], double B[3][3]);
#endif

#endif
