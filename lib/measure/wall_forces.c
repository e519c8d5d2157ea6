/* measure/wall_forces.c: what pushes walls. */
#include "measure/branch.h"
#include "measure/measures.h"
#include "state/face_of.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What bodies do to a wall, or to all fixed bodies */
struct wall_forces_sum {
    int64_t contacts;
    vec3 force, torque; /* N, N m */
    double normal, tangential;
};

static const struct quantity quantities[] = {
    { "wall", "1", 1, "number of the wall; -1: all fixed bodies" },
    { "contacts", "1", 1, "number of contacts with non-zero normal force" },
    { "force", "N", 3, "force of the bodies on the wall" },
    { "torque", "N m", 3,
      "torque of the same about --point, rolling and pivoting friction included" },
    { "normal", "N", 1, "sum of normal forces" },
    { "tangential", "N", 1, "sum of the magnitudes of tangential forces" },
    { "name", "name", 1, "name of the wall" },
    { 0 },
};

/* Row of the wall's name; NaN: it has none */
static double name_row(const struct packing *p, int32_t wall)
{
    const char *name = names_of_wall(&p->names, wall);
    return name ? names_find(&p->names, name, strlen(name)) : NAN;
}

static void wall_forces_add(struct wall_forces_sum *to, const struct snapshot *s, int64_t i,
                            double sign)
{
    const double *r = s->s->found[i].r;
    to->contacts += branch_counts(s->s, i);
    to->force = v3_axpy(to->force, sign, branch_force(s->p, s->s, i));
    to->torque = v3_axpy(to->torque, sign, branch_torque(s->p, s->s, i, s->asked->point));
    to->normal += r[0] / s->p->dt;
    to->tangential += hypot(r[1], r[2]) / s->p->dt;
}

static int wall_forces_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    const struct packing *p = s->p;
    bool fixed = false;
    for (int64_t i = 0; i < p->n; i++) fixed = fixed || p->mass[i] == 0;
    // wall w at [w], fixed bodies behind them
    struct wall_forces_sum *push = calloc((size_t)p->walls + 1, sizeof *push);
    if (!push) return failure_set(failure, EX_SOFTWARE, "no memory for the forces on walls");
    for (int64_t i = 0; s->s->found && i < s->s->n; i++) {
        const struct contact *c = &s->s->c[i];
        if (c->a < 0)
            wall_forces_add(&push[-1 - c->a], s, i, -1);
        else if (p->mass[c->a] == 0)
            wall_forces_add(&push[p->walls], s, i, -1);
        if (p->mass[c->b] == 0) wall_forces_add(&push[p->walls], s, i, 1);
    }
    for (int32_t w = 0; w < p->walls + fixed; w++) {
        if (w < p->walls ? !snapshot_wall(s, w) : s->only.walls) continue;
        double *at = table_row(t, failure);
        if (!at) break;
        put(&at, w < p->walls ? w : -1), put(&at, (double)push[w].contacts);
        put_vec(&at, push[w].force), put_vec(&at, push[w].torque);
        put(&at, push[w].normal), put(&at, push[w].tangential);
        put(&at, w < p->walls ? name_row(p, w) : NAN);
    }
    free(push);
    return failure->status;
}

const struct measure measure_wall_forces = {
    .name = "walls",
    .help = "forces and torques on walls",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_WALLS,
    .list = true,
    .needs = NEEDS_FORCES,
    .rows = wall_forces_rows,
};

/* ---- by name ---- */

static const struct quantity of_names[] = {
    { "name", "name", 1, "name of walls or of parts of walls" },
    { "contacts", "1", 1, "number of contacts with non-zero normal force" },
    { "force", "N", 3, "force of the bodies on everything with this name" },
    { "torque", "N m", 3,
      "torque of the same about --point, rolling and pivoting friction included" },
    { "normal", "N", 1, "sum of normal forces" },
    { "tangential", "N", 1, "sum of the magnitudes of tangential forces" },
    { 0 },
};

static bool is_named(const struct names *n, int32_t name, int32_t wall, int32_t face)
{
    for (int32_t k = 0; k < n->rows; k++) {
        const struct named *r = &n->row[k];
        if (r->name != name || r->wall != wall) continue;
        if (!r->count || (face >= r->first && face < r->first + r->count)) return true;
    }
    return false;
}

static int wall_forces_names_rows(struct table *t, const struct snapshot *s,
                                  struct failure *failure)
{
    const struct packing *p = s->p;
    struct wall_faces faces = { 0 };
    struct wall_forces_sum *push = calloc((size_t)p->names.n + 1, sizeof *push);
    bool *any = calloc((size_t)p->names.n + 1, sizeof *any);
    if (!push || !any) failure_set(failure, EX_SOFTWARE, "no memory for the forces on walls");
    if (failure->status || face_of_init(&faces, p, true, failure)) goto end;
    if (!p->names.rows) table_null(t, "no wall and no part of one has a name");
    for (int32_t k = 0; k < p->names.rows; k++) any[p->names.row[k].name] = true;
    for (int64_t i = 0; s->s->found && i < s->s->n && s->s->c[i].a < 0; i++) {
        const struct contact *c = &s->s->c[i];
        int32_t face = face_of_contact(&faces, p, c, 0);
        for (int32_t k = 0; k < p->names.n; k++)
            if (any[k] && is_named(&p->names, k, -1 - c->a, face))
                wall_forces_add(&push[k], s, i, -1);
    }
    for (int32_t k = 0; k < p->names.n; k++) {
        if (!any[k] || (s->only.walls && !s->only.name[k])) continue;
        double *at = table_row(t, failure);
        if (!at) break;
        put(&at, k), put(&at, (double)push[k].contacts);
        put_vec(&at, push[k].force), put_vec(&at, push[k].torque);
        put(&at, push[k].normal), put(&at, push[k].tangential);
    }
end:
    free(push), free(any);
    wall_faces_free(&faces);
    return failure->status;
}

const struct measure measure_names = {
    .name = "names",
    .help = "forces and torques on walls and parts of walls, by name",
    .quantity = of_names,
    .keeps_to = KEEPS_TO_WALLS,
    .list = true,
    .needs = NEEDS_FORCES,
    .rows = wall_forces_names_rows,
};
