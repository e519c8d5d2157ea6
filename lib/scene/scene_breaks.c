/* scene/scene_breaks.c: how the grains of a material break, from its JSON, and whether they can [state/breakage.h]. */
#include "scene/scene_breaks.h"

#include "scene/scene_read.h"
#include "shape/fracture.h"
#include "state/breakable.h"

#include <stdlib.h>
#include <string.h>

#define AT(member) offsetof(struct breakage, member)

static const char *const criteria[] = { "force", "stress", "shear", "energy", NULL };
static const char *const damages[] = { "none", "linear", "tavares", NULL };
static const char *const intos[] = { "pieces", "balls", NULL };

static const struct key breaks_key[] = {
    { "by", &key_word, AT(by), "-", REQUIRED, "\"force\"",
      "Quantity compared with the strength: force, the largest force of a neighbour over the "
      "square "
      "of the "
      "diameter (2D: over the diameter times 1 m); stress, the mean stress in the grain; shear, "
      "its octahedral "
      "shear stress; energy, the energy of an impact over the mass.",
      .words = criteria },
    { "strength", &key_positive, AT(strength), "Pa, J/kg", REQUIRED, "2e7",
      "Strength of a grain of the given size; with a modulus the value below which 63 % of the "
      "grains break." },
    { "size", &key_positive, AT(size), "m", "none", "1e-3",
      "Diameter for which the strength is given. Without it strength does not depend on size.",
      .needed = "exponent" },
    { "modulus", &key_positive, AT(modulus), "-", "none", "3",
      "Weibull modulus m of the strengths of grains of one size. Without it all have the same." },
    { "exponent", &key_number, AT(exponent), "-", "3/modulus", "1",
      "Strength is proportional to the diameter to the power of minus this. Default: 3/modulus "
      "with a size, in "
      "2D 2/modulus; 0 without a modulus." },
    { "least", &key_not_negative, AT(least), "J/kg", "0", "0.5",
      "Energy per mass below which an impact does no damage, of grains of the given size." },
    { "damage", &key_word, AT(damage), "-", "\"none\"", "\"linear\"",
      "Whether impacts add up: none; linear, the energies beyond least; tavares, each reduces the "
      "energy that "
      "breaks the grain, see nsd-methods(7).",
      .words = damages },
    { "gamma", &key_positive, AT(gamma), "-", "5", "5", "Exponent of the damage of tavares." },
    { "smallest", &key_positive, AT(smallest), "m", REQUIRED, "1e-4",
      "Smaller grains do not break: the diameter of the ball of the volume of the grain." },
    { "into", &key_word, AT(into), "-", "\"pieces\"", "\"balls\"",
      "pieces: sharp polyhedra, cut by a Voronoi tessellation, a ball after it has become a "
      "polyhedron of 80 faces "
      "(2D: 24 sides); balls: a ball becomes 13 (2D: 7) of a third of its radius. The rest of the "
      "mass is dust.",
      .words = intos },
    { "pieces", &key_integer, AT(pieces), "-", "8", "8", "Number of pieces of a grain, 2 to 64.",
      .least = 2, .most = FRACTURE_MOST },
    { "dust", &key_not_negative, AT(dust), "m", "0", "5e-5",
      "Smaller pieces are removed: their mass is dust." },
    { 0 },
};

static int finish_breaks(jnode o, struct scene *s, void *out)
{
    struct breakage *b = out;
    if (!keys_has(&o, "exponent") && keys_has(&o, "size") && b->modulus > 0)
        b->exponent = s->dim / b->modulus;
    if (b->by != BREAKAGE_ENERGY && (b->damage || keys_has(&o, "least")))
        return json_node_fault(json_node_key(&o, keys_has(&o, "least") ? "least" : "damage"),
                               "goes with \"by\": \"energy\"");
    return 0;
}

const struct keys scene_breaks_keys = { "breaks", breaks_key, .finish = finish_breaks };

/* ---- the packing ---- */

enum { FRAGMENTS_MOST = 1 << 24 }; /* that a scene may make of its bodies: some 8 GB */

