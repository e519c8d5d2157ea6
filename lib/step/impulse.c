/* step/impulse.c: the reactions' impulses and moments [step/impulse.h]. */
#include "step/impulse.h"

#include "base/team.h"

#include <stdlib.h>

enum {
    CONTACTS_PER_THREAD = 8192 /* the fewest contacts that are worth a thread: 200 us of work */
};

static void push_b(struct impulses *sum, int32_t b, const struct push *o)
{
    sum->force[b] = v3_add(sum->force[b], o->f);
    sum->moment[b] =
        o->shaped ? v3_add(sum->moment[b], o->mb) : v3_axpy(sum->moment[b], o->lb, o->m);
}

static void push_a(struct impulses *sum, int32_t a, const struct push *o)
{
    sum->force[a] = v3_sub(sum->force[a], o->f);
    sum->moment[a] =
        o->shaped ? v3_add(sum->moment[a], o->ma) : v3_axpy(sum->moment[a], o->la, o->m);
}

/* Bodies are shared out, not contacts: each sum is one thread's, in the contacts' order. */
struct summing {
    struct impulses *sum;
    const struct packing *p;
    const struct contacts *s;
    int64_t parts;
};

static void sum_bodies(void *arg, int64_t first, int64_t end)
{
    const struct summing *y = arg;
    struct impulses *sum = y->sum;
    int64_t lo = y->p->n * first / y->parts, hi = y->p->n * end / y->parts;
    for (int64_t i = 0; i < y->s->n; i++) {
        const struct contact *c = &y->s->c[i];
        bool a = c->a >= lo && c->a < hi, b = c->b >= lo && c->b < hi;
        if (!a && !b) continue;
        struct push o = push_of(y->p, sum->ahead, sum->edge, c, y->s->found[i].r);
        if (b) push_b(sum, c->b, &o);
        if (a) push_a(sum, c->a, &o);
        if (!y->s->moment) continue;
        vec3 m = contact_in_space(c, y->s->moment[i]);
        if (b) sum->moment[c->b] = v3_add(sum->moment[c->b], m);
        if (a) sum->moment[c->a] = v3_sub(sum->moment[c->a], m);
    }
}

/* What the freedoms beyond the bodies' get */
static void sum_yields(struct impulses *sum, const struct packing *p, const struct contacts *s)
{
    for (int64_t i = 0; i < s->n && sum->freedoms.n; i++) {
        struct push o = push_of(p, sum->ahead, sum->edge, &s->c[i], s->found[i].r);
        for (int32_t k = 0; k < sum->freedoms.n; k++)
            sum->yield[k] += v3_dot(
                freedom_direction(&sum->freedoms.f[k], p, &s->c[i], sum->ahead, sum->edge), o.f);
    }
}

/* What the cell's rates gain in the step, by its gradient and by its freedoms */
static void find_flow(struct impulses *sum, const struct packing *p)
{
    vec3 gain[3];
    for (int k = 0; k < 3; k++) gain[k] = v3_sub(sum->next[k], p->cell.rate[k]);
    for (int32_t k = 0; k < sum->freedoms.n; k++) {
        const struct freedom *f = &sum->freedoms.f[k];
        if (!freedom_of_cell(f)) continue;
        freedom_gain(f, impulses_change(sum, p, k), gain);
    }
    cell_flow_init(&sum->flow, &p->cell, sum->edge, gain);
}

int impulses_init(struct impulses *sum, const struct packing *p, const struct contacts *s,
                  bool ended, struct failure *failure)
{
    size_t n = (size_t)p->n + 1;
    *sum = (struct impulses){ .ahead = ended ? -step_after(p) : step_ahead(p) };
    cell_predict(&p->cell, sum->ahead, sum->edge);
    if (!ended) cell_next_rate(&p->cell, p->t + p->dt, step_ahead(p), step_after(p), sum->next);
    if (freedoms_init(&sum->freedoms, p, sum->edge, ended, failure)) return failure->status;
    const struct external_force *o =
        &p->outside; // what is not 0 to begin with is not set to 0 first
    sum->force = o->force ? malloc(n * sizeof *sum->force) : calloc(n, sizeof *sum->force);
    sum->moment = o->torque ? malloc(n * sizeof *sum->moment) : calloc(n, sizeof *sum->moment);
    sum->yield = calloc((size_t)sum->freedoms.n + 1, sizeof *sum->yield);
    if (!sum->force || !sum->moment || !sum->yield)
        return failure_set(failure, EX_SOFTWARE, "no memory to move the bodies");
    for (int64_t i = 0; o->force && i < p->n; i++) sum->force[i] = v3_scale(p->dt, o->force[i]);
    for (int64_t i = 0; o->torque && i < p->n; i++) sum->moment[i] = v3_scale(p->dt, o->torque[i]);
    const double middle = p->t + (ended ? -p->dt : p->dt) / 2;
    for (int64_t i = 0; p->pulls.n && i < p->n; i++) {
        sum->force[i] = v3_axpy(sum->force[i], p->dt, packing_pull(p, i, middle, false));
        sum->moment[i] = v3_axpy(sum->moment[i], p->dt, packing_pull(p, i, middle, true));
    }
    struct summing y = { sum, p, s, s->n < CONTACTS_PER_THREAD ? 1 : team_size() };
    team_share(team_size(), y.parts, 1, sum_bodies, &y);
    sum_yields(sum, p, s);
    if (!ended) find_flow(sum, p);
    return 0;
}

void impulses_free(struct impulses *sum)
{
    free(sum->force), free(sum->moment), free(sum->yield);
    freedoms_free(&sum->freedoms);
    *sum = (struct impulses){ 0 };
}
