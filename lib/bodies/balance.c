/* bodies/balance.c: energy and momentum, summed over bodies and contacts [bodies/balance.h]. */
#include "bodies/balance.h"

#include "bodies/impulse.h"

/* Twice the mean velocities of a body over the step; of one that does not move, of what it does */
struct mean {
    vec3 v, w; /* m/s, rad/s */
    bool moves;
};

static struct mean mean_of(const struct packing *p, const struct impulses *sum, int32_t i)
{
    struct mean m = { v3_scale(2, p->v[i]), v3_scale(2, p->w[i]), p->mass[i] > 0 };
    if (!m.moves) return m;
    m.v = v3_axpy(v3_axpy(m.v, p->dt, p->g), 1 / p->mass[i], sum->force[i]);
    m.w = v3_axpy(m.w, 1 / p->inertia[i], sum->moment[i]);
    return m;
}

static void add_to(double t[3], double s, vec3 a)
{
    t[0] += s * a.x, t[1] += s * a.y, t[2] += s * a.z;
}

static void add_bodies(struct balance *b, const struct packing *p, const struct impulses *sum)
{
    double before = (1 - p->theta) * p->dt, after = p->theta * p->dt;
    for (int64_t i = 0; i < p->n; i++) {
        double m = p->mass[i];
        if (!(m > 0)) continue;
        struct mean twice = mean_of(p, sum, (int32_t)i);
        vec3 v = v3_sub(twice.v, p->v[i]), w = v3_sub(twice.w, p->w[i]);
        vec3 x = v3_axpy(v3_axpy(p->x[i], before, p->v[i]), after, v);
        b->kinetic += 0.5 * (m * v3_dot(v, v) + p->inertia[i] * v3_dot(w, w));
        b->potential -= m * v3_dot(p->g, x);
        b->gravity += 0.5 * p->dt * m * v3_dot(p->g, twice.v);
        add_to(b->momentum, m, v);
    }
}

static void add_freedoms(struct balance *b, const struct packing *p, const struct impulses *sum)
{
    for (int32_t k = 0; k < sum->freedoms.n; k++) {
        const struct freedom *f = &sum->freedoms.f[k];
        double change = impulses_change(sum, p, k), s = f->speed + change;
        b->kinetic += 0.5 * f->mass * s * s;
        b->loads += p->dt * f->force * (f->speed + 0.5 * change);
    }
}

/* J: r . u of the prescribed part of the velocities at contact c; and in *free that of the rest,
   their means over the step */
static double powers(const struct packing *p, const struct impulses *sum, const struct contact *c,
                     const struct push *o, double *free)
{
    double held = 0;
    *free = 0;
    for (int end = c->a < 0; end < 2; end++) {
        struct mean m = mean_of(p, sum, end ? c->b : c->a);
        double along = v3_dot(o->f, m.v), about = v3_dot(o->m, m.w);
        *(m.moves ? free : &held) += end ? 0.5 * (along + o->lb * about) : 0.5 * (o->la * about - along);
    }
    if (c->a < 0) held -= v3_dot(o->f, wall_held(&p->wall[-1 - c->a], c->x));
    vec3 across = cell_shift(p->cell.rate, c->shift);
    for (int32_t k = 0; k < sum->freedoms.n; k++) {
        const struct freedom *f = &sum->freedoms.f[k];
        vec3 g = freedom_direction(f, c);
        *free += v3_dot(o->f, g) * (f->speed + 0.5 * impulses_change(sum, p, k));
        if (f->boundary < 0) across = v3_axpy(across, -f->speed, g); // its speed is in the rate
    }
    held += v3_dot(o->f, across);
    return held;
}

static void add_contacts(struct balance *b, const struct packing *p, const struct contacts *s,
                         const struct impulses *sum)
{
    double ahead = (1 - p->theta) * p->dt;
    for (int64_t i = 0; i < s->n; i++) {
        const struct contact *c = &s->c[i];
        struct push o = push_of(p, ahead, c, s->found[i].r);
        double free, held = powers(p, sum, c, &o, &free);
        b->drives -= held;
        b->dissipation -= held + free;
        bool a_moves = c->a >= 0 && p->mass[c->a] > 0, b_moves = p->mass[c->b] > 0;
        if (!a_moves && b_moves) add_to(b->impulse, 1, o.f);
        if (a_moves && !b_moves) add_to(b->impulse, -1, o.f);
    }
}

int balance_step(struct balance *b, const struct packing *p, const struct contacts *s,
                 struct why *why)
{
    struct impulses sum;
    *b = (struct balance){ 0 };
    if (!impulses_init(&sum, p, (1 - p->theta) * p->dt, s, why)) {
        add_bodies(b, p, &sum);
        add_freedoms(b, p, &sum);
        add_contacts(b, p, s, &sum);
    }
    impulses_free(&sum);
    return why->status;
}
