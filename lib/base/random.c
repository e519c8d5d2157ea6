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

struct state {
    uint64_t at; /* key + k g */
};

static const uint64_t golden = 0x9e3779b97f4a7c15;

/* The finalizer of SplitMix64, Stafford's variant 13 */
static uint64_t random_mix(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
}

static uint64_t random_next(struct state *s)
{
    s->at += golden;
    return random_mix(s->at);
}

static void random_set(void *state, unsigned long seed)
{
    ((struct state *)state)->at = random_mix(seed + golden);
}

static unsigned long get(void *state)
{
    return (unsigned long)(random_next(state) >> 32);
}

/* [0, 1), of 53 bits */
static double get_double(void *state)
{
    return (double)(random_next(state) >> 11) * 0x1p-53;
}

static const gsl_rng_type type = { "counter",  0xffffffff, 0,         sizeof(struct state),
                                   random_set, get,        get_double };

gsl_rng *counter_alloc(void)
{
    return random_alloc(&type);
}

static uint64_t counter_key(uint64_t seed, enum counter_use use, uint64_t a, uint64_t b, uint64_t c)
{
    const uint64_t word[] = { seed, (uint64_t)use, a, b, c };
    uint64_t key = 0;
    for (int k = 0; k < 5; k++) key = random_mix((key ^ random_mix(word[k] + golden)) + golden);
    return key;
}

double counter_uniform(uint64_t seed, enum counter_use use, uint64_t a, uint64_t b, uint64_t c)
{
    struct state s = { counter_key(seed, use, a, b, c) };
    return get_double(&s);
}

void counter_start(gsl_rng *rng, uint64_t seed, enum counter_use use, uint64_t a, uint64_t b,
                   uint64_t c)
{
    ((struct state *)rng->state)->at = counter_key(seed, use, a, b, c);
}
