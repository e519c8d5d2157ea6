#include "base/random.h"

#include <stdlib.h>

gsl_rng *random_alloc(const gsl_rng_type *type)
{
    gsl_rng *rng = malloc(sizeof *rng);
    void *state = calloc(1, type->size);
    if (rng && state) {
        *rng = (gsl_rng){ .type = type, .state = state };
        gsl_rng_set(rng, gsl_rng_default_seed);
        return rng;
    }
    free(rng), free(state);
    return NULL;
}
