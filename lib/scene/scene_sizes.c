/* scene/scene_sizes.c: a SIZE from its JSON. */
#include "scene/scene_read.h"

#include <math.h>

#define AT(member) offsetof(struct scene_size, member)

enum { MOST_EXPONENT = 20 };           /* of a power law */
static const double MOST_RATIO = 1e6;  /* of radii of one law: no more is meant */
static const double MOST_SIZE = 1e100; /* m: its volume is a number */

/* Probability that a standard normal deviate is below z */
static double scene_sizes_normal_below(double z)
{
    return 0.5 * erfc(-z * M_SQRT1_2);
}

/* A gaussian or lognormal distribution cut to [min, max], which must hold 1e-3 of it at least:
   radii are drawn again until they lie in it. */
static int finish_bell(jnode o, struct scene_size *z)
{
    const bool gauss = z->law == SIZE_GAUSSIAN;
    if (z->min > z->max) return json_node_fault(json_node_key(&o, "max"), "is less than min");
    double from = gauss ? z->min - z->mid : log(z->min / z->mid);
    double to = gauss ? z->max - z->mid : log(z->max / z->mid);
    bool enough = z->spread > 0 ? scene_sizes_normal_below(to / z->spread) -
                                          scene_sizes_normal_below(from / z->spread) >
                                      1e-3
                                : from <= 0 && to >= 0;
    return enough ? 0 : json_node_fault(o, "[min, max] keeps less than a thousandth of it");
}

#define MIN "min", &key_positive, AT(min), "m", REQUIRED, "1e-3", "Smallest radius."
#define MAX "max", &key_positive, AT(max), "m", REQUIRED, "2e-3", "Largest radius."

static const struct key gaussian_key[] = {
    { "mean", &key_number, AT(mid), "m", REQUIRED, "1.5e-3", "Mean." },
    { "sd", &key_not_negative, AT(spread), "m", REQUIRED, "2e-4", "Standard deviation." },
    { MIN },
    { MAX },
    { 0 },
};

static int finish_gaussian(jnode o, struct scene *s, void *out)
{
    struct scene_size *z = out;
    (void)s;
    z->law = SIZE_GAUSSIAN;
    return finish_bell(o, z);
}

static const struct keys gaussian_keys = { "gaussian", gaussian_key, .finish = finish_gaussian };

static const struct key lognormal_key[] = {
    { "median", &key_positive, AT(mid), "m", REQUIRED, "1.5e-3", "Median." },
    { "sigma", &key_not_negative, AT(spread), "-", REQUIRED, "0.2",
      "Standard deviation of the logarithm." },
    { MIN },
    { MAX },
    { 0 },
};

static int finish_lognormal(jnode o, struct scene *s, void *out)
{
    struct scene_size *z = out;
    (void)s;
    z->law = SIZE_LOGNORMAL;
    return finish_bell(o, z);
}

static const struct keys lognormal_keys = { "lognormal", lognormal_key,
                                            .finish = finish_lognormal };

static const struct key power_key[] = {
    { "exponent", &key_number, AT(exponent), "-", REQUIRED, "3",
      "The density by number is proportional to r^-exponent; -20 to 20.", .least = -MOST_EXPONENT,
      .most = MOST_EXPONENT },
    { MIN },
    { MAX },
    { 0 },
};

static int finish_power(jnode o, struct scene *s, void *out)
{
    struct scene_size *z = out;
    (void)s;
    z->law = SIZE_POWER;
    if (z->min > z->max) return json_node_fault(json_node_key(&o, "max"), "is less than min");
    return z->max <= MOST_RATIO * z->min
               ? 0
               : json_node_fault(o, "max is more than %g min", MOST_RATIO);
}

static const struct keys power_keys = { "power", power_key, .finish = finish_power };

/* [size, passing] */
static int read_point(jnode point, double *size, double *passing)
{
    size_t n;
    if (json_node_array(point, &n)) return 1;
    if (n != 2) return json_node_fault(point, "needs [size, passing]");
    return json_node_number(json_node_item(&point, 0), J_POSITIVE, size) ||
           json_node_number(json_node_item(&point, 1), J_UNIT, passing);
}

/* How many grains a share of the mass between the diameters a and b is, times a constant: its
   integral of d^-dim over log d. In units of b^dim, so that nothing overflows. */
static double scene_sizes_number_of(double share, double a, double b, int dim)
{
    double x = log(b / a) * dim;
    return x > 0 ? share * expm1(x) / x : share;
}

