/* scene/scene_build.c: groups of bodies, the check for overlaps: a packing from a scene. */
#include "scene/scene_build.h"

#include "base/bounded.h"
#include "base/random.h"

#include "contact/detect.h"
#include "scene/grains.h"
#include "scene/random_start.h"
#include "scene/scene_carry.h"
#include "scene/time_step.h"
#include "state/placement.h"
#include "state/servo_box.h"

#include <gsl/gsl_rng.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- bodies ---- */

static int scene_build_set_body(struct packing *p, int64_t i, const struct scene_bodies *b, vec3 x,
                                double r, struct failure *failure)
{
    double mass, inertia;
    if (b->form.shape)
        packing_solid_shape(p->dim, &p->shapes.s[b->form.shape], r, b->density, &mass, &inertia);
    else
        packing_solid(p->dim, r, b->density, &mass, &inertia);
    if (b->mass > 0) inertia *= b->mass / mass, mass = b->mass;
    if (!b->fixed && !(mass > 0 && inertia > 0))
        return failure_set(failure, EX_DATAERR, "body %lld: a radius of %g m gives no mass",
                           (long long)i, r);
    p->x[i] = x, p->v[i] = b->v, p->w[i] = b->w;
    p->radius[i] = r;
    p->mass[i] = b->fixed ? 0 : mass, p->inertia[i] = b->fixed ? 0 : inertia;
    p->material[i] = b->material;
    if (p->shape) p->shape[i] = b->form.shape;
    if (p->group) p->group[i] = b->group;
    return 0;
}

/* The middle of cell k of the lattice, moved at random as far as the body stays in the cell; in a
   periodic cell along its edges. */
static vec3 scene_build_draw_place(const struct scene_bodies *b, const struct scene_lattice *l,
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
        vec3 x = scene_build_draw_place(b, &l, p, k, r, rng);
        if (scene_build_set_body(p, first + k, b, x, r, failure)) return failure->status;
        if (b->thermal > 0) p->v[first + k] = v3_add(b->v, draw_velocity(b->thermal, p->dim, rng));
    }
    return 0;
}

/* Where the shapes and groups of a document are in the packing */
struct scene_build_rows {
    int32_t *shape, *group; /* [shapes.n], [1 + names.n] */
};

static int scene_build_find_rows(struct scene_build_rows *to, const struct packing *p,
                                 const struct packing *from, struct failure *failure)
{
    *to = (struct scene_build_rows){ 0 };
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
                     const struct scene_build_rows *to, struct failure *failure)
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
    if (scene_build_set_body(p, i, &one, g->x, g->r, failure)) return failure->status;
    p->q[i] = g->q, p->id[i] = g->id;
    if (g->weighs && !one.fixed && g->mass > 0 && one.mass == g->mass) p->inertia[i] = g->inertia;
    return 0;
}

