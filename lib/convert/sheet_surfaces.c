/* convert/sheet_surfaces.c: the surfaces of grains that are no balls, as polygons: a cell for each. */
#include "draw/facets.h"
#include "convert/sheet.h"

#include <stdlib.h>

/* Which grain each cell is of */
struct sheet_cells {
    struct sheet *s;
    int64_t grain, room;
    int32_t *of;
    struct failure *failure;
};

static void sheet_add_cell(void *to, int corners, const vec3 *x)
{
    struct sheet_cells *c = to;
    if (c->failure->status) return;
    if (c->s->cells == c->room) {
        int64_t room = 2 * c->room + 64;
        int32_t *of = realloc(c->of, (size_t)room * sizeof *of);
        if (!of) {
            failure_set(c->failure, EX_SOFTWARE, "no memory for the surfaces of the grains");
            return;
        }
        c->of = of, c->room = room;
    }
    c->of[c->s->cells] = (int32_t)c->grain;
    sheet_add(c->s, corners, x, c->failure);
}

static void sheet_surfaces_put(double *out, int64_t k, vec3 x)
{
    out[3 * k] = x.x, out[3 * k + 1] = x.y, out[3 * k + 2] = x.z;
}

static void sheet_add_columns(struct sheet *s, const int32_t *of, const struct packing *p,
                        struct failure *failure)
{
    int32_t *id = sheet_whole(s, "id", "", failure), *kind = sheet_whole(s, "kind", "", failure),
            *shape = sheet_whole(s, "shape", "", failure);
    double *radius = sheet_real(s, "radius", "", failure), *mass = sheet_real(s, "mass", "", failure);
    double *v = sheet_real(s, "velocity", "xyz", failure);
    double *w = sheet_real(s, "angular_velocity", "xyz", failure);
    if (failure->status) return;
    for (int64_t k = 0; of && k < s->cells; k++) {
        int32_t i = of[k];
        id[k] = p->id[i], kind[k] = p->kind[i], shape[k] = p->shape[i];
        radius[k] = p->radius[i], mass[k] = p->mass[i];
        sheet_surfaces_put(v, k, p->v[i]), sheet_surfaces_put(w, k, p->w[i]);
    }
}

/* Of solved contacts: how many push each cell's grain, and the sum of their forces on it (N) */
static void sheet_surfaces_add_contacts(struct sheet *s, const int32_t *of, const struct export_frame *m,
                         struct failure *failure)
{
    const struct packing *p = m->packing;
    const struct contacts *t = m->contacts;
    int32_t *count = sheet_whole(s, "contacts", "", failure);
    double *force = sheet_real(s, "contact_force", "xyz", failure);
    vec3 *sum = calloc((size_t)p->n + 1, sizeof *sum);
    int32_t *pushes = calloc((size_t)p->n + 1, sizeof *pushes);
    if (!sum || !pushes) failure_set(failure, EX_SOFTWARE, "no memory for the forces on grains");
    for (int64_t i = 0; !failure->status && i < t->n; i++) {
        const struct contact *c = &t->c[i];
        vec3 f = v3_scale(1 / p->dt, contact_in_space(c, t->found[i].r));
        sum[c->b] = v3_add(sum[c->b], f), pushes[c->b] += t->found[i].r[0] > 0;
        if (c->a >= 0) sum[c->a] = v3_sub(sum[c->a], f), pushes[c->a] += t->found[i].r[0] > 0;
    }
    for (int64_t k = 0; !failure->status && of && k < s->cells; k++)
        count[k] = pushes[of[k]], sheet_surfaces_put(force, k, sum[of[k]]);
    free(sum), free(pushes);
}

int sheet_surfaces(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    const struct packing *p = m->packing;
    struct sheet_cells c = { .s = s, .failure = failure };
    struct facets f;
    s->shape = SHEET_POLYGON;
    if (facets_init(&f, m->detail, failure)) return failure->status;
    for (c.grain = 0; c.grain < p->n && !failure->status; c.grain++)
        if (packing_shape(p, c.grain) && export_frame_has(m, c.grain))
            facets_of(&f, p, c.grain, sheet_add_cell, &c);
    if (!failure->status) sheet_add_columns(s, c.of, p, failure);
    if (!failure->status && m->contacts && m->contacts->found) sheet_surfaces_add_contacts(s, c.of, m, failure);
    facets_free(&f);
    free(c.of);
    return failure->status;
}
