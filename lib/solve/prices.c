/* prices.c: see solve/prices.h. */
#include "solve/prices.h"

/* ns a contact and sweep, of balls [bench/results: 6 to 15] */
#define SWEEP_CONTACT 10.0
/* The same where W is given: a contact, and each of its blocks beside the diagonal */
#define SWEEP_CONTACT_W 30.0
#define SWEEP_BLOCK     2.0

/* ns an entry of the pattern, to assemble it and to multiply by it */
#define ENTRY 14.0
/* Of a step's multiplications and entries, 1 ns each: substitutions and refinement are half as much again.
   With none of that, or twice as much, more of 54 problems ended unsolved. */
#define STEP 1.5

/* ns an entry of W, to make its blocks and scale them */
#define ASSEMBLY_ENTRY 15.0

/* ns an entry, for the two orders of the unknowns that are tried (base/lu.c) */
#define ANALYSIS_ENTRY 150.0

double price_sweep(const struct problem *p)
{
    double n = (double)p->n;
    if (!p->W) return SWEEP_CONTACT * n;
    return SWEEP_CONTACT_W * n + SWEEP_BLOCK * (double)p->W->first[p->n];
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
