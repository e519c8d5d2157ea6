#include "measure/histogram.h"

#include <gsl/gsl_histogram.h>
#include <math.h>
#include <stdlib.h>

int histogram_rows(struct table *t, const double *x, int64_t n, double most, int64_t bins,
                   struct failure *failure)
{
    // GSL's own allocation ends the program when memory is short
    gsl_histogram h = { (size_t)bins, calloc((size_t)bins + 1, sizeof(double)),
                        calloc((size_t)bins + 1, sizeof(double)) };
    if (!h.range || !h.bin) {
        free(h.range), free(h.bin);
        return failure_set(failure, EX_SOFTWARE, "no memory for a histogram");
    }
    gsl_histogram_set_ranges_uniform(&h, 0, most);
    // the largest number belongs to the last bin, whose end GSL does not count to it
    h.range[bins] = nextafter(most, INFINITY);
    for (int64_t i = 0; i < n; i++) gsl_histogram_increment(&h, x[i]);
    for (int64_t k = 0; k < bins; k++) {
        double from = h.range[k], to = k + 1 == bins ? most : h.range[k + 1];
        double *at = table_row(t, failure);
        if (!at) break;
        put(&at, from), put(&at, to), put(&at, h.bin[k]);
        put(&at, h.bin[k] / (double)n / (to - from));
    }
    free(h.range), free(h.bin);
    return failure->status;
}
