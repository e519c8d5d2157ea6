/* scene/scene_build.c: names, laws, masses, the check for overlaps: a packing from a scene. */
#include "scene/scene_build.h"

#include "base/bounded.h"
#include "base/random.h"
#include "contact/detect.h"
#include "scene/grains.h"
#include "scene/random_start.h"
#include "scene/scene_breaks.h"
#include "scene/scene_carry.h"
#include "scene/stiffness.h"
#include "scene/time_step.h"
#include "state/placement.h"
#include "state/servo_box.h"

#include <gsl/gsl_rng.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
                                   "\"%s\" is a material: walls and groups have other names",
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
        if (pair_law_acts(&s->law[k].pair_law) || stiffness_given(&s->law[k])) return true;
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
    if (scene_breaks_set(p, s, failure)) return failure->status;
    stiffness_expect(p, s); // what a document remembers of springs is carried over before
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
        int64_t n = scene_is_list(&s->bodies[g]) ? list[g].n : s->bodies[g].count;
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
        end += scene_is_list(&s->bodies[g]) ? list[g].n : s->bodies[g].count;
        if (row < end) break;
    }
    if (row >= 0) snprintf(text, PLACE, "bodies[%lld]", (long long)g);
    return text;
}

static int check_overlap(const struct packing *p, const struct scene *s, const struct grains *list,
                         const bool *settled, struct failure *failure)
{
    struct contacts found = { 0 };
    const char *cure = "; \"allow_overlap\": true allows it)";
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

/* The dt of a scene that leaves it to us */
static int scene_build_set_dt(struct packing *p, const struct scene *s, struct failure *failure)
{
    struct time_step t;
    if (s->dt > 0) return 0;
    time_step_of(&t, s, p);
    p->dt = isnan(s->dt) ? t.interval : t.best;
    return isfinite(p->dt) && p->dt > 0
               ? 0
               : failure_set(failure, EX_DATAERR,
                             "dt: %snothing in the scene moves, so no time step can be "
                             "chosen: give a number of seconds",
                             isnan(s->dt) ? "is missing, and " : "auto: ");
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
                        "forces: no body has the id %d (nsd-info -b shows them)", wanted);
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
    if (check_names(p, s, failure) || scene_breaks_check(p, s, failure)) return failure->status;
    if (packing_check_clock(p, failure)) return failure->status;
    if (s->allow_overlap) return 0;
    bool *settled = from_documents(p, s, list);
    if (!settled) return failure_set(failure, EX_SOFTWARE, "no memory to look for overlaps");
    check_overlap(p, s, list, settled, failure);
    free(settled);
    return failure->status;
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
        return failure_set(
            failure, EX_DATAERR,
            "servo.center: lies behind walls[%d], by %g m: give a \"center\" between "
            "the walls",
            s->wall_item[w], lever);
    if (!s->room_yields) return 0;
    if (!(l->mass > 0)) l->mass = time_step_wall_mass(p, &p->wall[w]);
    if (!(l->mass > 0))
        return failure_set(failure, EX_DATAERR,
                           "servo: no bodies move, whose mass would give the walls theirs: give a "
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

/* What documents know of their bodies besides these */
static int carry(struct packing *p, const struct scene *s, const struct grains *list,
                 struct failure *failure)
{
    int64_t *row = calloc((size_t)s->groups + 1, sizeof *row);
    if (!row) return failure_set(failure, EX_SOFTWARE, "no memory for the bodies");
    for (int64_t g = 0; g < s->groups; g++)
        row[g + 1] = row[g] + (scene_is_list(&s->bodies[g]) ? list[g].n : s->bodies[g].count);
    scene_carry(p, s, row, failure);
    free(row);
    return failure->status;
}

static int build_packing(struct packing *p, const struct scene *s, const struct grains *list,
                         struct failure *failure)
{
    int64_t n = 0;
    for (int64_t g = 0; g < s->groups; g++)
        n += scene_is_list(&s->bodies[g]) ? list[g].n : s->bodies[g].count;
    for (int64_t g = 0; s->built && g < s->groups; g++)
        s->built[g] = scene_is_list(&s->bodies[g]) ? list[g].n : s->bodies[g].count;
    if (n > INT32_MAX) return failure_set(failure, EX_DATAERR, "more than %d bodies", INT32_MAX);
    if (packing_init(p, s->dim, n, failure)) return failure->status;
    gsl_rng *rng = random_alloc(gsl_rng_mt19937);
    if (!rng) failure_set(failure, EX_SOFTWARE, "no memory for random numbers");
    if (rng) gsl_rng_set(rng, s->seed);
    if (rng && !set_parameters(p, s, failure)) scene_carry_clock(p, s);
    if (rng && !failure->status && !scene_carry_walls(p, s, failure) &&
        !scene_carry_cell(p, s, failure) && !scene_fill(p, s, list, rng, failure) &&
        !carry(p, s, list, failure)) {
        if (s->cell.affine) add_affine_flow(p);
        packing_wrap(p, NULL);
        names_settle(&p->names);
        p->pulls_most = pulls_most(&p->pulls, p->n, p->id, p->mass);
        if (!set_masses(p, s, failure) && !scene_build_set_dt(p, s, failure) &&
            !stiffness_build(p, s, failure)) {
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
    for (int64_t g = 0; g < s->groups && !s->allow_overlap; g++)
        *any = *any || s->bodies[g].from == SCENE_RANDOM;
    if (!*any || packing_init(walls, s->dim, 0, failure)) return failure->status;
    if (set_parameters(walls, s, failure) || scene_carry_walls(walls, s, failure))
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
