/* scene/scene_fill.c: the bodies of a scene's groups [scene/grains.h]. */

#include "base/random.h"
#include "scene/grains.h"

#include <stdlib.h>
#include <string.h>

static int scene_fill_set_body(struct packing *p, int64_t i, const struct scene_bodies *b, vec3 x,
                               double r, struct failure *failure)
{
    const struct new_body body = { .x = x,
                                   .v = b->v,
                                   .w = b->w,
                                   .q = { 1, 0, 0, 0 },
                                   .radius = r,
                                   .density = b->density,
                                   .mass = b->mass,
                                   .weighed = b->mass > 0,
                                   .fixed = b->fixed,
                                   .material = b->material,
                                   .shape = b->form.shape,
                                   .group = b->group };
    if (!packing_set_body(p, i, &body))
        return failure_set(failure, EX_DATAERR, "body %lld: a radius of %g m gives no mass",
                           (long long)i, r);
    return 0;
}

/* The middle of cell k of the lattice, moved at random as far as the body stays in the cell; in a
   periodic cell along its edges. */
static vec3 scene_fill_draw_place(const struct scene_bodies *b, const struct scene_lattice *l,
                                  const struct packing *p, int64_t k, double r, gsl_rng *rng)
{
    const int dim = p->dim;
    const struct cell *c = &p->cell;
    double x[3] = { 0 }, rest = (double)k;
    for (int i = 0; i < dim; i++) {
        bool last = i == dim - 1; // the box may be open here: no end of cells
        double above = last ? 0 : floor(rest / l->cells[i]);
        double cell = last ? rest : rest - above * l->cells[i];
        double slack = b->jitter * (0.5 * l->edge[i] - r);
        x[i] = b->box.lo[i] + (cell + 0.5) * l->edge[i] + slack * (2 * gsl_rng_uniform(rng) - 1);
        rest = above;
    }
    if (!b->in_cell) return v3(x[0], x[1], x[2]);
    vec3 place = c->origin;
    for (int i = 0; i < dim; i++) place = v3_axpy(place, x[i] / b->box.hi[i], c->edge[i]);
    return place;
}

static vec3 draw_velocity(double sd, int dim, gsl_rng *rng)
{
    double v[3] = { 0 };
    for (int i = 0; i < dim; i++) v[i] = scene_draw_normal(rng, sd);
    return v3(v[0], v[1], v[2]);
}

static int fill_lattice(struct packing *p, int64_t first, const struct scene_bodies *b,
                        gsl_rng *rng, struct failure *failure)
{
    struct scene_lattice l = scene_lattice(b, p->dim);
    for (int64_t k = 0; k < b->count; k++) {
        double r = scene_size_draw(&b->size, rng);
        vec3 x = scene_fill_draw_place(b, &l, p, k, r, rng);
        if (scene_fill_set_body(p, first + k, b, x, r, failure)) return failure->status;
        if (b->thermal > 0) p->v[first + k] = v3_add(b->v, draw_velocity(b->thermal, p->dim, rng));
    }
    return 0;
}

/* Where the shapes and groups of a document are in the packing */
struct scene_fill_rows {
    int32_t *shape, *group; /* [shapes.n], [1 + names.n] */
};

static int scene_fill_find_rows(struct scene_fill_rows *to, const struct packing *p,
                                const struct packing *from, struct failure *failure)
{
    *to = (struct scene_fill_rows){ 0 };
    if (!from) return 0;
    to->shape = calloc((size_t)from->shapes.n + 1, sizeof *to->shape);
    to->group = calloc((size_t)from->names.n + 1, sizeof *to->group);
    if (!to->shape || !to->group)
        return failure_set(failure, EX_SOFTWARE, "no memory for the bodies");
    for (int32_t k = 1; k < from->shapes.n; k++)
        to->shape[k] = shapes_find(&p->shapes, from->shapes.s[k].name);
    for (int32_t k = 0; k < from->names.n; k++)
        to->group[1 + k] =
            1 + names_find(&p->names, from->names.text[k], strlen(from->names.text[k]));
    return 0;
}

/* What is said of a grain comes before what its material is; what its group says, before both. */
static int set_grain(struct packing *p, int64_t i, const struct scene *s,
                     const struct scene_bodies *b, const struct grain *g,
                     const struct scene_fill_rows *to, struct failure *failure)
{
    struct scene_bodies one = *b;
    if (!b->has_material && g->material >= 0) one.material = g->material;
    if (!b->has_v && g->has_v) one.v = g->v;
    if (!b->has_w && g->has_w) one.w = g->w;
    if (!b->has_fixed) one.fixed = g->fixed;
    if (!b->has_density)
        one.density = g->density > 0 ? g->density : s->material[one.material].density;
    if (!b->has_density && !(b->mass > 0)) one.mass = g->mass;
    if (g->shape && to->shape) one.form.shape = to->shape[g->shape];
    if (g->group && to->group && !b->group) one.group = to->group[g->group];
    if (scene_fill_set_body(p, i, &one, g->x, g->r, failure)) return failure->status;
    p->q[i] = g->q, p->id[i] = g->id;
    if (g->weighs && !one.fixed && g->mass > 0 && one.mass == g->mass) p->inertia[i] = g->inertia;
    return 0;
}

