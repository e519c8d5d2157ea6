/* scene/scene_bodies.c: groups of bodies from their JSON. */
#include "scene/scene_read.h"

#include <stdlib.h>
#include <string.h>

static int read_uniform(jnode a, struct scene_size *z)
{
    size_t n;
    if (json_node_array(a, &n)) return 1;
    if (n != 2) return json_node_fault(a, "wants [min, max]");
    if (json_node_number(json_node_item(&a, 0), J_POSITIVE, &z->min) ||
        json_node_number(json_node_item(&a, 1), J_POSITIVE, &z->max))
        return 1;
    return z->min <= z->max ? 0 : json_node_fault(a, "max is less than min");
}

/* Probability that a standard normal deviate is below z */
static double normal_below(double z)
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
                      ? normal_below(to / z->spread) - normal_below(from / z->spread) > 1e-3
                      : from <= 0 && to >= 0;
    return enough ? 0 : json_node_fault(o, "[min, max] keeps less than a thousandth of it");
}

static int read_size(jnode n, struct scene_size *z)
{
    if (!json_is_object(n.json)) {
        int bad = json_node_number(n, J_POSITIVE, &z->min);
        z->max = z->min;
        return bad;
    }
    int which = json_node_choice(n, "uniform gaussian lognormal");
    if (which < 0 || json_node_only(n, "uniform gaussian lognormal")) return 1;
    z->law = which == 0 ? SIZE_UNIFORM : which == 1 ? SIZE_GAUSSIAN : SIZE_LOGNORMAL;
    if (which == 0) return read_uniform(json_node_key(&n, "uniform"), z);
    return read_bell(json_node_key(&n, which == 1 ? "gaussian" : "lognormal"), z);
}

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
    struct scene_lattice l = scene_lattice(b, dim);
    double places = 1;
    for (int i = 0; i < dim; i++) {
        places *= l.cells[i];
        if (!(l.cells[i] >= 1))
            return json_node_fault(box, "%s is narrower than a cell, %g m", axis_name[i],
                                   2 * b->spacing * b->size.max);
    }
    if ((double)b->count <= places) return 0;
    return json_node_fault(json_node_key(o, "count"), "%lld bodies, but the box has cells for %.0f",
                           (long long)b->count, places);
}

static int read_lattice(jnode o, const struct scene *s, bool boxed, struct scene_bodies *b)
{
    if (json_node_only(o, "count radius box spacing jitter thermal v w kind density mass fixed") ||
        json_node_need(&o, boxed || s->cell.given ? "radius" : "radius box") ||
        json_node_integer(json_node_key(&o, "count"), 0, INT32_MAX, &b->count) ||
        read_size(json_node_key(&o, "radius"), &b->size) ||
        json_node_number(json_node_key(&o, "spacing"), J_ANY, &b->spacing) ||
        json_node_number(json_node_key(&o, "jitter"), J_UNIT, &b->jitter) ||
        json_node_number(json_node_key(&o, "thermal"), J_NOT_NEGATIVE, &b->thermal))
        return 1;
    if (!(b->spacing >= 1))
        return json_node_fault(json_node_key(&o, "spacing"), "must be at least 1");
    jnode box = json_node_key(&o, "box");
    if (box.json && scene_read_box(box, s->dim, &b->box)) return 1;
    if (!box.json && s->cell.given) {
        b->in_cell = true;
        cell_heights(&s->cell.cell, b->box.hi);
        for (int k = 0; k < 3; k++) b->box.lo[k] = 0;
    }
    return check_lattice(&o, s->dim, b);
}

static int read_one(jnode o, int dim, struct scene_bodies *b)
{
    b->count = 1;
    if (json_node_only(o, "x radius v w kind density mass fixed") || json_node_need(&o, "radius") ||
        json_node_vector(json_node_key(&o, "x"), dim, &b->x) ||
        json_node_number(json_node_key(&o, "radius"), J_POSITIVE, &b->size.min))
        return 1;
    b->size.max = b->size.min;
    return 0;
}

static int read_table(jnode o, struct scene_bodies *b)
{
    const char *name = NULL;
    if (json_node_only(o, "file v w kind density mass fixed") ||
        json_node_text(json_node_key(&o, "file"), &name))
        return 1;
    b->file = strdup(name);
    return b->file ? 0 : why_set(o.in->why, EX_SOFTWARE, "no memory for a file name");
}

static int read_spin(jnode n, int dim, vec3 *w)
{
    return dim == 2 ? json_node_number(n, J_ANY, &w->z) : json_node_vector(n, 3, w);
}

/* What the bodies of a group have in common */
static int read_common(jnode o, const struct scene *s, struct scene_bodies *b)
{
    if (json_node_vector(json_node_key(&o, "v"), s->dim, &b->v) ||
        read_spin(json_node_key(&o, "w"), s->dim, &b->w) ||
        scene_read_kind(json_node_key(&o, "kind"), s, &b->kind))
        return 1;
    b->density = s->kind[b->kind].density;
    jnode mass = json_node_key(&o, "mass"), density = json_node_key(&o, "density");
    if (mass.json && density.json) return json_node_fault(mass, "density is given too");
    return json_node_number(density, J_POSITIVE, &b->density) ||
           json_node_number(mass, J_POSITIVE, &b->mass) ||
           json_node_bool(json_node_key(&o, "fixed"), &b->fixed);
}

static int read_group(jnode o, const struct scene *s, const struct scene_box *box,
                      struct scene_bodies *b)
{
    *b = (struct scene_bodies){ .spacing = 1.05, .jitter = 1 };
    if (box) b->box = *box;
    int which = json_node_choice(o, "x count file");
    if (which < 0) return 1;
    b->from = which == 0 ? SCENE_ONE : which == 1 ? SCENE_LATTICE : SCENE_TABLE;
    int bad = which == 0   ? read_one(o, s->dim, b)
              : which == 1 ? read_lattice(o, s, box, b)
                           : read_table(o, b);
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