static int fill_grains(struct packing *p, int64_t first, const struct scene *s,
                       const struct scene_bodies *b, const struct grains *list,
                       struct failure *failure)
{
    struct scene_build_rows to;
    scene_build_find_rows(&to, p, b->document, failure);
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

static bool is_list(const struct scene_bodies *b)
{
    return b->from != SCENE_ONE && b->from != SCENE_LATTICE;
}

static int fill_groups(struct packing *p, const struct scene *s, const struct grains *list,
                       gsl_rng *rng, struct failure *failure)
{
    int64_t first = 0;
    bool given = false;
    for (int64_t g = 0; g < s->groups; g++) {
        const struct scene_bodies *b = &s->bodies[g];
        int bad = is_list(b) ? fill_grains(p, first, s, b, &list[g], failure)
                  : b->from == SCENE_ONE
                      ? scene_build_set_body(p, first, b, b->x, b->size.min, failure)
                      : fill_lattice(p, first, b, rng, failure);
        if (bad) return bad;
        if (is_list(b)) draw_velocities(p, first, list[g].n, b, rng);
        int64_t n = is_list(b) ? list[g].n : b->count;
        if (b->form.shape && orient_group(p, s, g, first, n, failure)) return failure->status;
        given |= is_list(b);
        if (!is_list(b)) // numbers are given anew below, where any are given
            for (int64_t k = 0; k < b->count; k++) p->id[first + k] = -1;
        first += is_list(b) ? list[g].n : b->count;
    }
    bool numbered = false;
    for (int64_t i = 0; i < p->n; i++) numbered |= p->id[i] >= 0;
    for (int64_t i = 0; i < p->n && !numbered; i++) p->id[i] = (int32_t)i;
    return set_ids(p, numbered && given, failure);
}

/* ---- the packing ---- */

/* The shapes of a document, behind the scene's: a name stands for one shape. */
static int scene_build_take_shapes(struct packing *p, const struct scene_bodies *b,
                                   struct failure *failure)
{
    const struct shapes *from = &b->document->shapes;
    struct shapes copy;
    if (shapes_copy(&copy, from, failure)) return failure->status;
    for (int32_t k = 1; k < from->n && !failure->status; k++) {
        int32_t had = shapes_find(&p->shapes, from->s[k].name);
        if (had >= 0 && !shape_same(&p->shapes.s[had], &from->s[k]))
            failure_set(failure, EX_DATAERR, "%s: its shape \"%s\" is another than the scene's",
                        b->file, from->s[k].name);
        else if (had < 0)
            shapes_add(&p->shapes, p->dim, &copy.s[k], failure);
    }
    shapes_free(&copy);
    return failure->status;
}

static int set_shapes(struct packing *p, const struct scene *s, struct failure *failure)
{
    if (shapes_copy(&p->shapes, &s->shapes, failure)) return failure->status;
    for (int64_t g = 0; g < s->groups; g++)
        if (s->bodies[g].document && scene_build_take_shapes(p, &s->bodies[g], failure))
            return failure->status;
    return p->shapes.n ? packing_alloc_shapes(p, failure) : 0;
}

/* The scene's names, and those of bodies of documents; bodies have a group where any has, or will. */
static int set_names(struct packing *p, const struct scene *s, struct failure *failure)
{
    bool any = false, had[NAMES_MOST + 1];
    if (names_copy(&p->names, &s->names, failure)) return failure->status;
    for (int32_t k = 0; k < s->pours; k++) any = any || s->pour[k].group;
    for (int64_t g = 0; g < s->groups; g++) {
        const struct packing *from = s->bodies[g].document;
        int32_t which;
        any = any || s->bodies[g].group;
        if (!from || !from->group || s->bodies[g].group) continue;
        memset(had, 0, sizeof had);
        for (int64_t i = 0; i < from->n; i++) {
            if (!from->group[i] || had[from->group[i]]) continue;
            any = had[from->group[i]] = true;
            if (names_add(&p->names, from->names.text[from->group[i] - 1], &which, failure))
                return failure->status;
        }
    }
    return any ? packing_alloc_column(p, BODY_group, failure) : 0;
}

/* Has a document of bodies a group of that name, which may have no body left? */
static bool has_group(const struct scene *s, const char *name)
{
    for (int64_t g = 0; g < s->groups; g++) {
        const struct packing *from = s->bodies[g].document;
        int32_t which = from ? names_find(&from->names, name, strlen(name)) : -1;
        bool of_walls = false;
        for (int32_t k = 0; which >= 0 && k < from->names.rows; k++)
            of_walls = of_walls || from->names.row[k].name == which;
        if (which >= 0 && !of_walls) return true;
    }
    return false;
}

/* What a removal names is a group of bodies that the scene has, or a pour. */
static int check_removals(const struct scene *s, const bool *of_bodies, struct failure *failure)
{
    for (int32_t k = 0; k < s->removals; k++) {
        const int32_t group = s->removal[k].group;
        const char *name = group ? s->names.text[group - 1] : NULL;
        if (group && !of_bodies[group] && !has_group(s, name))
            return failure_set(
                failure, EX_DATAERR,
                "remove[%d].name: no group of bodies and no pour has the name \"%s\"", k, name);
    }
    return 0;
}

/* Walls, groups of bodies and materials have names of their own. */
static int check_names(const struct packing *p, const struct scene *s, struct failure *failure)
{
    for (int32_t k = 0; k < p->names.n; k++)
        for (int32_t material = 0; material < p->materials; material++)
            if (!strcmp(p->names.text[k], p->material_name[material]))
                return failure_set(failure, EX_DATAERR,
                                   "\"%s\" is a kind: walls and groups have other names",
                                   p->names.text[k]);
    bool of_bodies[NAMES_MOST + 1] = { false };
    for (int64_t i = 0; p->group && i < p->n; i++) of_bodies[p->group[i]] = p->group[i] > 0;
    for (int64_t g = 0; g < s->groups; g++) of_bodies[s->bodies[g].group] = s->bodies[g].group > 0;
    for (int32_t k = 0; k < s->pours; k++) of_bodies[s->pour[k].group] = s->pour[k].group > 0;
    for (int32_t k = 0; k < p->names.rows; k++)
        if (of_bodies[1 + p->names.row[k].name])
            return failure_set(failure, EX_DATAERR,
                               "\"%s\" is the name of a wall and of a group of bodies",
                               p->names.text[p->names.row[k].name]);
    return check_removals(s, of_bodies, failure);
}

/* Has any pair of materials a law beyond friction and restitution? */
static bool goes_beyond(const struct scene *s)
{
    for (int32_t k = 0; k < s->materials * s->materials; k++)
        if (pair_law_attracts(&s->law[k].pair_law) || pair_law_rolls(&s->law[k].pair_law) ||
            s->law[k].pair_law.impact > 0 || pair_law_springs(&s->law[k].pair_law))
            return true;
    return false;
}

static int set_parameters(struct packing *p, const struct scene *s, struct failure *failure)
{
    p->dt = s->dt, p->theta = s->theta, p->g = s->g, p->seed = s->seed, p->t = p->t0 = s->t;
    if (packing_alloc_passages(p, s->pours, s->removals, failure) || set_shapes(p, s, failure) ||
        set_names(p, s, failure))
        return failure->status;
    if (packing_alloc_walls(p, s->walls, failure) ||
        packing_alloc_materials(p, s->materials, failure))
        return failure->status;
    for (int32_t i = 0; i < s->walls; i++) p->wall[i] = s->wall[i];
    if (drives_copy(&p->drives, &s->drives, failure) ||
        drives_copy(&p->pushes, &s->pushes, failure) ||
        drives_copy(&p->pulls, &s->pulls, failure) || mesh_copy(&p->mesh, &s->mesh, failure))
        return failure->status;
    if (s->cell.given && !s->cell.goes_on &&
        (cell_copy(&p->cell, &s->cell.cell) || packing_alloc_images(p, failure)))
        goto fail;
    for (int32_t k = 0; k < s->materials; k++) {
        free(p->material_name[k]);
        if (!(p->material_name[k] = strdup(s->material[k].name))) goto fail;
    }
    for (int32_t k = 0; k < s->materials * s->materials; k++) {
#define SET(member, ...) p->member[k] = s->law[k].member;
        EVERY_PAIR_COLUMN(SET)
#undef SET
    }
    if (goes_beyond(s) && packing_alloc_laws(p, failure)) return failure->status;
    for (int32_t k = 0; p->law && k < s->materials * s->materials; k++)
        p->law[k] = s->law[k].pair_law;
    if ((p->scene = strdup(s->text))) return 0;
fail:
    return failure_set(failure, EX_SOFTWARE, "no memory for the scene");
}

/* Radii by which bodies may overlap at the start. Rounding: bodies that just touch. A run leaves its
   bodies a little in one another, which are a start all the same, and in walls that have not moved. */
static const double ROUNDING = 1e-6, LEFT_BY_A_RUN = 0.1;

/* A document's bodies, or a table's, which some program has printed to so many digits */
static bool may_be_settled(const struct scene_bodies *b)
{
    return b->from == SCENE_DOCUMENT || b->from == SCENE_TABLE;
}

/* Which bodies are those; NULL when memory is short. */
static bool *from_documents(const struct packing *p, const struct scene *s,
                            const struct grains *list)
{
    bool *settled = calloc((size_t)p->n + 1, sizeof *settled);
    int64_t first = 0;
    for (int64_t g = 0; settled && g < s->groups; g++) {
        int64_t n = is_list(&s->bodies[g]) ? list[g].n : s->bodies[g].count;
        for (int64_t i = 0; i < n; i++) settled[first + i] = may_be_settled(&s->bodies[g]);
        first += n;
    }
    return settled;
}

enum { PLACE = 40 + NAME_BYTES }; /* bytes of the place of a row in a scene */

/* "bodies[1]", "walls[1], floor": what the scene says of a row, -1 - i of a wall; "" of one that it does not say */
static const char *scene_build_place_of(const struct scene *s, const struct grains *list,
                                        int32_t row, char text[PLACE])
{
    int64_t g = 0, end = 0;
    *text = 0;
    if (row < 0 && s->has_walls) {
        const char *name = names_of_wall(&s->names, -1 - row);
        snprintf(text, PLACE, ", walls[%d]%s%s", s->wall_item[-1 - row], name ? ", " : "",
                 name ? name : "");
    }
    for (; row >= 0 && g < s->groups; g++) {
        end += is_list(&s->bodies[g]) ? list[g].n : s->bodies[g].count;
        if (row < end) break;
    }
    if (row >= 0) snprintf(text, PLACE, "bodies[%lld]", (long long)g);
    return text;
}

static int check_overlap(const struct packing *p, const struct scene *s, const struct grains *list,
                         const bool *settled, struct failure *failure)
{
    struct contacts found = { 0 };
    const char *cure = "; \"overlap\": true allows it)";
    char a[PLACE], b[PLACE];
    int e = detect_contacts_at(&found, p, p->x, p->t, 0, failure);
    for (int64_t i = 0; !e && i < found.n; i++) {
        const struct contact *c = &found.c[i];
        double r = packing_smaller_radius(p, c);
        bool by_run = settled[c->b] && (c->a < 0 || settled[c->a]);
        if (c->gap >= -(by_run ? LEFT_BY_A_RUN : ROUNDING) * r) continue;
        scene_build_place_of(s, list, c->a, a), scene_build_place_of(s, list, c->b, b);
        e = c->a < 0
                ? failure_set(failure, EX_DATAERR, "body %d is %.3g m deep in wall %d (%s%s%s",
                              c->b, -c->gap, -1 - c->a, b, a, cure)
                : failure_set(failure, EX_DATAERR, "bodies %d and %d overlap by %.3g m (%s, %s%s",
                              c->a, c->b, -c->gap, a, b, cure);
    }
    contacts_free(&found);
    return e;
}

/* The flow that the cell's edges make, for the bodies that can move */
static void add_affine_flow(struct packing *p)
{
    struct cell_flow f;
    cell_flow_init(&f, &p->cell, p->cell.edge, p->cell.rate);
    for (int64_t i = 0; f.changes && i < p->n; i++)
        if (p->mass[i] > 0) p->v[i] = v3_add(p->v[i], cell_flow_gain(&f, p->x[i]));
}

/* "wall 5: ..." becomes "walls[1]: wall 5: ...", as the scene has it. */
static int name_wall(const struct scene *s, struct failure *failure)
{
    char text[sizeof failure->text];
    int w;
    if (!s->has_walls || sscanf(failure->text, "wall %d:", &w) != 1 || w < 0 || w >= s->walls)
        return failure->status;
    memcpy(text, failure->text, sizeof text);
    snprintf(failure->text, sizeof failure->text, "walls[%d]: %.370s", s->wall_item[w], text);
    return failure->status;
}

/* The dt of a scene that leaves it to us, which adapts from then on */
static int scene_build_set_dt(struct packing *p, const struct scene *s, struct failure *failure)
{
    struct time_step t;
    if (s->dt > 0) return 0;
    time_step_of(&t, s, p);
    p->dt = t.best, p->adapts = true, p->tolerance = TIME_STEP_TOLERANCE;
    return isfinite(p->dt) && p->dt > 0
               ? 0
               : failure_set(failure, EX_DATAERR,
                             "dt: auto: nothing in the scene moves, so no time step can be "
                             "chosen: give a number of seconds");
}

static int scene_build_by_number(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return x < y ? -1 : x > y;
}

/* Are the bodies there that forces act on? */
static int check_forces(const struct packing *p, struct failure *failure)
{
    if (!p->pulls.n) return 0;
    int32_t *id = malloc(((size_t)p->n + 1) * sizeof *id);
    if (!id) return failure_set(failure, EX_SOFTWARE, "no memory to look for the bodies of forces");
    if (p->n) memcpy(id, p->id, (size_t)p->n * sizeof *id);
    qsort(id, (size_t)p->n, sizeof *id, scene_build_by_number);
    for (int32_t k = 0; k < p->pulls.n && !failure->status; k++) {
        const int32_t wanted = p->pulls.drive[k].wall;
        if (!bsearch(&wanted, id, (size_t)p->n, sizeof *id, scene_build_by_number))
            failure_set(failure, EX_DATAERR,
                        "forces: no body has the id %d (nsd-info -p shows them)", wanted);
    }
    free(id);
    return failure->status;
}

/* Are the numbers in range, and do no bodies overlap, unless the scene allows it? */
static int check_packing(const struct packing *p, const struct scene *s, const struct grains *list,
                         struct failure *failure)
{
    if (check_forces(p, failure)) return failure->status;
    if (packing_check(p, failure)) return name_wall(s, failure);
    if (check_names(p, s, failure)) return failure->status;
    if (packing_check_clock(p, failure)) return failure->status;
    if (s->overlap) return 0;
    bool *settled = from_documents(p, s, list);
    if (!settled) return failure_set(failure, EX_SOFTWARE, "no memory to look for overlaps");
    check_overlap(p, s, list, settled, failure);
    free(settled);
    return failure->status;
}

/* The walls of a document, where they were at its time when it is the scene's. */
static int take_walls(struct packing *p, const struct scene *s, const struct scene_bodies *b,
                      struct failure *failure)
{
    const struct packing *from = b->document;
    if (packing_alloc_walls(p, from->walls, failure)) return failure->status;
    for (int32_t i = 0; i < from->walls; i++) {
        struct wall *w = &p->wall[i];
        *w = from->wall[i];
        w->x = v3_axpy(w->x, from->t - s->t, w->v);
        w->until -= from->t - s->t;
        w->material = grains_material(s, b, from->wall[i].material);
        if (w->material < 0)
            return failure_set(failure, EX_DATAERR,
                               "%s: wall %d is of kind \"%s\": name it under \"kinds\"", b->file, i,
                               from->material_name[from->wall[i].material]);
    }
    if (drives_copy(&p->drives, &from->drives, failure) ||
        drives_copy(&p->pushes, &from->pushes, failure) ||
        mesh_copy(&p->mesh, &from->mesh, failure))
        return failure->status;
    for (int32_t k = 0; k < p->drives.n; k++) p->drives.drive[k].clock += from->t - s->t;
    for (int32_t k = 0; k < p->pushes.n; k++) p->pushes.drive[k].clock += from->t - s->t;
    for (int32_t k = 0; k < from->names.rows; k++) {
        const struct named *r = &from->names.row[k];
        if (names_give(&p->names, from->names.text[r->name], r->wall, r->first, r->count, failure))
            return failure->status;
    }
    return 0;
}

/* A scene at the time of its first document counts its time as that does: it goes on with the same bits. */
static void inherit_clock(struct packing *p, const struct scene *s)
{
    const struct packing *from = NULL;
    for (int64_t g = 0; g < s->groups && !from; g++) from = s->bodies[g].document;
    if (from) packing_count_from(p, from->t0, from->step0 - from->step);
}

static int inherit_walls(struct packing *p, const struct scene *s, struct failure *failure)
{
    for (int64_t g = 0; g < s->groups && !s->has_walls; g++)
        if (s->bodies[g].document) return take_walls(p, s, &s->bodies[g], failure);
    return 0;
}

/* kg m^2: what a room's wall adds to its inertia: its mass by the square of its lever [state/servo_box.h] */
static int set_room_mass(struct packing *p, const struct scene *s, int32_t w,
                         struct failure *failure)
{
    struct load *l = &p->wall[w].load;
    double lever = wall_lever(p, &p->wall[w], p->t), farthest = 0;
    for (int32_t k = 0; k < s->walls; k++)
        if (servo_box_has(&p->wall[k]))
            farthest = fmax(farthest, fabs(wall_lever(p, &p->wall[k], p->t)));
    if (lever > 1e-9 * farthest || farthest == 0)
        return failure_set(failure, EX_DATAERR,
                           "room.center: lies behind walls[%d], by %g m: give a \"center\" between "
                           "the walls",
                           s->wall_item[w], lever);
    if (!s->room_yields) return 0;
    if (!(l->mass > 0)) l->mass = time_step_wall_mass(p, &p->wall[w]);
    if (!(l->mass > 0))
        return failure_set(failure, EX_DATAERR,
                           "room: no bodies move, whose mass would give the walls theirs: give a "
                           "\"mass\", kg");
    l->mass *= lever * lever;
    return 0;
}

/* Masses of what yields, by the rule where they are not given; that of a size is a multiple of the square of the
   edges. */
static int set_masses(struct packing *p, const struct scene *s, struct failure *failure)
{
    struct cell *c = &p->cell;
    double mass = time_step_edge_mass(p), squares = 0;
    bool by_rule = s->cell.given && s->cell.by_rule;
    for (int k = 0; k < p->dim; k++) squares += v3_dot(c->edge[k], c->edge[k]);
    if (s->cell.given && by_rule && !(mass > 0))
        return failure_set(failure, EX_DATAERR,
                           "cell.stress: no body moves, so the mass of the edges cannot be chosen: "
                           "give a \"mass\", kg");
    for (int k = 0; k < 9 && by_rule; k++)
        if (c->mass[k / 3][k % 3] > 0) c->mass[k / 3][k % 3] = mass;
    if (s->cell.given && c->size_mass > 0) c->size_mass = (by_rule ? mass : c->size_mass) * squares;
    for (int32_t w = 0; w < s->walls; w++) {
        struct load *l = &p->wall[w].load;
        if (servo_box_has(&p->wall[w]) && set_room_mass(p, s, w, failure)) return failure->status;
        if (!l->way || servo_box_has(&p->wall[w]) || l->mass > 0) continue;
        l->mass = time_step_wall_mass(p, &p->wall[w]);
        if (!(l->mass > 0))
            return failure_set(
                failure, EX_DATAERR,
                "walls[%d].load: no body moves, so the mass of the wall cannot be chosen: "
                "give a \"mass\", kg",
                s->wall_item[w]);
    }
    return 0;
}

/* The whole cell of a document, its moments as if the document's time were the scene's */
static int scene_build_take_cell(struct packing *p, const struct scene *s,
                                 const struct packing *from)
{
    if (cell_copy(&p->cell, &from->cell)) return 1;
    for (int32_t m = 0; m < p->cell.gradients; m++) p->cell.gradient[m].t += s->t - from->t;
    for (int32_t m = 0; m < p->cell.factors; m++) p->cell.factor[m].t += s->t - from->t;
    return 0;
}

/* The scene's, with what it leaves out as the document has it; edges that yield go on as they moved. */
static int complete_cell(struct packing *p, const struct scene *s, const struct packing *from)
{
    struct cell *c = &p->cell;
    if (cell_copy(c, &s->cell.cell)) return 1;
    if (!s->cell.origin) c->origin = from->cell.origin;
    for (int k = 0; k < 3; k++) {
        c->edge[k] = from->cell.edge[k];
        if (!s->cell.repeats) c->repeats[k] = from->cell.repeats[k];
    }
    cell_set_rate(c, s->t);
    for (int k = 0; k < 3; k++) {
        if (c->mass[k][0] > 0) c->rate[k].x = from->cell.rate[k].x;
        if (c->mass[k][1] > 0) c->rate[k].y = from->cell.rate[k].y;
        if (c->mass[k][2] > 0) c->rate[k].z = from->cell.rate[k].z;
    }
    double growth = c->size_mass > 0 ? cell_growth(&from->cell, step_after(from)) : 0;
    for (int k = 0; k < s->dim && growth != 0; k++)
        c->rate[k] = v3_axpy(c->rate[k], growth, c->edge[k]);
    return 0;
}

static int inherit_cell(struct packing *p, const struct scene *s, struct failure *failure)
{
    const struct packing *from = NULL;
    for (int64_t g = 0; g < s->groups && !from; g++) from = s->bodies[g].document;
    bool repeats = from && cell_repeats(&from->cell);
    if (s->cell.goes_on && !repeats)
        return failure_set(failure, EX_DATAERR,
                           "cell: has no edges, and nor has the first document");
    if (!repeats || s->cell.none || (s->cell.given && !s->cell.goes_on)) return 0;
    if (s->cell.goes_on ? complete_cell(p, s, from) : scene_build_take_cell(p, s, from))
        return failure_set(failure, EX_SOFTWARE, "no memory for the cell");
    return packing_alloc_images(p, failure);
}

/* What documents know of their bodies besides these */
static int carry(struct packing *p, const struct scene *s, const struct grains *list,
                 struct failure *failure)
{
    int64_t *row = calloc((size_t)s->groups + 1, sizeof *row);
    if (!row) return failure_set(failure, EX_SOFTWARE, "no memory for the bodies");
    for (int64_t g = 0; g < s->groups; g++)
        row[g + 1] = row[g] + (is_list(&s->bodies[g]) ? list[g].n : s->bodies[g].count);
    scene_carry(p, s, row, failure);
    free(row);
    return failure->status;
}

static int build_packing(struct packing *p, const struct scene *s, const struct grains *list,
                         struct failure *failure)
{
    int64_t n = 0;
    for (int64_t g = 0; g < s->groups; g++)
        n += is_list(&s->bodies[g]) ? list[g].n : s->bodies[g].count;
    for (int64_t g = 0; s->built && g < s->groups; g++)
        s->built[g] = is_list(&s->bodies[g]) ? list[g].n : s->bodies[g].count;
    if (n > INT32_MAX) return failure_set(failure, EX_DATAERR, "more than %d bodies", INT32_MAX);
    if (packing_init(p, s->dim, n, failure)) return failure->status;
    gsl_rng *rng = random_alloc(gsl_rng_mt19937);
    if (!rng) failure_set(failure, EX_SOFTWARE, "no memory for random numbers");
    if (rng) gsl_rng_set(rng, s->seed);
    if (rng && !set_parameters(p, s, failure)) inherit_clock(p, s);
    if (rng && !failure->status && !inherit_walls(p, s, failure) && !inherit_cell(p, s, failure) &&
        !fill_groups(p, s, list, rng, failure) && !carry(p, s, list, failure)) {
        if (s->cell.affine) add_affine_flow(p);
        packing_wrap(p, NULL);
        names_settle(&p->names);
        p->pulls_most = pulls_most(&p->pulls, p->n, p->id, p->mass);
        if (!set_masses(p, s, failure) && !scene_build_set_dt(p, s, failure)) {
            scene_carry_dt(p, s);
            check_packing(p, s, list, failure);
        }
    }
    gsl_rng_free(rng);
    if (failure->status) packing_free(p);
    return failure->status;
}

/* Which group it is, in front of the reason of a failure */
static int in_group(int64_t g, int failed, struct failure *failure)
{
    char text[sizeof failure->text];
    if (!failed) return 0;
    memcpy(text, failure->text, sizeof text);
    snprintf(failure->text, sizeof failure->text, "bodies[%lld]: %.370s", (long long)g, text);
    return failure->status;
}

/* The bodies of group g where only building tells how many they are; walls: that they avoid, or NULL */
static int list_group(struct grains *out, const struct scene *s, int64_t g, const char *dir,
                      const struct packing *walls, gsl_rng *rng, struct failure *failure)
{
    const struct scene_bodies *b = &s->bodies[g];
    counter_start(rng, s->seed, COUNTER_GROUP, (uint64_t)g, 0, 0);
    switch (b->from) {
    case SCENE_TABLE:
        return grains_of_table(out, s, dir, b->file, failure);
    case SCENE_DOCUMENT:
        return grains_of_document(out, s, b, failure);
    case SCENE_SHELVES:
        return in_group(g, shelves_fill(out, b, s->dim, rng, failure), failure);
    case SCENE_RANDOM:
        return in_group(
            g, random_start(out, b, s->dim, b->in_cell ? &s->cell.cell : NULL, walls, rng, failure),
            failure);
    default:
        return 0;
    }
}

/* A packing of the walls alone, where bodies at random have to avoid them. Its shapes and names are the scene's. */
static int make_walls(struct packing *walls, bool *any, const struct scene *s,
                      struct failure *failure)
{
    *any = false;
    for (int64_t g = 0; g < s->groups && !s->overlap; g++)
        *any = *any || s->bodies[g].from == SCENE_RANDOM;
    if (!*any || packing_init(walls, s->dim, 0, failure)) return failure->status;
    if (set_parameters(walls, s, failure) || inherit_walls(walls, s, failure))
        return failure->status;
    *any = walls->walls > 0;
    return 0;
}

enum { BODY_BYTES = 256 }; /* that a body takes at least, of memory */

/* Is there memory for the bodies that the scene counts? It is asked before any of them is made. */
static int check_count(const struct scene *s, struct failure *failure)
{
    double n = 0, most = limits_room();
    for (int64_t g = 0; g < s->groups; g++) n += (double)s->bodies[g].count;
    if (n * BODY_BYTES <= most) return 0;
    return failure_set(
        failure, EX_DATAERR,
        "%.0f bodies take %.3g GB of memory and more, and this process has %.3g GB: a "
        "smaller count",
        n, n * BODY_BYTES / 1e9, most / 1e9);
}

int scene_build(struct packing *p, const struct scene *s, const char *dir, struct failure *failure)
{
    if (check_count(s, failure)) return failure->status;
    struct packing walls = { 0 };
    bool avoid = false;
    make_walls(&walls, &avoid, s, failure);
    struct grains *list = calloc(s->groups > 0 ? (size_t)s->groups : 1, sizeof *list);
    gsl_rng *rng = counter_alloc();
    if (!list || !rng) failure_set(failure, EX_SOFTWARE, "no memory for the bodies");
    for (int64_t g = 0; g < s->groups && !failure->status; g++)
        list_group(&list[g], s, g, dir, avoid ? &walls : NULL, rng, failure);
    if (!failure->status) build_packing(p, s, list, failure);
    for (int64_t g = 0; list && g < s->groups; g++) grains_free(&list[g]);
    free(list);
    packing_free(&walls);
    gsl_rng_free(rng);
    return failure->status;
}
