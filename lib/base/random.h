/* base/random.h: a generator of random numbers of GSL, whose own gsl_rng_alloc() ends the program where memory is short. */
#ifndef NSD_RANDOM_H
#define NSD_RANDOM_H

#include <gsl/gsl_rng.h>

/* Not seeded; gsl_rng_free() frees it. NULL: no memory */
gsl_rng *random_alloc(const gsl_rng_type *type);

#endif
