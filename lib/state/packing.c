/* state/packing.c: memory for a packing, and the check of its numbers. */
#include "state/packing.h"

#include "base/array.h"
#include "shape/wall_in_cell.h"
#include "state/breakage.h"
#include "state/fields.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int events_add(struct events *s, const struct event *e, struct failure *failure)
{
    if (!array_grow(&s->e, &s->room, s->n + 1, sizeof *s->e))
        return failure_set(failure, EX_SOFTWARE, "no memory for events");
    s->e[s->n++] = *e;
    return 0;
}

const char *const overlap_name[OVERLAP_COUNT] = { "",     "keep",    "gap",
                                                  "push", "project", "gap-project" };
/* Walls that bodies may have: each body asks each, which takes up to 40 ns; for many bodies, and for few */
enum { WALLS_BODY = 4096, WALLS_LEAST = 1 << 26 };
enum { IMAGES_MOST = 1 << 30 }; /* so that sums and differences of images are numbers too */

static void *array(int64_t n, size_t size)
{
    return calloc(n > 0 ? (size_t)n : 1, size);
}

#define ROW(ctype, member, type, width, name, unit, bounds, ...)                                   \
    FIELD(struct packing, member, type, width, name, unit, __VA_ARGS__, .range = FIELD_##bounds,   \
          .key =                                                                                   \
              BODY_##member == BODY_material ? "material" : NULL), /* "species" is H5MD's word */
const struct field body_columns[] = { EACH_BODY_COLUMN(ROW){ 0 } };
#undef ROW

static bool is_optional(const struct field *b)
{
    return b->traits & (FIELD_OPTIONAL | FIELD_BY_SETTINGS);
}

static void free_column(struct packing *p, const struct field *c)
{
    free(field_array(c, p));
    field_set_array(c, p, NULL);
}

int packing_alloc_column(struct packing *p, int column, struct failure *failure)
{
    const struct field *c = &body_columns[column];
    free_column(p, c);
    field_set_array(c, p, array(p->n, field_bytes(c)));
    return field_array(c, p) ? 0
                             : failure_set(failure, EX_SOFTWARE, "no memory for %lld bodies' %s",
                                           (long long)p->n, c->name);
}

uint32_t packing_optional(const struct packing *p)
{
    uint32_t set = 0;
    for (int k = 0; k < BODY_COLUMNS; k++)
        if (is_optional(&body_columns[k]) && field_array(&body_columns[k], p)) set |= 1u << k;
    return set;
}

int packing_alloc_optional(struct packing *p, uint32_t set, struct failure *failure)
{
    for (int k = 0; k < BODY_COLUMNS; k++)
        if ((set & 1u << k) && packing_alloc_column(p, k, failure)) return failure->status;
    return 0;
}

/* Bodies first .. n - 1, whose arrays are zero */
static void set_default(struct packing *p, int64_t first)
{
    for (int64_t i = first; i < p->n; i++) p->id[i] = -1, p->q[i].w = 1;
    for (int64_t i = first; p->parent && i < p->n; i++) p->parent[i] = -1;
}

int packing_init(struct packing *p, int dim, int64_t n, struct failure *failure)
{
    *p = (struct packing){ .dim = dim, .n = n, .theta = 0.5, .cell = cell_none() };
    for (int k = 0; k < BODY_COLUMNS && !failure->status; k++)
        if (!is_optional(&body_columns[k])) packing_alloc_column(p, k, failure);
    if (failure->status || packing_alloc_walls(p, 0, failure) ||
        packing_alloc_materials(p, 1, failure)) {
        packing_free(p);
        return failure->status;
    }
    set_default(p, 0);
    for (int64_t i = 0; i < n; i++) p->id[i] = (int32_t)i;
    return 0;
}

static void materials_free(struct packing *p)
{
    for (int32_t k = 0; p->material_name && k < p->materials; k++) free(p->material_name[k]);
    free(p->material_name), free(p->law), free(p->breakage), free(p->broken);
    p->material_name = NULL, p->law = NULL, p->breakage = NULL, p->broken = NULL, p->materials = 0;
#define FREE(member, ...) free(p->member), p->member = NULL;
    EVERY_PAIR_COLUMN(FREE)
#undef FREE
}

int packing_alloc_walls(struct packing *p, int32_t k, struct failure *failure)
{
    free(p->wall);
    p->walls = k;
    p->wall = array(k, sizeof *p->wall);
    for (int32_t w = 0; p->wall && w < k; w++) p->wall[w].until = INFINITY;
    return p->wall ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for %d walls", k);
}

int packing_alloc_materials(struct packing *p, int32_t k, struct failure *failure)
{
    materials_free(p);
    p->material_name = array(k, sizeof *p->material_name);
    bool allocated = p->material_name;
#define ALLOC(member, ...)                                                                         \
    p->member = array((int64_t)k * k, sizeof *p->member);                                          \
    allocated = allocated && p->member;
    EVERY_PAIR_COLUMN(ALLOC)
#undef ALLOC
    for (p->materials = 0; allocated && p->materials < k; p->materials++) {
        char name[16];
        snprintf(name, sizeof name, "%d", p->materials);
        allocated = (p->material_name[p->materials] = strdup(name));
    }
    return allocated ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for %d materials", k);
}

bool packing_has_springs(const struct packing *p)
{
    for (int32_t k = 0; p->law && k < p->materials * p->materials; k++)
        if (pair_law_springs(&p->law[k])) return true;
    return false;
}

bool packing_adheres(const struct packing *p)
{
    for (int32_t k = 0; p->law && k < p->materials * p->materials; k++)
        if (pair_law_adheres(&p->law[k])) return true;
    return false;
}

bool packing_has_compliance(const struct packing *p)
{
    for (int32_t k = 0; p->law && k < p->materials * p->materials; k++)
        if (p->law[k].soft > 0) return true;
    return false;
}

bool packing_springs(const struct packing *p, const struct contact *c)
{
    return p->law && pair_law_springs(&p->law[packing_pair(p, c->a, c->b)]);
}

bool packing_complies(const struct packing *p, const struct contact *c)
{
    return p->law && p->law[packing_pair(p, c->a, c->b)].soft > 0;
}

int packing_alloc_laws(struct packing *p, struct failure *failure)
{
    free(p->law);
    p->law = array((int64_t)p->materials * p->materials, sizeof *p->law);
    return p->law ? 0
                  : failure_set(failure, EX_SOFTWARE, "no memory for %d materials", p->materials);
}

bool packing_sticks(const struct packing *p)
{
    for (int32_t k = 0; k < p->materials * p->materials; k++)
        if (p->mu_s[k] > 0) return true;
    return false;
}

bool packing_rolls(const struct packing *p)
{
    for (int32_t k = 0; p->law && k < p->materials * p->materials; k++)
        if (pair_law_rolls(&p->law[k])) return true;
    return false;
}

bool packing_may_gain(const struct packing *p)
{
    for (int32_t k = 0; k < p->materials * p->materials; k++)
        if (p->mu[k] > 0 && p->en[k] > 0) return true;
    return false;
}

bool packing_bounds(const struct packing *p, const struct contact *c)
{
    const int32_t k = packing_pair(p, c->a, c->b);
    const double law = p->law ? p->law[k].impact : IMPACT_DEFAULT;
    bool shaped = p->shape && (p->shape[c->b] > 0 || (c->a >= 0 && p->shape[c->a] > 0));
    return p->mu[k] > 0 && p->en[k] > 0 &&
           (law == IMPACT_BOUNDED || (law == IMPACT_DEFAULT && shaped));
}

int packing_alloc_passages(struct packing *p, int32_t pours, int32_t removals,
                           struct failure *failure)
{
    free(p->poured), free(p->removed);
    p->poured = array(pours, sizeof *p->poured);
    p->removed = array(removals, sizeof *p->removed);
    p->pours = p->poured ? pours : 0, p->removals = p->removed ? removals : 0;
    return p->poured && p->removed ? 0
                                   : failure_set(failure, EX_SOFTWARE, "no memory for passages");
}

int packing_resize(struct packing *p, int64_t n, struct failure *failure)
{
    for (const struct field *b = body_columns; b->name; b++) {
        const struct field *c = b;
        size_t bytes = field_bytes(c);
        char *old = field_array(c, p);
        if (!old && is_optional(b)) continue;
        char *more = realloc(old, (n > 0 ? (size_t)n : 1) * bytes);
        if (!more)
            return failure_set(failure, EX_SOFTWARE, "no memory for %lld bodies", (long long)n);
        if (n > p->n) memset(more + (size_t)p->n * bytes, 0, (size_t)(n - p->n) * bytes);
        field_set_array(c, p, more);
    }
    int64_t had = p->n;
    if (external_force_resize(&p->outside, had, n, failure)) return failure->status;
    p->n = n;
    set_default(p, had);
    return 0;
}

void packing_copy_body(struct packing *p, int64_t to, const struct packing *from, int64_t i)
{
    for (const struct field *b = body_columns; b->name; b++)
        if (field_array(b, p) && field_array(b, from))
            memcpy(field_row(b, p, to), field_row(b, from, i), field_bytes(b));
}

struct packing packing_with_bodies(const struct packing *p, const struct packing *bodies,
                                   int64_t first, int64_t n)
{
    struct packing q = *p;
    q.n = n;
    for (const struct field *b = body_columns; b->name; b++)
        field_set_array(b, &q, field_array(b, bodies) ? field_row(b, bodies, first) : NULL);
    return q;
}

void packing_count_from(struct packing *p, double t0, int64_t step0)
{
    p->t0 = t0, p->step0 = step0;
    if (packing_time(p, p->step) != p->t) p->t0 = p->t, p->step0 = p->step;
}

/* Is the step n steps before this one exact as a double? */
static bool packing_step_fits(int64_t step, double n)
{
    return fabs((double)step - n) <= (double)((int64_t)1 << STEPS_LOG2);
}

void packing_set_dt(struct packing *p, double dt)
{
    double n = nearbyint((p->t - p->t0) / dt);
    p->dt = dt;
    if (fabs(n) < (double)((int64_t)1 << STEPS_LOG2) && packing_step_fits(p->step, n))
        p->step0 = p->step - (int64_t)n;
    packing_count_from(p, p->t0, p->step0);
}

int packing_check_clock(const struct packing *p, struct failure *failure)
{
    double t = fmax(fabs(p->t), fabs(packing_next_time(p)));
    double grain = nextafter(t, INFINITY) - t;
    if (grain <= p->dt) return 0;
    return failure_set(
        failure, EX_DATAERR,
        "dt = %g s does not change a time of %g s, where numbers are %.2g s apart: begin "
        "at an earlier time, or with a longer dt",
        p->dt, p->t, grain);
}

double packing_mean_mass(const struct packing *p)
{
    double sum = 0;
    int64_t n = 0;
    for (int64_t i = 0; i < p->n; i++) sum += p->mass[i], n += p->mass[i] > 0;
    return n ? sum / (double)n : 1;
}

struct whole packing_whole(const struct packing *p)
{
    if (p->whole) return *p->whole;
    struct whole all = { .small = INFINITY, .apart = -INFINITY };
    for (int64_t i = 0; i < p->n; i++) {
        double speed = v3_norm(p->v[i]);
        all.speed = dmax(all.speed, speed);
        all.rotation_speed = dmax(all.rotation_speed, speed + p->radius[i] * v3_norm(p->w[i]));
        all.small = dmin(all.small, p->radius[i]), all.large = dmax(all.large, p->radius[i]);
    }
    for (int64_t i = 0; i < p->bonds.n; i++)
        if (p->bonds.bond[i].beta > 0 && !bond_anchored(&p->bonds.bond[i]))
            all.apart = dmax(all.apart, p->bonds.bond[i].gap);
    return all;
}

static const char *body_trouble(const struct packing *p, int64_t i)
{
    if (p->mass[i] > 0 && !(p->inertia[i] > 0)) return "inertia must be positive where mass is";
    quat q = p->q[i];
    if (!(fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-6))
        return "orientation is not a unit quaternion";
    if (p->dim == 2 && (p->x[i].z != 0 || p->v[i].z != 0 || p->w[i].x != 0 || p->w[i].y != 0))
        return "leaves the plane z = 0, and dim is 2";
    if (p->shape && (p->shape[i] < 0 || p->shape[i] >= p->shapes.n)) return "has no such shape";
    if (p->dim == 2 && packing_shape(p, i) && (q.x != 0 || q.y != 0))
        return "rotates out of the plane, and dim is 2";
    if (p->material[i] < 0 || p->material[i] >= p->materials) return "material that is not there";
    if (p->group && (p->group[i] < 0 || p->group[i] > p->names.n)) return "group has no name";
    return NULL;
}

enum {
    SPREAD_MOST = 1000
}; /* walls, each of which may bound the face of each that a pressure is on */

static const char *packing_load_trouble(const struct packing *p, const struct wall *w)
{
    const struct load *l = &w->load;
    if (l->way == LOAD_NONE) return NULL;
    if (l->way < 0 || l->way >= LOAD_WAYS) return "its load neither translates nor rotates it";
    bool room = l->way == LOAD_ROOM; // [state/servo_box.h]
    if (!((l->mass > 0 || (room && l->mass == 0)) && isfinite(l->mass)))
        return "the mass of its load must be positive";
    if (!isfinite(l->rate) || (!room && l->rate != 0))
        return "it has a strain rate that is not finite, or no servo";
    if (room && l->mass > 0 && !l->spread) return "the load of its servo is no pressure";
    if (room && w->shape != WALL_PLANE) return "it belongs to a servo, and is no plane";
    if (!isfinite(l->force) || !isfinite(l->speed) || !isfinite(l->travel) || !v3_finite(l->point))
        return "its load is not finite";
    if (!(fabs(v3_dot(l->axis, l->axis) - 1) < 1e-6)) return "its load's axis is not a unit vector";
    bool turns = l->way == LOAD_TURNS;
    bool leaves = turns ? l->axis.x != 0 || l->axis.y != 0 : l->axis.z != 0;
    if (p->dim == 2 && (leaves || l->point.z != 0))
        return "its load leaves the plane, and dim is 2";
    if (l->spread < 0 || l->spread > 1 || (l->spread && (turns || w->shape != WALL_PLANE)))
        return "its pressure is not on a plane that translates";
    if (l->spread && p->walls > SPREAD_MOST)
        return "its pressure is on one of more than 1000 walls: give a force";
    if (l->spread && room && !(wall_face(p, w, p->t) > 0))
        return "its servo needs planes on all sides of its face, or a periodic cell";
    if (l->spread && !(wall_face(p, w, p->t) > 0))
        return "its pressure needs planes on all sides of its face, or a periodic cell: "
               "give a force";
    if (turns && w->shape == WALL_PLANE && !(v3_norm(v3_cross(l->axis, w->n)) < 1e-6))
        return "it rotates about another axis than its normal";
    return NULL;
}

/* Of a wall of the room [state/servo_box.h], beside the load of its first wall */
static const char *room_trouble(const struct packing *p, const struct wall *w,
                                const struct load *first)
{
    const struct load *l = &w->load;
    if (l->speed != first->speed || l->point.x != first->point.x || l->point.y != first->point.y ||
        l->point.z != first->point.z)
        return "its servo has another centre or growth than that of the walls before";
    if (v3_dot(l->axis, w->n) < 1 - 1e-9) return "its servo is not on the side of its normal";
    if (w->until < INFINITY) return "it belongs to a servo, and vanishes";
    for (int32_t k = w->first_drive; k < w->first_drive + w->drives; k++)
        if (p->drives.drive[k].turns) return "it belongs to a servo, and turns";
    if (load_grows_too_fast(l, p->dt))
        return "its room changes by more than a tenth in a step: take a smaller dt, a larger mass "
               "or slower rates";
    return NULL;
}

/* Do the loads of its walls make one room? */
static int check_room(const struct packing *p, struct failure *failure)
{
    const struct load *first = NULL;
    double mass = 0;
    for (int32_t i = 0; i < p->walls; i++) {
        const struct wall *w = &p->wall[i];
        if (w->load.way != LOAD_ROOM) continue;
        if (!first) first = &w->load;
        mass += w->load.mass;
        const char *trouble = room_trouble(p, w, first);
        if (trouble) return failure_set(failure, EX_DATAERR, "wall %d: %s", i, trouble);
    }
    if (first && first->speed != 0 && !(mass > 0))
        return failure_set(failure, EX_DATAERR, "the room of the walls grows, and has no mass");
    return 0;
}

static const char *wall_trouble(const struct packing *p, const struct wall *w)
{
    const char *trouble = wall_shape_trouble(w, p->dim);
    if (trouble) return trouble;
    bool mesh = w->shape == WALL_MESH;
    if (mesh && (w->first_element < 0 || w->first_element > p->mesh.elements ||
                 w->elements > p->mesh.elements - w->first_element))
        return "its mesh is missing";
    if (w->material < 0 || w->material >= p->materials) return "material that is not there";
    if (p->dim == 2 && w->belt.z != 0) return "belt leaves the plane, and dim is 2";
    return packing_load_trouble(p, w);
}

bool packing_wall_fits_edge(const struct packing *p, const struct wall *w, int k, double thick)
{
    struct wall_parts of = { .dim = p->dim, .drives = &p->drives, .mesh = &p->mesh };
    return !p->cell.repeats[k] || wall_fits_edge(w, &of, &p->cell, k, thick);
}

static int check_images(const struct packing *p, int64_t first, struct failure *failure)
{
    for (int64_t i = 0; p->image && i < p->n; i++)
        for (int k = 0; k < 3; k++)
            if (p->image[i][k] < -IMAGES_MOST || p->image[i][k] > IMAGES_MOST)
                return failure_set(failure, EX_DATAERR, "body %lld: image is out of range",
                                   (long long)(first + i));
    return 0;
}

int packing_check_walls(const struct packing *p, double thick, struct failure *failure)
{
    for (int32_t i = 0; cell_repeats(&p->cell) && i < p->walls; i++)
        for (int k = 0; k < 3; k++) {
            if (!packing_wall_fits_edge(p, &p->wall[i], k, thick))
                return failure_set(
                    failure, EX_DATAERR,
                    "wall %d: crosses a periodic edge of the cell, is nearer to it than a "
                    "grain is thick, or moves across it",
                    i);
            if (p->cell.repeats[k] && cell_moves(&p->cell, k))
                return failure_set(failure, EX_DATAERR,
                                   "wall %d: the edges along it move, so that its bodies' images "
                                   "would meet it at other speeds",
                                   i);
        }
    return 0;
}

/* The cell, which the largest body must fit into, and the images. */
static int check_cell(const struct packing *p, struct failure *failure)
{
    double most = 0;
    for (int64_t i = 0; cell_repeats(&p->cell) && i < p->n; i++) most = fmax(most, p->radius[i]);
    if (cell_check(&p->cell, p->dim, 2 * most, failure)) return failure->status;
    if (cell_repeats(&p->cell) != (p->image != NULL))
        return failure_set(failure, EX_DATAERR, "images without a periodic cell, or the reverse");
    if (check_images(p, 0, failure)) return failure->status;
    return packing_check_walls(p, 2 * most, failure);
}

static int packing_check_each_body(const struct packing *p, int64_t first, struct failure *failure)
{
    bool fits = true;
    for (const struct field *b = body_columns; b->name; b++)
        fits = fits && (!field_array(b, p) || field_fits(b, field_array(b, p), p->n));
    for (int64_t i = 0; i < p->n; i++) {
        const char *trouble = NULL;
        for (const struct field *b = body_columns; b->name && !fits; b++) {
            trouble = field_array(b, p) ? field_trouble(b, field_row(b, p, i)) : NULL;
            if (trouble)
                return failure_set(failure, EX_DATAERR, "body %lld: %s %s", (long long)(first + i),
                                   b->name, trouble);
        }
        if ((trouble = body_trouble(p, i)))
            return failure_set(failure, EX_DATAERR, "body %lld: %s", (long long)(first + i),
                               trouble);
    }
    return 0;
}

int packing_check_bodies(const struct packing *p, int64_t first, struct failure *failure)
{
    return packing_check_each_body(p, first, failure) || check_images(p, first, failure)
               ? failure->status
               : 0;
}

/* The numbers of a pair of materials */
static int check_pair(const struct packing *p, int32_t i, struct failure *failure)
{
    const struct field *bad = NULL;
    const char *trouble = NULL;
    for (const struct field *f = material_fields; f->name && !bad; f++)
        bad = (trouble = field_trouble(f, field_row(f, p, i))) ? f : NULL;
    for (const struct field *f = law_fields; p->law && f->name && !bad; f++)
        bad = (trouble = field_trouble(f, (char *)&p->law[i] + f->offset)) ? f : NULL;
    if (!bad && p->law) trouble = pair_law_trouble(&p->law[i]);
    if (!trouble && p->inert[i] != 0 && p->inert[i] != 1) trouble = "inert is neither 0 nor 1";
    if (!trouble) return 0;
    return failure_set(failure, EX_DATAERR, "the law of materials %s and %s: %s%s%s",
                       p->material_name[i / p->materials], p->material_name[i % p->materials],
                       bad ? bad->name : "", bad ? " " : "", trouble);
}

/* Do its materials break in a way that there is? */
static int check_breakage(const struct packing *p, struct failure *failure)
{
    if (!p->breakage) return 0;
    if (records_check(RECORDS(breakage_fields, p->materials, p->breakage), "breakage of material",
                      failure))
        return failure->status;
    if (!p->broken || !p->damage || !p->parent || !p->generation || !p->born)
        return failure_set(failure, EX_DATAERR,
                           "grains break, and have no damage, parent, generation or time of birth");
    for (int32_t k = 0; k < p->materials; k++) {
        const struct breakage *b = &p->breakage[k];
        const char *trouble = breakage_trouble(b);
        if (trouble)
            return failure_set(failure, EX_DATAERR, "breakage of material %s: %s",
                               p->material_name[k], trouble);
        if (b->strength > 0 && b->into == INTO_PIECES && !p->shape)
            return failure_set(
                failure, EX_DATAERR,
                "breakage of material %s: into pieces, and there is no table of shapes",
                p->material_name[k]);
    }
    return 0;
}

int packing_check(const struct packing *p, struct failure *failure)
{
    if (p->dim != 2 && p->dim != 3)
        return failure_set(failure, EX_DATAERR, "dim is %d, not 2 or 3", p->dim);
    if (!(p->dt > 0 && isfinite(p->dt)))
        return failure_set(failure, EX_DATAERR, "dt must be positive");
    if (!isfinite(p->t)) return failure_set(failure, EX_DATAERR, "time is not finite");
    if (!(p->theta >= 0 && p->theta <= 1))
        return failure_set(failure, EX_DATAERR, "theta must lie in [0, 1]");
    if (!v3_finite(p->g)) return failure_set(failure, EX_DATAERR, "gravity is not finite");
    if (external_force_check(&p->outside, p->dim, p->n, p->walls, failure)) return failure->status;
    if (p->dim == 2 && p->g.z != 0)
        return failure_set(failure, EX_DATAERR, "gravity leaves the plane, and dim is 2");
    for (int32_t i = 0; i < p->materials * p->materials; i++)
        if (check_pair(p, i, failure)) return failure->status;
    if (packing_check_each_body(p, 0, failure) || check_breakage(p, failure))
        return failure->status;
    if (p->walls > WALLS_BODY && (p->walls - WALLS_BODY) * p->n > WALLS_LEAST)
        return failure_set(
            failure, EX_DATAERR,
            "%lld bodies and %d walls: more than %d for each body: make a mesh of them",
            (long long)p->n, p->walls, WALLS_BODY);
    if (drives_check(&p->drives, p->walls, p->dim, "drive", failure) ||
        drives_check(&p->pushes, p->walls, p->dim, "push", failure))
        return failure->status; // before any wall is asked where it is
    if (records_check(RECORDS(wall_fields, p->walls, p->wall), "wall", failure))
        return failure->status;
    for (int32_t i = 0; i < p->walls; i++) {
        const char *trouble = wall_trouble(p, &p->wall[i]);
        if (trouble) return failure_set(failure, EX_DATAERR, "wall %d: %s", i, trouble);
    }
    if (check_room(p, failure)) return failure->status;
    if (names_check(&p->names, p->walls, p->wall, failure) ||
        sums_check(&p->sums, p->walls, p->wall, failure))
        return failure->status;
    for (int32_t i = 0; i < p->pushes.n; i++)
        if (!p->wall[p->pushes.drive[i].wall].load.way)
            return failure_set(failure, EX_DATAERR, "push %d: its wall is not load-controlled", i);
    if (pulls_check(&p->pulls, p->pulls_most, p->dim, failure)) return failure->status;
    if (mesh_check(&p->mesh, p->dim, failure)) return failure->status;
    if (bonds_check(&p->bonds, p->dim, p->n, p->walls, failure)) return failure->status;
    return check_cell(p, failure);
}

struct cell_flow packing_flow(const struct packing *p)
{
    struct cell_flow f;
    vec3 half[3], gain[3];
    cell_predict(&p->cell, step_ahead(p), half);
    cell_next_rate(&p->cell, p->t + p->dt, step_ahead(p), step_after(p), gain);
    for (int k = 0; k < 3; k++) gain[k] = v3_sub(gain[k], p->cell.rate[k]);
    cell_flow_init(&f, &p->cell, half, gain);
    return f;
}

/* Mass and inertia of a shape of this radius, as packing_solid() */
static void packing_solid_shape(int dim, const struct shape *s, double radius, double density,
                                double *mass, double *inertia)
{
    const double *m = s->moment;
    double mean = dim == 2 ? m[2] : (m[0] + m[1] + m[2]) / 3;
    *mass = density * s->volume * (dim == 2 ? radius * radius : radius * radius * radius);
    *inertia = *mass * radius * radius * mean;
}

void packing_solid(int dim, double radius, double density, double *mass, double *inertia)
{
    double r2 = radius * radius;
    if (dim == 2) {
        *mass = density * M_PI * r2;
        *inertia = 0.5 * *mass * r2;
        return;
    }
    *mass = density * 4.0 / 3 * M_PI * r2 * radius;
    *inertia = 0.4 * *mass * r2;
}

bool packing_set_body(struct packing *p, int64_t i, const struct new_body *b)
{
    double mass, inertia;
    if (b->shape)
        packing_solid_shape(p->dim, &p->shapes.s[b->shape], b->radius, b->density, &mass, &inertia);
    else
        packing_solid(p->dim, b->radius, b->density, &mass, &inertia);
    if (b->weighed) inertia *= b->mass / mass, mass = b->mass;
    p->x[i] = b->x, p->v[i] = b->v, p->w[i] = b->w, p->q[i] = b->q;
    p->radius[i] = b->radius, p->material[i] = b->material;
    p->mass[i] = b->fixed ? 0 : mass, p->inertia[i] = b->fixed ? 0 : inertia;
    if (p->shape) p->shape[i] = b->shape;
    if (p->group) p->group[i] = b->group;
    return b->fixed || (mass > 0 && inertia > 0);
}