/* The polyhedron that a ball is cut as, so that documents have a table of shapes from the first frame on */
static int add_inscribed(struct packing *p, struct failure *failure)
{
    struct shape s;
    struct solid_frame was;
    if (shapes_find(&p->shapes, FRACTURE_INSCRIBED) >= 0) return 0;
    if (fracture_inscribe(&s, p->dim, failure)) return failure->status;
    if (solid_settle(&s, p->dim, &was, failure) || shape_finish(&s, p->dim, failure)) {
        shape_free(&s);
        return failure->status;
    }
    s.name = strdup(FRACTURE_INSCRIBED);
    return shapes_add(&p->shapes, p->dim, &s, failure);
}

int scene_breaks_set(struct packing *p, const struct scene *s, struct failure *failure)
{
    bool any = false, pieces = false;
    for (int32_t k = 0; k < s->materials; k++) {
        const struct breakage *b = &s->material[k].breaks;
        any = any || b->strength > 0;
        pieces = pieces || (b->strength > 0 && b->into == INTO_PIECES);
    }
    if (!any) return 0;
    if (pieces && add_inscribed(p, failure)) return failure->status;
    if (pieces && !p->shape && packing_alloc_shapes(p, failure)) return failure->status;
    if (breakage_alloc(p, failure)) return failure->status;
    for (int32_t k = 0; k < s->materials; k++) p->breakage[k] = s->material[k].breaks;
    return 0;
}

/* Grains of one material, shape and size */
struct some_grains {
    int32_t material, shape;
    double radius; /* m */
    const char *what;
    int64_t which;
};

/* Can they break? Adds to *most how many fragments one may make. */
static int check_grains(const struct packing *p, const struct some_grains *g, double *most,
                        struct failure *failure)
{
    const struct breakage *b = &p->breakage[g->material];
    const struct shape *s = g->shape ? &p->shapes.s[g->shape] : NULL;
    const char *kind = p->material_name[g->material];
    const double d = breakage_diameter_of(p->dim, s, g->radius);
    if (!(b->strength > 0)) return 0;
    if (s && (b->into == INTO_BALLS || !fracture_cuts(s)))
        return failure_set(
            failure, EX_DATAERR,
            "materials.%s.breaks: %s, and %s %lld has the shape \"%s\": give it another "
            "material",
            kind,
            b->into == INTO_BALLS ? "only balls break into balls"
                                  : "only balls and polyhedra without a round break",
            g->what, (long long)g->which, s->name);
    if (d >= b->smallest) *most += pow(d / b->smallest, p->dim) * (double)b->pieces;
    if (*most <= FRAGMENTS_MOST) return 0;
    return failure_set(
        failure, EX_DATAERR,
        "materials.%s.breaks.smallest: grains of %.3g m that break down to %.3g m may make more "
        "than %d fragments: give a larger one",
        kind, d, b->smallest, FRAGMENTS_MOST);
}

/* A shape of that name would be taken for a fragment that has yet to come. */
static int check_shape_names(const struct packing *p, struct failure *failure)
{
    for (int32_t k = 1; k < p->shapes.n; k++)
        if (breakage_fragment(p->shapes.s[k].name) >= p->first_id)
            return failure_set(failure, EX_DATAERR,
                               "the shape \"%s\" has the name of a fragment: give it another one",
                               p->shapes.s[k].name);
    return 0;
}

int scene_breaks_check(const struct packing *p, const struct scene *s, struct failure *failure)
{
    double most = 0;
    if (!p->breakage) return 0;
    for (int64_t i = 0; i < p->n; i++) {
        const struct some_grains g = { p->material[i], p->shape ? p->shape[i] : 0, p->radius[i],
                                       "body", i };
        if (p->mass[i] > 0 && check_grains(p, &g, &most, failure)) return failure->status;
    }
    for (int32_t k = 0; k < s->pours; k++) {
        const struct scene_pour *o = &s->pour[k];
        const struct some_grains g = { o->material, o->form.shape, o->size.max, "pour", k };
        if (check_grains(p, &g, &most, failure)) return failure->status;
    }
    return check_shape_names(p, failure);
}
