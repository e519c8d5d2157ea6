/* scene/scene_bodies.c: groups of bodies from their JSON. */

#include "scene/scene_height.h"
#include "scene/scene_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int check_lattice(const jnode *o, int dim, const struct scene_bodies *b)
{
    jnode box = json_node_key(o, "box");
    for (int i = 0; i < dim; i++) {
        if (!isfinite(b->box.lo[i]) || (i < dim - 1 && !isfinite(b->box.hi[i])))
            return json_node_fault(box, "a lattice may be open above only, %s is not closed",
                                   axis_name[i]);
        if (!(b->box.hi[i] - b->box.lo[i] <= 1e9 * b->size.max || i == dim - 1))
            return json_node_fault(box, "too wide for bodies of %g m", b->size.max);
    }
    if (b->from == SCENE_SHELVES) return 0; // scene_build sees what fits
    struct scene_lattice l = scene_lattice(b, dim);
    double places = 1;
    for (int i = 0; i < dim; i++) {
        places *= l.cells[i];
        if (!(l.cells[i] >= 1))
            return json_node_fault(box, "%s is narrower than a cell, %g m", axis_name[i],
                                   2 * b->spacing * b->size.max);
    }
    if ((double)b->count <= places) return 0;
    return json_node_fault(
        json_node_key(o, "count"),
        "%lld bodies, but the box has cells for %.0f: they need a height of %.4g m "
        "along %s",
        (long long)b->count, places, scene_lattice_height(b, dim), axis_name[dim - 1]);
}

/* A group that fills the cell: its box is that of heights above the faces. */
static int fill_cell(jnode o, const struct scene_cell *of, struct scene_bodies *b)
{
    if (of->goes_on)
        return json_node_fault(o, "needs a box: the cell's edges come with a document");
    b->in_cell = true;
    cell_heights(&of->cell, b->box.hi);
    for (int k = 0; k < 3; k++) b->box.lo[k] = 0;
    return 0;
}

static int read_lattice(jnode o, const struct scene *s, bool boxed, struct scene_bodies *b)
{
    static const char *const cells[] = { "equal", "own", NULL };
    int own = 0;
    if (json_node_only(o,
                       "count radius size shape orientation box cells spacing jitter thermal v w "
                       "kind density mass fixed name") ||
        (!boxed && !s->cell.given && json_node_need(&o, "box")) ||
        json_node_integer(json_node_key(&o, "count"), 0, INT32_MAX, &b->count) ||
        scene_read_sizes(o, s, &b->form, &b->size) ||
        json_node_word(json_node_key(&o, "cells"), cells, &own) ||
        json_node_number(json_node_key(&o, "spacing"), J_ANY, &b->spacing) ||
        json_node_number(json_node_key(&o, "jitter"), J_UNIT, &b->jitter) ||
        json_node_number(json_node_key(&o, "thermal"), J_NOT_NEGATIVE, &b->thermal))
        return 1;
    if (!(b->spacing >= 1))
        return json_node_fault(json_node_key(&o, "spacing"), "must be at least 1");
    jnode box = json_node_key(&o, "box");
    if (box.json && scene_read_box(box, s->dim, &b->box)) return 1;
    if (own) b->from = SCENE_SHELVES;
    if (!box.json && s->cell.given && own && !s->cell.goes_on)
        return json_node_fault(o, "cells of their own need a box");
    if (!box.json && (s->cell.given || s->cell.goes_on) && fill_cell(o, &s->cell, b)) return 1;
    return check_lattice(&o, s->dim, b);
}

