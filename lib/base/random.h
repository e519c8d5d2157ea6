/* base/random.h: a generator of random numbers of GSL, whose own gsl_rng_alloc() ends the program where memory is short. */
#pragma once

#include <gsl/gsl_rng.h>
#include <stdint.h>

/* Not seeded; gsl_rng_free() frees it. NULL: no memory */
gsl_rng *random_alloc(const gsl_rng_type *type);

/*
 * Random numbers that are functions of what they are for: those of the n-th grain
 * of a pour come from the seed, the pour and n alone, however many steps, runs and threads lie
 * between. Number k of a stream is the finalizer of SplitMix64 on key + k g, g the golden ratio's
 * bits (Steele, Lea & Flood, Fast splittable pseudorandom number generators, OOPSLA 2014).
 *
 * A stream is a generator of GSL, so that one text draws from it and from the Mersenne twister.
 */

/* What a stream is for: each use of the seed has its own numbers. */
enum counter_use {
    COUNTER_GROUP,
    COUNTER_GRAIN,
    COUNTER_PLACE,
    COUNTER_TURN,
    COUNTER_FRACTURE,
    COUNTER_STRENGTH
};

/* [0, 1): the first number of the stream of these numbers, without a generator */
double counter_uniform(uint64_t seed, enum counter_use use, uint64_t a, uint64_t b, uint64_t c);

/* A generator, NULL when memory is short; to be freed by gsl_rng_free. */
gsl_rng *counter_alloc(void);
/* On to the beginning of the stream that belongs to this use and these numbers. */
void counter_start(gsl_rng *rng, uint64_t seed, enum counter_use use, uint64_t a, uint64_t b,
                   uint64_t c);
