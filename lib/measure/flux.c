/* measure/flux.c: bodies that cross a plane, or a disc in it, between frames. */
#include "measure/follow.h"
#include "measure/measures.h"

#include <math.h>

static const struct quantity quantities[] = {
    { "since", "s", 1, "time since the previous frame" },
    { "forth", "1", 1, "number of bodies that crossed along the normal" },
    { "back", "1", 1, "number of bodies that crossed against the normal" },
    { "mass_forth", "kg", 1, "mass of the bodies that crossed along the normal" },
    { "mass_back", "kg", 1, "mass of the bodies that crossed against the normal" },
    { "rate", "1/s", 1, "forth minus back, per time" },
    { "mass_rate", "kg/s", 1, "mass_forth minus mass_back, per time" },
    { 0 },
};

struct crossed {
    double bodies[2], mass[2]; /* forth, back */
};

/* The straight way from x to x + d: does the centre cross? */
static void flux_cross(struct crossed *n, const struct snapshot *s, vec3 x, vec3 d, double mass)
{
    const struct asked *a = s->asked;
    vec3 from = v3_sub(x, a->point);
    double before = v3_dot(from, a->normal), after = v3_dot(v3_add(from, d), a->normal);
    bool forth = before < 0 && after >= 0, back = before >= 0 && after < 0;
    if (!forth && !back) return;
    vec3 at = v3_axpy(from, before / (before - after), d);
    if (!(v3_norm(v3_axpy(at, -v3_dot(at, a->normal), a->normal)) <= a->radius)) return;
    n->bodies[back]++, n->mass[back] += mass;
}

/* Those that have come or gone between the frames: from where they came, or to where they went */
static int add_events(struct crossed *n, const struct snapshot *s, struct failure *failure)
{
    const struct packing *p = s->p;
    struct frame_memory now = { 0 };
    if (!p->events.n) return 0;
    if (frame_memory_set(&now, p, failure)) return failure->status;
    follow_chosen(&now, s);
    for (int64_t k = 0; k < p->events.n; k++) {
        const struct event *e = &p->events.e[k];
        const struct frame_memory_body *b = frame_memory_find(e->came ? &now : s->before, e->id);
        if (!b || !b->chosen) continue;
        vec3 way = frame_memory_way(p, e->came ? e->x : b->x, e->came ? b->x : e->x);
        flux_cross(n, s, e->came ? e->x : b->x, way, e->mass);
    }
    frame_memory_free(&now);
    return 0;
}

static int flux_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    const struct packing *p = s->p;
    struct crossed n = { { 0, 0 }, { 0, 0 } };
    double since = p->t - s->before->t, *at = table_row(t, failure);
    if (!at) return failure->status;
    if (!(v3_norm(s->asked->normal) > 0)) {
        table_null(t, "the plane is given by --plane");
        return 0;
    }
    for (int64_t i = 0; i < p->n; i++) {
        const struct frame_memory_body *then = frame_memory_find(s->before, p->id[i]);
        if (!then || !snapshot_body(s, i)) continue;
        // from where it would be now, had it come straight and never been replaced by an image
        vec3 way = v3_sub(frame_memory_place(p, i), then->x);
        flux_cross(&n, s, v3_sub(p->x[i], way), way, p->mass[i]);
    }
    if (add_events(&n, s, failure)) return failure->status;
    put(&at, since);
    for (int k = 0; k < 2; k++) put(&at, n.bodies[k]);
    for (int k = 0; k < 2; k++) put(&at, n.mass[k]);
    if (!(since > 0)) table_null(t, "no time has passed since the previous frame");
    put(&at, since > 0 ? (n.bodies[0] - n.bodies[1]) / since : NAN);
    put(&at, since > 0 ? (n.mass[0] - n.mass[1]) / since : NAN);
    return 0;
}

const struct measure measure_flux = {
    .name = "flux",
    .help = "bodies that cross a plane or an orifice",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_BODIES,
    .needs = NEEDS_BEFORE,
    .rows = flux_rows,
};