static int fill_grains(struct packing *p, int64_t first, const struct scene *s,
                       const struct scene_bodies *b, const struct grains *list,
                       struct failure *failure)
{
    struct scene_fill_rows to;
    scene_fill_find_rows(&to, p, b->document, failure);
    for (int64_t k = 0; k < list->n && !failure->status; k++)
        set_grain(p, first + k, s, b, &list->g[k], &to, failure);
    free(to.shape), free(to.group);
    return failure->status;
}

/* Random velocities of n bodies of a group, besides that which all have */
static void draw_velocities(struct packing *p, int64_t first, int64_t n,
                            const struct scene_bodies *b, gsl_rng *rng)
{
    for (int64_t k = 0; k < n && b->thermal > 0; k++)
        p->v[first + k] = v3_add(b->v, draw_velocity(b->thermal, p->dim, rng));
}

/* Numbers that tables and documents give, each once; the others follow the greatest of them. */
static int set_ids(struct packing *p, bool given, struct failure *failure)
{
    int32_t next = 0;
    for (int64_t i = 0; i < p->n; i++)
        if (p->id[i] >= next) next = p->id[i] < INT32_MAX ? p->id[i] + 1 : INT32_MAX;
    p->first_id = next;
    if (!given) return 0;
    unsigned char *taken = calloc((size_t)next + 1, 1);
    if (!taken) return failure_set(failure, EX_SOFTWARE, "no memory for the bodies' numbers");
    for (int64_t i = 0; i < p->n && !failure->status; i++) {
        if (p->id[i] < 0 && next == INT32_MAX)
            failure_set(failure, EX_DATAERR, "body %lld: no number is left for it", (long long)i);
        else if (p->id[i] < 0)
            p->id[i] = next++;
        else if (taken[p->id[i]]++)
            failure_set(failure, EX_DATAERR, "body %lld: another one has its id, %d", (long long)i,
                        p->id[i]);
    }
    free(taken);
    p->first_id = next;
    return failure->status;
}

/* Orientations are functions of the group and the body's number in it: no other draw depends on them. */
static int orient_group(struct packing *p, const struct scene *s, int64_t g, int64_t first,
                        int64_t n, struct failure *failure)
{
    const struct scene_bodies *b = &s->bodies[g];
    gsl_rng *rng = b->form.tumbled ? counter_alloc() : NULL;
    if (b->form.tumbled && !rng)
        return failure_set(failure, EX_SOFTWARE, "no memory for random numbers");
    for (int64_t i = 0; i < n; i++) {
        if (rng) counter_start(rng, s->seed, COUNTER_TURN, (uint64_t)g, (uint64_t)i, 0);
        p->q[first + i] = orientation_draw(s, &b->form, rng);
    }
    gsl_rng_free(rng);
    return 0;
}

int scene_fill(struct packing *p, const struct scene *s, const struct grains *list, gsl_rng *rng,
               struct failure *failure)
{
    int64_t first = 0;
    bool given = false;
    for (int64_t g = 0; g < s->groups; g++) {
        const struct scene_bodies *b = &s->bodies[g];
        int bad = scene_is_list(b) ? fill_grains(p, first, s, b, &list[g], failure)
                  : b->from == SCENE_ONE
                      ? scene_fill_set_body(p, first, b, b->x, b->size.min, failure)
                      : fill_lattice(p, first, b, rng, failure);
        if (bad) return bad;
        if (scene_is_list(b)) draw_velocities(p, first, list[g].n, b, rng);
        int64_t n = scene_is_list(b) ? list[g].n : b->count;
        if (b->form.shape && orient_group(p, s, g, first, n, failure)) return failure->status;
        given |= scene_is_list(b);
        if (!scene_is_list(b)) // numbers are given anew below, where any are given
            for (int64_t k = 0; k < b->count; k++) p->id[first + k] = -1;
        first += scene_is_list(b) ? list[g].n : b->count;
    }
    bool numbered = false;
    for (int64_t i = 0; i < p->n; i++) numbered |= p->id[i] >= 0;
    for (int64_t i = 0; i < p->n && !numbered; i++) p->id[i] = (int32_t)i;
    return set_ids(p, numbered && given, failure);
}
