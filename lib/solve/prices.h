/*
 * solve/prices.h: what a solve's parts cost, for the strategies that choose between them.
 *
 * Prices are ns of an ordinary core, but they are counted and not timed, so that the same problem is
 * solved in the same way everywhere. What all of a solve has cost is its report's `work`.
 */
#ifndef NSD_PRICES_H
#define NSD_PRICES_H

#include "problem/problem.h"

/* A sweep over all contacts */
double price_sweep(const struct problem *p);

/* A matrix with this many multiplications in its factorisation (known from its fill) and entries in its
   pattern: one factorisation with all else that a Newton step wants; and what it costs to find its fill,
   before the first. */
double price_newton_step(double multiplications, double entries);
double price_analysis(double entries);
/* To make the blocks of W, of so many entries, from the bodies or from another W */
double price_assembly(double entries);

#endif