static int read_sieve(jnode a, struct scene *s, void *out)
{
    struct scene_size *z = out;
    const int dim = s->dim;
    size_t n;
    z->law = SIZE_SIEVE;
    double size[2] = { 0 }, passing[2] = { 0 };
    if (json_node_array(a, &n)) return 1;
    if (n < 2) return json_node_fault(a, "needs two points [size, passing] or more");
    if (!(z->sieve = scene_alloc(a, n - 1, sizeof *z->sieve))) return 1;
    z->dim = dim, z->segments = (int64_t)n - 1;
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        jnode point = json_node_item(&a, i);
        size[0] = size[1], passing[0] = passing[1];
        if (read_point(point, &size[1], &passing[1])) return 1;
        if (!i && passing[1] > 0)
            return json_node_fault(point,
                                   "the first sieve, of the smallest grains, must let nothing "
                                   "pass: put [SIZE, 0] in front of it");
        if (!i) z->min = 0.5 * size[1];
        if (!i) continue;
        if (size[1] < size[0] || passing[1] < passing[0])
            return json_node_fault(point, "sizes and shares must not fall");
        if (size[1] > 2 * MOST_RATIO * z->min)
            return json_node_fault(point, "more than %g times the first", MOST_RATIO);
        double grains = scene_sizes_number_of(passing[1] - passing[0], size[0], size[1], dim);
        sum += grains * pow(2 * z->min / size[1], dim);
        z->sieve[i - 1] = (struct scene_sieve){ 0.5 * size[0], 0.5 * size[1], sum };
    }
    z->max = 0.5 * size[1];
    if (passing[1] != 1)
        return json_node_fault(a,
                               "the last sieve, of the largest grains, must let everything pass: "
                               "put [SIZE, 1] behind it");
    for (int64_t k = 0; k < z->segments; k++) z->sieve[k].below /= sum;
    return 0;
}

static const struct key_type key_sieve = { "array of pairs", "{'$ref': 'sieve'}", NULL, NULL };

static const struct key size_key[] = {
    { "uniform", &key_min_max, AT(min), "m", "-", "[1e-3, 2e-3]",
      "Any radius in [min, max] is as likely.", .choice = 1 },
    { "gaussian", &key_object, 0, "m", "-", "{\"mean\": 1, ...}",
      "Radii are drawn again until they lie in [min, max].", .choice = 1,
      .object = &gaussian_keys },
    { "lognormal", &key_object, 0, "m, 1", "-", "{\"median\": 1, ...}",
      "The same of the logarithm.", .choice = 1, .object = &lognormal_keys },
    { "uniform_by_mass", &key_min_max, AT(min), "m", "-", "[1e-3, 4e-3]",
      "Equal mass per unit of radius over [min, max].", .choice = 1 },
    { "power", &key_object, 0, "1, m", "-", "{\"exponent\": 3, ...}", "A power law.", .choice = 1,
      .object = &power_keys },
    { "sieve", &key_sieve, 0, "m, 1", "-", "[[1e-3, 0], ...]",
      "Pairs [aperture, passing], the fraction of the mass, from 0 to 1, that passes a sieve of "
      "this aperture, a diameter in m.",
      .choice = 1, .read = read_sieve },
    { 0 },
};
_Static_assert(AT(max) == AT(min) + sizeof(double), "[min, max] is read into both");

static int finish_size(jnode o, struct scene *s, void *out)
{
    struct scene_size *z = out;
    const bool by_mass = keys_has(&o, "uniform_by_mass");
    if (by_mass) z->law = SIZE_POWER, z->exponent = s->dim;
    if (z->min <= z->max) return 0;
    return json_node_fault(json_node_key(&o, by_mass ? "uniform_by_mass" : "uniform"),
                           "max is less than min");
}

static const struct keys size_keys = { "size", size_key, .finish = finish_size };

static int scene_sizes_read_size(jnode n, const struct key *k, struct scene *s, void *member)
{
    struct scene_size *z = member;
    (void)k;
    if (json_is_object(n.json)) {
        if (keys_read(n, &size_keys, s, z)) return 1;
    } else {
        if (json_node_number(n, J_POSITIVE, &z->min)) return 1;
        z->max = z->min;
    }
    return z->max <= MOST_SIZE ? 0 : json_node_fault(n, "above %g: too large", MOST_SIZE);
}

const struct key_type key_size = {
    "SIZE", "{'anyOf': [{'type': 'number', 'exclusiveMinimum': 0}, {'$ref': 'size'}]}",
    scene_sizes_read_size, NULL, &size_keys
};
