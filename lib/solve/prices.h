/*
 * solve/prices.h: what the parts of a solve cost, for the strategies that choose between them.
 *
 * Prices are ns of an ordinary core, but they are counted and not timed, so that the same problem
 * is solved in the same way everywhere. Their sum over a solve is its report's `work`.
 */
#ifndef NSD_PRICES_H
#define NSD_PRICES_H

#include "solve/problem.h"

/* A sweep over all contacts */
double price_sweep(const struct problem *p);

/* A Newton step with its one factorisation: `multiplications` of the factorisation (known from its
   fill), `entries` of the matrix's pattern */
double price_newton_step(double multiplications, double entries);
/* Finding the fill of a pattern with this many entries, before its first factorisation */
double price_analysis(double entries);
/* Making W's blocks, with this many entries, from the bodies or from another W */
double price_assembly(double entries);

#endif