static int read_random(jnode o, const struct scene *s, bool boxed, struct scene_bodies *b)
{
    jnode how = json_node_key(&o, "random"), box = json_node_key(&o, "box");
    if (json_node_only(o, "random radius size shape orientation box thermal v w kind density mass "
                          "fixed name") ||
        (!boxed && !s->cell.given && json_node_need(&o, "box")) ||
        scene_read_sizes(o, s, &b->form, &b->size) ||
        json_node_number(json_node_key(&o, "thermal"), J_NOT_NEGATIVE, &b->thermal))
        return 1;
    int which = json_node_choice(how, "phi count");
    jnode phi = json_node_key(&how, "phi");
    if (which < 0 || json_node_only(how, "phi count") || json_node_number(phi, J_UNIT, &b->phi) ||
        json_node_integer(json_node_key(&how, "count"), 0, INT32_MAX, &b->count))
        return 1;
    if (box.json && scene_read_box(box, s->dim, &b->box)) return 1;
    if (!box.json && s->cell.given && fill_cell(o, &s->cell, b)) return 1;
    for (int i = 0; i < s->dim; i++) {
        double width = b->box.hi[i] - b->box.lo[i];
        if (!isfinite(width))
            return json_node_fault(box, "a random start needs a closed box, %s is open",
                                   axis_name[i]);
        if (!(width >= 2 * b->size.max))
            return json_node_fault(box, "%s is narrower than the largest grain, %g m", axis_name[i],
                                   2 * b->size.max);
    }
    return 0;
}

static int scene_bodies_read_document(jnode o, struct scene_bodies *b)
{
    const char *name = NULL;
    if (json_node_only(o, "document frame at_rest v w kind density mass fixed name") ||
        json_node_text(json_node_key(&o, "document"), &name) ||
        json_node_integer(json_node_key(&o, "frame"), -1000000000, 1000000000, &b->frame) ||
        json_node_bool(json_node_key(&o, "at_rest"), &b->at_rest))
        return 1;
    b->file = strdup(name);
    return b->file ? 0 : failure_set(o.in->failure, EX_SOFTWARE, "no memory for a file name");
}

/* "types": which kind each type of the file is */
static int read_types(jnode o, const struct scene *s, struct scene_bodies *b)
{
    const char *name;
    json_t *value;
    if (!o.json) return 0;
    if (!json_is_object(o.json)) return json_node_fault(o, "needs an object {\"1\": NAME, ...}");
    if (!(b->type = scene_alloc(o, json_object_size(o.json), sizeof *b->type))) return 1;
    json_object_foreach(o.json, name, value)
    {
        jnode n = json_node_key(&o, name);
        if (!strcmp(name, "comment")) continue;
        if (!*name || strspn(name, "0123456789") != strlen(name))
            return json_node_fault(n, "types are whole numbers");
        if (scene_read_kind(n, s, &b->type[b->types].kind)) return 1;
        if (!(b->type[b->types++].name = strdup(name)))
            return failure_set(o.in->failure, EX_SOFTWARE, "no memory for the types of a file");
    }
    return 0;
}

static int scene_bodies_read_repeats(jnode o, int dim, struct scene_bodies *b)
{
    size_t n;
    if (!o.json) return 0;
    if (json_node_array(o, &n)) return 1;
    if (n != (size_t)dim) return json_node_fault(o, "needs %d of true and false", dim);
    b->has_repeats = true;
    for (size_t k = 0; k < n; k++)
        if (json_node_bool(json_node_item(&o, k), &b->repeats[k])) return 1;
    return 0;
}

static int read_import(jnode o, const struct scene *s, struct scene_bodies *b)
{
    const char *name = NULL;
    if (json_node_only(o, "import frame at_rest types repeats v w kind density mass fixed name") ||
        json_node_text(json_node_key(&o, "import"), &name) ||
        json_node_integer(json_node_key(&o, "frame"), -1000000000, 1000000000, &b->frame) ||
        json_node_bool(json_node_key(&o, "at_rest"), &b->at_rest) ||
        read_types(json_node_key(&o, "types"), s, b) ||
        scene_bodies_read_repeats(json_node_key(&o, "repeats"), s->dim, b))
        return 1;
    b->foreign = true, b->file = strdup(name);
    return b->file ? 0 : failure_set(o.in->failure, EX_SOFTWARE, "no memory for a file name");
}

static int read_one(jnode o, const struct scene *s, struct scene_bodies *b)
{
    b->count = 1;
    jnode radius = json_node_key(&o, "radius"), size = json_node_key(&o, "size");
    if (json_node_only(o, "x radius size shape orientation v w kind density mass fixed name") ||
        json_node_vector(json_node_key(&o, "x"), s->dim, &b->x))
        return 1;
    if (radius.json && size.json) return json_node_fault(size, "a radius is given too");
    if (!b->form.shape && json_node_need(&o, "radius")) return 1;
    b->size.min = 1;
    if (json_node_number(radius.json ? radius : size, J_POSITIVE, &b->size.min)) return 1;
    if (!radius.json) b->size.min *= s->solid[b->form.shape].reach;
    b->size.max = b->size.min;
    return 0;
}

