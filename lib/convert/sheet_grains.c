/* convert/sheet_grains.c: grains as points, with all that a document says of each. */
#include "convert/sheet.h"

#include <string.h>

/* contacts[i], force[i] = how many contacts of grain i push, and the sum of their forces (N) */
static int sheet_add_contacts(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    const struct packing *p = m->packing;
    const struct contacts *t = m->contacts;
    int32_t *count = sheet_whole(s, "contacts", "", failure);
    double *force = sheet_real(s, "contact_force", "xyz", failure);
    if (failure->status) return failure->status;
    for (int64_t i = 0; i < t->n; i++) {
        const struct contact *c = &t->c[i];
        vec3 f = v3_scale(1 / p->dt, contact_in_space(c, t->found[i].r));
        for (int side = 0; side < 2; side++) {
            int32_t body = side ? c->b : c->a;
            if (body < 0) continue;
            count[body] += t->found[i].r[0] > 0;
            double sign = side ? 1 : -1, *to = force + 3 * (size_t)body;
            to[0] += sign * f.x, to[1] += sign * f.y, to[2] += sign * f.z;
        }
    }
    return 0;
}

int sheet_grains(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    const struct packing *p = m->packing;
    const size_t n = (size_t)p->n;
    s->shape = SHEET_POINT, s->of_points = true;
    for (int64_t i = 0; i < p->n; i++)
        if (sheet_add(s, 1, &p->x[i], failure)) return failure->status;
    int32_t *id = sheet_whole(s, "id", "", failure), *kind = sheet_whole(s, "kind", "", failure);
    double *radius = sheet_real(s, "radius", "", failure), *mass = sheet_real(s, "mass", "", failure);
    double *v = sheet_real(s, "velocity", "xyz", failure);
    double *w = sheet_real(s, "angular_velocity", "xyz", failure);
    double *q = sheet_real(s, "orientation", "wxyz", failure);
    int32_t *shape = p->shape ? sheet_whole(s, "shape", "", failure) : NULL;
    int32_t *group = p->group ? sheet_whole(s, "group", "", failure) : NULL;
    int32_t *image = p->image ? sheet_whole(s, "image", "xyz", failure) : NULL;
    if (failure->status) return failure->status;
    if (n && image) memcpy(image, p->image, n * sizeof *p->image);
    if (n && group) memcpy(group, p->group, n * sizeof *group);
    if (n && shape) memcpy(shape, p->shape, n * sizeof *shape);
    if (n) {
        memcpy(id, p->id, n * sizeof *id), memcpy(kind, p->kind, n * sizeof *kind);
        memcpy(radius, p->radius, n * sizeof *radius), memcpy(mass, p->mass, n * sizeof *mass);
        memcpy(v, p->v, n * sizeof *p->v), memcpy(w, p->w, n * sizeof *p->w);
        memcpy(q, p->q, n * sizeof *p->q);
    }
    return m->contacts && m->contacts->found ? sheet_add_contacts(s, m, failure) : 0;
}
