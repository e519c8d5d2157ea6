/* solve/rolling_contact.h: one contact with rolling and pivoting friction, in the units of solve/rolling.h. */
#ifndef NSD_ROLLING_CONTACT_H
#define NSD_ROLLING_CONTACT_H

#include "solve/method.h"

enum {
    ROLLING = 6,
    ROLLING_PARTS = 3
}; /* numbers of x: n | t1 t2 | p | r1 r2; parts with a limit */

struct rolling {
    double wn, wt, wp, wr, k;    /* kg^-1: between balls */
    bool full;                   /* else W is, in their place */
    double W[ROLLING * ROLLING]; /* kg^-1, symmetric */
    double lambda;               /* kg^-1: its largest eigenvalue */
    double mu[ROLLING_PARTS];    /* mu, mu_p, mu_r, the latter two over the length */
    double rho;                  /* kg */
    double b[ROLLING];           /* m/s */
    double x[ROLLING];           /* N s; in: of the last sweep, out: of this one */
    int steps;                   /* out: of Newton */
    bool safeguarded, gave_up;
};

#endif
