/* measure/histogram.h: how numbers are distributed, by GSL's histograms. */
#ifndef NSD_HISTOGRAM_H
#define NSD_HISTOGRAM_H

#include "measure/table.h"

/* The quantities of a distribution of numbers called "from" and "to" with this unit */
#define HISTOGRAM_QUANTITIES(unit, what)                                                           \
    { "from", unit, 1, "lower end of the bin, " what }, { "to", unit, 1, "upper end of the bin" }, \
        { "contacts", "1", 1, "number of contacts in the bin" },                                   \
    {                                                                                              \
        "density", "1", 1, "probability density: its integral is 1"                                \
    }

/* A row for each of `bins` bins of the same width from 0 to `most`, which is in the last.
   Returns 0 or EX_SOFTWARE. */
int histogram_rows(struct table *t, const double *x, int64_t n, double most, int64_t bins,
                   struct failure *failure);

#endif
