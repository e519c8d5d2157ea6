/*
 * convert/sheet_contacts.c: contacts as lines from centre to centre, from a boundary's point of
 * contact to the centre; with forces in N, in space, where they are solved.
 */
#include "convert/sheet.h"

#include <math.h>

static int sheet_add_lines(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    const struct packing *p = m->packing;
    for (int64_t i = 0; i < m->contacts->n; i++) {
        const struct contact *c = &m->contacts->c[i];
        vec3 b = v3_add(p->x[c->b], cell_shift(p->cell.edge, c->shift));
        const vec3 end[2] = { c->a >= 0 ? p->x[c->a] : c->x, b };
        if (sheet_add(s, 2, end, failure)) return failure->status;
    }
    return 0;
}

static void sheet_put(double *out, int64_t i, vec3 x)
{
    out[3 * i] = x.x, out[3 * i + 1] = x.y, out[3 * i + 2] = x.z;
}

static int sheet_add_forces(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    const double dt = m->packing->dt;
    int32_t *status = sheet_whole(s, "status", "", failure);
    double *force = sheet_real(s, "force", "xyz", failure);
    double *normal = sheet_real(s, "normal_force", "", failure);
    double *tangential = sheet_real(s, "tangential_force", "", failure);
    if (failure->status) return failure->status;
    for (int64_t i = 0; i < m->contacts->n; i++) {
        const struct found *f = &m->contacts->found[i];
        status[i] = (int32_t)f->status; // NOLINT(bugprone-signed-char-misuse): 0, 1 or 2
        sheet_put(force, i, v3_scale(1 / dt, contact_in_space(&m->contacts->c[i], f->r)));
        normal[i] = f->r[0] / dt, tangential[i] = hypot(f->r[1], f->r[2]) / dt;
    }
    return 0;
}

int sheet_contacts(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    const struct packing *p = m->packing;
    s->shape = SHEET_LINE;
    if (!m->contacts) return 0;
    if (sheet_add_lines(s, m, failure)) return failure->status;
    int32_t *body = sheet_whole(s, "body", "ab", failure), *id = sheet_whole(s, "id", "ab", failure);
    double *point = sheet_real(s, "point", "xyz", failure), *n = sheet_real(s, "normal", "xyz", failure);
    double *gap = sheet_real(s, "gap", "", failure), *mu = sheet_real(s, "mu", "", failure);
    if (failure->status) return failure->status;
    for (int64_t i = 0; i < m->contacts->n; i++) {
        const struct contact *c = &m->contacts->c[i];
        body[2 * i] = c->a, body[2 * i + 1] = c->b;
        id[2 * i] = c->a >= 0 ? p->id[c->a] : c->a, id[2 * i + 1] = p->id[c->b];
        sheet_put(point, i, c->x), sheet_put(n, i, c->n);
        gap[i] = c->gap, mu[i] = c->mu;
    }
    return m->contacts->found ? sheet_add_forces(s, m, failure) : 0;
}
