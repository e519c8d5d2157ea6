#include "scene/scene_carry.h"

#include "contact/contact_law.h"
#include "scene/grains.h"

#include <stdlib.h>
#include <string.h>

/* Does the scene continue the run of the document? */
static bool continues(const struct scene *s, const struct packing *from)
{
    return s->t == from->t;
}

static bool same_vec(vec3 a, vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Is wall k of the packing that of the document, wherever it is? */
static bool same_wall(const struct packing *p, const struct scene *s, const struct packing *from,
                      int32_t k)
{
    if (k >= p->walls || k >= from->walls) return false;
    const struct wall *w = &p->wall[k], *v = &from->wall[k];
    bool same = !s->has_walls || same_vec(w->x, v->x);
    for (int i = 0; i < 3; i++) same = same && w->size[i] == v->size[i];
    return same && same_vec(w->n, v->n) && same_vec(w->along, v->along) && w->arc == v->arc &&
           w->shape == v->shape && w->side == v->side && w->elements == v->elements;
}

static bool same_walls(const struct packing *p, const struct scene *s, const struct packing *from)
{
    bool same = p->walls == from->walls;
    for (int32_t k = 0; same && k < p->walls; k++) same = same_wall(p, s, from, k);
    return same;
}

/* A document and where its bodies begin in p */
struct carried {
    struct packing *p;
    const struct scene *s;
    const struct packing *from;
    int64_t row;
};

/* What body or wall a of the document is in p; false: it is not there. */
static bool scene_carry_find(const struct carried *y, int32_t *a)
{
    if (*a < 0) return same_wall(y->p, y->s, y->from, -1 - *a);
    *a += (int32_t)y->row;
    return true;
}

/* Does the key of a pair mean in p what it means in the document? */
static bool has_images(const struct carried *y, const int8_t shift[3])
{
    for (int k = 0; k < 3; k++)
        if (shift[k] && !(y->p->cell.repeats[k] && y->from->cell.repeats[k])) return false;
    return true;
}

/* An anchor in the frame of a wall, which is counted from where the wall is described */
static vec3 move_anchor(const struct carried *y, int32_t wall, vec3 at)
{
    const struct pose was = wall_pose(y->from, &y->from->wall[wall], y->from->t),
                      now = wall_pose(y->p, &y->p->wall[wall], y->p->t);
    if (continues(y->s, y->from)) return at;
    return quat_turn_back(now.q, v3_sub(pose_of(&was, at), now.shift));
}

static int carry_bonds(const struct carried *y, struct failure *failure)
{
    struct packing *p = y->p;
    for (int64_t i = 0; p->law && i < y->from->bonds.n; i++) {
        struct bond b = y->from->bonds.bond[i];
        const int32_t wall = -1 - b.a;
        if (!scene_carry_find(y, &b.a)) continue;
        b.b += (int32_t)y->row;
        if (!has_images(y, b.shift) || !contact_law_carries(&p->law[packing_pair(p, b.a, b.b)], &b))
            continue;
        if (bond_anchored(&b) && b.a < 0) b.at_a = move_anchor(y, wall, b.at_a);
        if (!bonds_add(&p->bonds, &b))
            return failure_set(failure, EX_SOFTWARE, "no memory for the bonds");
    }
    return 0;
}

static int carry_memory(const struct carried *y, struct failure *failure)
{
    struct memory *m = &y->p->memory;
    const struct memory *from = &y->from->memory;
    if (!from->on || !continues(y->s, y->from)) return 0;
    struct recall *more = realloc(m->recall, (size_t)(m->n + from->n + 1) * sizeof *more);
    if (!more) return failure_set(failure, EX_SOFTWARE, "no memory for the last reactions");
    m->recall = more, m->room = m->n + from->n + 1, m->on = true;
    for (int64_t i = 0; i < from->n; i++) {
        struct recall x = from->recall[i];
        if (!scene_carry_find(y, &x.a) || !has_images(y, x.shift)) continue;
        x.b += (int32_t)y->row;
        m->recall[m->n++] = x;
    }
    return 0;
}

static int carry_force(const struct carried *y, const vec3 *from, vec3 **to,
                       struct failure *failure)
{
    if (!from) return 0;
    if (external_force_alloc(to, y->p->n, failure)) return failure->status;
    memcpy(*to + y->row, from, (size_t)y->from->n * sizeof *from);
    return 0;
}

static int carry_forces(const struct carried *y, struct failure *failure)
{
    const struct lasting *from = &y->from->outside.lasts;
    struct lasting *to = &y->p->outside.lasts;
    if (carry_force(y, from->force, &to->force, failure) ||
        carry_force(y, from->torque, &to->torque, failure))
        return failure->status;
    if (!from->push || !same_walls(y->p, y->s, y->from)) return 0;
    free(to->push);
    to->push = calloc((size_t)y->p->walls + 1, sizeof *to->push);
    if (!to->push) return failure_set(failure, EX_SOFTWARE, "no memory for forces on walls");
    memcpy(to->push, from->push, (size_t)y->p->walls * sizeof *to->push);
    return 0;
}

static int carry_run(const struct carried *y, struct failure *failure)
{
    struct packing *p = y->p;
    if (!continues(y->s, y->from)) return 0;
    for (int64_t i = 0; p->image && y->from->image && i < y->from->n; i++)
        memcpy(p->image[y->row + i], y->from->image[i], sizeof *p->image);
    if (p->overlap == OVERLAP_UNSAID) p->overlap = y->from->overlap;
    return carry_forces(y, failure);
}

/* The damage and the family of its bodies, where they may break further */
static void carry_breakage(const struct carried *y)
{
    struct packing *p = y->p;
    const struct packing *from = y->from;
    for (int64_t i = 0; p->breakage && from->breakage && i < from->n; i++) {
        p->damage[y->row + i] = from->damage[i], p->parent[y->row + i] = from->parent[i];
        p->generation[y->row + i] = from->generation[i], p->born[y->row + i] = from->born[i];
    }
}

/* Grains of pours are numbered from the first number that the document has for them. */
static void carry_account(struct packing *p, const struct scene *s, const struct packing *from)
{
    int64_t poured = 0, next = p->first_id;
    for (int32_t k = 0; k < s->pours; k++) {
        p->poured[k] = s->pour[k].poured;
        poured += p->poured[k].bodies;
    }
    for (int32_t k = 0; k < s->removals; k++) p->removed[k] = s->removal[k].removed;
    if (!poured) return;
    int64_t first = next > poured ? next - poured : 0;
    if (from && from->first_id > first) first = from->first_id;
    p->first_id = (int32_t)first;
}

int scene_carry(struct packing *p, const struct scene *s, const int64_t *row,
                struct failure *failure)
{
    const struct packing *first = NULL;
    for (int64_t g = 0; g < s->groups && !failure->status; g++) {
        const struct carried y = { p, s, s->bodies[g].document, row[g] };
        if (!y.from || s->bodies[g].foreign) continue;
        if (!first) first = y.from;
        carry_breakage(&y);
        if (!carry_bonds(&y, failure) && !carry_memory(&y, failure)) carry_run(&y, failure);
    }
    bonds_sort(&p->bonds), memory_sort(&p->memory);
    carry_account(p, s, first);
    return failure->status;
}

void scene_carry_dt(struct packing *p, const struct scene *s)
{
    for (int64_t g = 0; g < s->groups; g++) {
        const struct packing *from = s->bodies[g].document;
        if (!from || !p->memory.n || from->dt == p->dt) continue;
        memory_scale(&p->memory, p->dt / from->dt);
        return;
    }
}

/* How many rows are not of springs alone, which end with the stiffness */
static int64_t scene_carry_ties(const struct bonds *s)
{
    int64_t n = 0;
    for (int64_t i = 0; i < s->n; i++)
        n += !s->bond[i].pressed || s->bond[i].wet || s->bond[i].beta > 0;
    return n;
}

struct scene_lost scene_lost(const struct packing *p, const struct scene *s)
{
    struct scene_lost lost = { .bonds = -scene_carry_ties(&p->bonds) };
    const struct lasting *has = &p->outside.lasts;
    int64_t poured = 0;
    for (int32_t k = 0; k < s->pours; k++) poured += s->pour[k].poured.bodies;
    for (int64_t g = 0; g < s->groups; g++) {
        const struct packing *from = s->bodies[g].document;
        if (!from || s->bodies[g].foreign) continue;
        const struct lasting *had = &from->outside.lasts;
        const double dt = from->dt;
        if (!lost.file) lost.file = s->bodies[g].file;
        lost.bonds += scene_carry_ties(&from->bonds);
        lost.forces |= (had->force && !has->force) || (had->torque && !has->torque) ||
                       (had->push && !has->push);
        if (!continues(s, from)) continue;
        lost.steered |= from->outside.steered, lost.sums |= from->sums.n > 0;
        for (int32_t k = 0; k < from->pours && s->pours && !poured; k++)
            lost.poured |= from->poured[k].bodies > 0;
        if (!(s->dt > 0) && p->dt != dt) lost.dt = dt;
    }
    return lost;
}

/* ---- the clock, the walls and the cell of the first document ---- */

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
                               "%s: wall %d is of material \"%s\": name it under \"materials\"",
                               b->file, i, from->material_name[from->wall[i].material]);
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
void scene_carry_clock(struct packing *p, const struct scene *s)
{
    const struct packing *from = NULL;
    for (int64_t g = 0; g < s->groups && !from; g++) from = s->bodies[g].document;
    if (from) packing_count_from(p, from->t0, from->step0 - from->step);
}

int scene_carry_walls(struct packing *p, const struct scene *s, struct failure *failure)
{
    for (int64_t g = 0; g < s->groups && !s->has_walls; g++)
        if (s->bodies[g].document) return take_walls(p, s, &s->bodies[g], failure);
    return 0;
}

/* The whole cell of a document, its moments as if the document's time were the scene's */
static int take_cell(struct packing *p, const struct scene *s, const struct packing *from)
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

int scene_carry_cell(struct packing *p, const struct scene *s, struct failure *failure)
{
    const struct packing *from = NULL;
    for (int64_t g = 0; g < s->groups && !from; g++) from = s->bodies[g].document;
    bool repeats = from && cell_repeats(&from->cell);
    if (s->cell.goes_on && !repeats)
        return failure_set(failure, EX_DATAERR,
                           "cell: has no edges, and nor has the first document");
    if (!repeats || s->cell.none || (s->cell.given && !s->cell.goes_on)) return 0;
    if (s->cell.goes_on ? complete_cell(p, s, from) : take_cell(p, s, from))
        return failure_set(failure, EX_SOFTWARE, "no memory for the cell");
    return packing_alloc_images(p, failure);
}
