/* solve/prices.c: the prices that were measured, and the formulas over them [solve/prices.h]. */
#include "solve/prices.h"

#define SWEEP_BLOCK    2.0 /* ns per sweep, beyond kind.ns, for each block of W beside the diagonal, */
#define SWEEP_COMMON   2.0   /* and for each column of J */
#define ENTRY          14.0  /* ns an entry of the pattern, to assemble it and to multiply by it */
#define ASSEMBLY_ENTRY 15.0  /* ns an entry of W, to make its blocks and scale them */
#define ANALYSIS_ENTRY 150.0 /* ns an entry, for the two orders that base/lu.c tries */

/* A Newton step over its factorisation at 1 ns a multiplication: substitutions and refinement take
   half as much again. With 1 or with 2 here, more of 54 problems ended unsolved. */
#define STEP 1.5

double price_sweep(const struct problem *p)
{
    double n = (double)p->n;
    if (!p->W) return p->kind.ns * n;
    return (p->kind.ns + SWEEP_COMMON * p->W->common) * n + SWEEP_BLOCK * (double)p->W->first[p->n];
}

double price_newton_step(double multiplications, double entries)
{
    return STEP * (multiplications + ENTRY * entries);
}

double price_assembly(double entries)
{
    return ASSEMBLY_ENTRY * entries;
}

double price_analysis(double entries)
{
    return ANALYSIS_ENTRY * entries;
}
