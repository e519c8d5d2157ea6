/* measure/histogram.h: how numbers are distributed, by GSL's histograms. */
#ifndef NSD_HISTOGRAM_H
#define NSD_HISTOGRAM_H

#include "measure/table.h"

/* The quantities of a distribution of numbers called "from" and "to" with this unit */
#define HISTOGRAM_QUANTITIES(unit, what)                                                           \
    { "from", unit, 1, "where the bin begins, " what }, { "to", unit, 1, "where it ends" },        \
        { "contacts", "1", 1, "in the bin" },                                                      \
    {                                                                                              \
        "density", "1", 1, "of probability: it integrates to 1"                                    \
    }

/* A row for each of `bins` bins of the same width from 0 to `most`, which is in the last.
   Returns 0 or EX_SOFTWARE. */
int histogram_rows(struct table *t, const double *x, int64_t n, double most, int64_t bins,
                   struct why *why);

#endif