static int scene_bodies_read_table(jnode o, struct scene_bodies *b)
{
    const char *name = NULL;
    if (json_node_only(o, "file v w kind density mass fixed name") ||
        json_node_text(json_node_key(&o, "file"), &name))
        return 1;
    b->file = strdup(name);
    return b->file ? 0 : failure_set(o.in->failure, EX_SOFTWARE, "no memory for a file name");
}

int scene_read_spin(jnode n, int dim, vec3 *w)
{
    return dim == 2 ? json_node_number(n, J_ANY, &w->z) : json_node_vector(n, 3, w);
}

int scene_read_mass(const jnode *o, double *density, double *mass)
{
    jnode m = json_node_key(o, "mass"), d = json_node_key(o, "density");
    if (m.json && d.json) return json_node_fault(m, "density is given too");
    return json_node_number(d, J_POSITIVE, density) || json_node_number(m, J_POSITIVE, mass);
}

/* What the bodies of a group have in common */
static int read_common(jnode o, struct scene *s, struct scene_bodies *b)
{
    if (scene_read_group(json_node_key(&o, "name"), s, &b->group) ||
        json_node_vector(json_node_key(&o, "v"), s->dim, &b->v) ||
        scene_read_spin(json_node_key(&o, "w"), s->dim, &b->w) ||
        scene_read_kind(json_node_key(&o, "kind"), s, &b->kind))
        return 1;
    b->density = s->kind[b->kind].density;
    b->has_v = json_node_key(&o, "v").json, b->has_w = json_node_key(&o, "w").json;
    b->has_kind = json_node_key(&o, "kind").json, b->has_fixed = json_node_key(&o, "fixed").json;
    b->has_density = json_node_key(&o, "density").json;
    return scene_read_mass(&o, &b->density, &b->mass) ||
           json_node_bool(json_node_key(&o, "fixed"), &b->fixed);
}

static int read_group(jnode o, struct scene *s, const struct scene_box *box, struct scene_bodies *b)
{
    static const enum scene_source from[] = { SCENE_ONE,      SCENE_LATTICE, SCENE_TABLE,
                                              SCENE_DOCUMENT, SCENE_RANDOM,  SCENE_DOCUMENT };
    *b = (struct scene_bodies){ .spacing = 1.05, .jitter = 1, .frame = -1, .form = { .fill = 1 } };
    if (box) b->box = *box;
    int which = json_node_choice(o, "x count file document random import");
    if (which < 0) return 1;
    b->from = from[which];
    if (from[which] != SCENE_TABLE && from[which] != SCENE_DOCUMENT &&
        scene_read_form(o, s, &b->form))
        return 1;
    int bad = which == 0   ? read_one(o, s, b)
              : which == 1 ? read_lattice(o, s, box, b)
              : which == 2 ? scene_bodies_read_table(o, b)
              : which == 3 ? scene_bodies_read_document(o, b)
              : which == 5 ? read_import(o, s, b)
                           : read_random(o, s, box, b);
    return bad || read_common(o, s, b);
}

int scene_read_bodies(jnode a, struct scene *s, const struct scene_box *box)
{
    size_t n;
    int64_t total = 0;
    if (json_node_array(a, &n) || !(s->bodies = scene_alloc(a, n, sizeof *s->bodies))) return 1;
    for (size_t i = 0; i < n; i++) {
        jnode group = json_node_item(&a, i);
        s->groups++;
        if (read_group(group, s, box, &s->bodies[i])) return 1;
        total += s->bodies[i].count;
        if (total > INT32_MAX) return json_node_fault(group, "more than %d bodies", INT32_MAX);
    }
    return 0;
}

/* A SIZE from its JSON. */

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
    bool enough = z->spread > 0 ? scene_bodies_normal_below(to / z->spread) -
                                          scene_bodies_normal_below(from / z->spread) >
                                      1e-3
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
