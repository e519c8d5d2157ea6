#include "bodies/detect.h"

#include <stdlib.h>

static void law(struct contact *c, const struct packing *p, int32_t one, int32_t other)
{
    int32_t k = one * p->kinds + other;
    c->mu = p->mu[k], c->en = p->en[k], c->et = p->et[k];
}

static bool with_wall(struct contacts *out, const struct packing *p, int32_t w, int64_t i, vec3 x,
                      double gap)
{
    const struct wall *wall = &p->wall[w];
    vec3 at = v3_axpy(wall->x, p->t + (1 - p->theta) * p->dt, wall->v);
    double distance = v3_dot(v3_sub(x, at), wall->n), g = distance - p->radius[i];
    if (!(g <= gap) || p->mass[i] == 0) return true;
    struct contact *c = contacts_add(out, -1 - w, (int32_t)i);
    if (!c) return false;
    contact_basis(c, p->dim, wall->n);
    c->gap = g;
    c->x = v3_axpy(x, -distance, wall->n);
    law(c, p, wall->kind, p->kind[i]);
    return true;
}

static bool with_ball(struct contacts *out, const struct packing *p, int32_t a, int32_t b,
                      const vec3 *x, double gap)
{
    vec3 d = v3_sub(x[b], x[a]);
    double radii = p->radius[a] + p->radius[b], most = radii + gap, d2 = v3_dot(d, d);
    if (d2 > most * most * (1 + 1e-12)) return true; // clearly apart, without the root
    double distance = sqrt(d2), g = distance - radii;
    if (!(g <= gap)) return true;
    struct contact *c = contacts_add(out, a, b);
    if (!c) return false;
    // two balls in one place: any direction is as good, one against gravity parts them
    vec3 up = p->dim == 2 ? v3(0, 1, 0) : v3(0, 0, 1);
    contact_basis(c, p->dim, distance > 0 ? v3_scale(1 / distance, d) : up);
    c->gap = g;
    c->x = v3_axpy(x[a], p->radius[a] + 0.5 * g, c->n);
    law(c, p, p->kind[a], p->kind[b]);
    return true;
}

/* The predicted position q + (1 - theta) dt qdot of every body [globalmapapp1]; NULL: no memory */
static vec3 *predict(const struct packing *p)
{
    vec3 *x = malloc(((size_t)p->n + 1) * sizeof *x);
    for (int64_t i = 0; x && i < p->n; i++) x[i] = packing_predict(p, i);
    return x;
}

int detect_contacts(struct contacts *out, const struct packing *p, double gap,
                    struct neighbours *kept, struct why *why)
{
    struct neighbours once = { 0 }, *near = kept ? kept : &once;
    vec3 *x = predict(p);
    bool room = x;
    out->n = 0, contacts_free_found(out);
    int e = room ? neighbours_find(near, p, x, gap, kept, why) : 0;
    for (int32_t w = p->walls - 1; !e && room && w >= 0; w--)
        for (int64_t i = 0; room && i < p->n; i++) room = with_wall(out, p, w, i, x[i], gap);
    for (int64_t i = 0; !e && room && i < near->n; i++)
        room = with_ball(out, p, near->pair[i].a, near->pair[i].b, x, gap);
    free(x), neighbours_free(&once);
    if (e) return e;
    return room ? 0 : why_set(why, EX_SOFTWARE, "no memory for the contacts");
}
