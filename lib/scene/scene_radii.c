/* scene/scene_radii.c: a SIZE from its JSON. */
#include "scene/scene_read.h"

#include <math.h>

enum { MOST_EXPONENT = 20 };           /* of a power law */
static const double MOST_RATIO = 1e6;  /* of radii of one law: no more is meant */
static const double MOST_SIZE = 1e100; /* m: its volume is a number */

static int read_uniform(jnode a, struct scene_size *z)
{
    size_t n;
    if (json_node_array(a, &n)) return 1;
    if (n != 2) return json_node_fault(a, "needs [min, max]");
    if (json_node_number(json_node_item(&a, 0), J_POSITIVE, &z->min) ||
        json_node_number(json_node_item(&a, 1), J_POSITIVE, &z->max))
        return 1;
    return z->min <= z->max ? 0 : json_node_fault(a, "max is less than min");
}

/* Probability that a standard normal deviate is below z */
static double scene_bodies_normal_below(double z)
{
    return 0.5 * erfc(-z * M_SQRT1_2);
}

/* A gaussian or lognormal distribution cut to [min, max], which must hold 1e-3 of it at least:
   radii are drawn again until they lie in it. */
static int read_bell(jnode o, struct scene_size *z)
{
    bool gauss = z->law == SIZE_GAUSSIAN;
    const char *mid = gauss ? "mean" : "median", *spread = gauss ? "sd" : "sigma";
    if (json_node_only(o, gauss ? "mean sd min max" : "median sigma min max") ||
        json_node_need(&o, gauss ? "mean sd min max" : "median sigma min max") ||
        json_node_number(json_node_key(&o, mid), gauss ? J_ANY : J_POSITIVE, &z->mid) ||
        json_node_number(json_node_key(&o, spread), J_NOT_NEGATIVE, &z->spread) ||
        json_node_number(json_node_key(&o, "min"), J_POSITIVE, &z->min) ||
        json_node_number(json_node_key(&o, "max"), J_POSITIVE, &z->max))
        return 1;
    if (z->min > z->max) return json_node_fault(json_node_key(&o, "max"), "is less than min");
    double from = gauss ? z->min - z->mid : log(z->min / z->mid);
    double to = gauss ? z->max - z->mid : log(z->max / z->mid);
    bool enough = z->spread > 0
                      ? scene_bodies_normal_below(to / z->spread) - scene_bodies_normal_below(from / z->spread) > 1e-3
                      : from <= 0 && to >= 0;
    return enough ? 0 : json_node_fault(o, "[min, max] keeps less than a thousandth of it");
}

static int read_power(jnode o, struct scene_size *z)
{
    if (json_node_only(o, "exponent min max") || json_node_need(&o, "exponent min max") ||
        json_node_number(json_node_key(&o, "exponent"), J_ANY, &z->exponent) ||
        json_node_number(json_node_key(&o, "min"), J_POSITIVE, &z->min) ||
        json_node_number(json_node_key(&o, "max"), J_POSITIVE, &z->max))
        return 1;
    if (!(fabs(z->exponent) <= MOST_EXPONENT))
        return json_node_fault(json_node_key(&o, "exponent"), "must lie in [-%d, %d]",
                               MOST_EXPONENT, MOST_EXPONENT);
    if (z->min > z->max) return json_node_fault(json_node_key(&o, "max"), "is less than min");
    return z->max <= MOST_RATIO * z->min
               ? 0
               : json_node_fault(o, "max is more than %g min", MOST_RATIO);
}

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
static double scene_bodies_number_of(double share, double a, double b, int dim)
{
    double x = log(b / a) * dim;
    return x > 0 ? share * expm1(x) / x : share;
}

static int read_sieve(jnode a, int dim, struct scene_size *z)
{
    size_t n;
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
        double grains = scene_bodies_number_of(passing[1] - passing[0], size[0], size[1], dim);
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

static int scene_bodies_read_law(jnode n, int dim, struct scene_size *z)
{
    static const char laws[] = "uniform gaussian lognormal uniform_by_mass power sieve";
    if (!json_is_object(n.json)) {
        int bad = json_node_number(n, J_POSITIVE, &z->min);
        z->max = z->min;
        return bad;
    }
    int which = json_node_choice(n, laws);
    if (which < 0 || json_node_only(n, laws)) return 1;
    switch (which) {
    case 0:
        return read_uniform(json_node_key(&n, "uniform"), z);
    case 1:
        z->law = SIZE_GAUSSIAN;
        return read_bell(json_node_key(&n, "gaussian"), z);
    case 2:
        z->law = SIZE_LOGNORMAL;
        return read_bell(json_node_key(&n, "lognormal"), z);
    case 3: // as much mass between r and r + dr wherever r is
        z->law = SIZE_POWER, z->exponent = dim;
        return read_uniform(json_node_key(&n, "uniform_by_mass"), z);
    case 4:
        z->law = SIZE_POWER;
        return read_power(json_node_key(&n, "power"), z);
    default:
        z->law = SIZE_SIEVE;
        return read_sieve(json_node_key(&n, "sieve"), dim, z);
    }
}

int scene_read_size(jnode n, int dim, struct scene_size *z)
{
    if (!n.json) return 0;
    if (scene_bodies_read_law(n, dim, z)) return 1;
    return z->max <= MOST_SIZE ? 0 : json_node_fault(n, "above %g: too large", MOST_SIZE);
}
