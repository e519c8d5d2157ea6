#include "step/substeps.h"

#include "solve/err.h"

#include <math.h>
#include <string.h>

void substeps_begin(struct substeps *s, const struct packing *p, int64_t parts)
{
    *s = (struct substeps){ .dt = p->dt,
                            .t = p->t,
                            .t0 = p->t0,
                            .step = p->step,
                            .step0 = p->step0,
                            .n = parts > 1 ? parts : 1 };
}

void substeps_free(struct substeps *s)
{
    contacts_free(&s->sum);
}

/* s: of the next part; the last one is what is left. */
static double length(const struct substeps *s)
{
    return s->made + 1 < s->n ? s->dt / (double)s->n : s->dt - s->done;
}

void substeps_enter(const struct substeps *s, struct packing *p)
{
    if (s->n == 1) return;
    p->dt = length(s), p->t = s->t + s->done;
    p->t0 = p->t, p->step0 = p->step = s->step;
    memory_scale(&p->memory, p->dt / (s->made ? s->dt / (double)s->n : s->dt));
}

void substeps_leave(const struct substeps *s, struct packing *p)
{
    if (s->n == 1) return;
    const bool moved = p->step > s->step;
    p->dt = s->dt;
    if (moved && s->made + 1 < s->n) {
        p->step = s->step;
        return;
    }
    memory_scale(&p->memory, (double)s->n);
    // where a later part cannot be made, the packing stays at its time, between two steps
    if (!moved && s->made) return;
    p->t0 = s->t0, p->step0 = s->step0;
    p->t = packing_time(p, p->step);
}

/* ---- contacts ---- */

/* The reaction r of contact c, in the basis of another contact of the same two bodies */
static void substeps_turn(double to[3], const struct contact *c, const double r[3],
                          const struct contact *d)
{
    const vec3 in_space = contact_in_space(c, r);
    to[0] = v3_dot(in_space, d->n), to[1] = v3_dot(in_space, d->t1);
    to[2] = v3_dot(in_space, contact_t2(d));
}

static void substeps_copy_one(struct contacts *to, const struct contacts *from, int64_t i)
{
    const int64_t k = to->n++;
    to->c[k] = from->c[i];
    if (from->found) to->found[k] = from->found[i];
    if (to->moment && from->moment) memcpy(to->moment[k], from->moment[i], sizeof *to->moment);
    if (to->law && from->law) to->law[k] = from->law[i];
}

/* The last of `to` is also contact i of `from`, of an earlier part. */
static void add_one(struct contacts *to, const struct contacts *from, int64_t i)
{
    const int64_t k = to->n - 1;
    double r[3];
    if (!from->found) return;
    substeps_turn(r, &from->c[i], from->found[i].r, &to->c[k]);
    for (int j = 0; j < 3; j++) to->found[k].r[j] += r[j];
    if (!to->moment || !from->moment) return;
    substeps_turn(r, &from->c[i], from->moment[i], &to->c[k]);
    for (int j = 0; j < 3; j++) to->moment[k][j] += r[j];
}

/* now = the contacts of both, with their sums; had is freed. */
static int substeps_join(struct contacts *had, struct contacts *now, struct failure *failure)
{
    struct contacts all = { 0 };
    int64_t i = 0;
    bool room = contacts_reserve(&all, had->n + now->n);
    all.n = had->n + now->n;
    room = room && !contacts_alloc_found(&all);
    if (room && (had->moment || now->moment)) room = !contacts_alloc_moment(&all);
    if (room && (had->law || now->law)) room = !contacts_alloc_laws(&all);
    if (!room) {
        contacts_free(&all);
        return failure_set(failure, EX_SOFTWARE, "no memory for the contacts of a divided step");
    }
    all.n = 0;
    for (int64_t k = 0; k < now->n; k++) {
        while (i < had->n && contact_compare(&had->c[i], &now->c[k]) < 0)
            substeps_copy_one(&all, had, i++);
        substeps_copy_one(&all, now, k);
        if (i < had->n && contact_compare(&had->c[i], &now->c[k]) == 0) add_one(&all, had, i++);
    }
    while (i < had->n) substeps_copy_one(&all, had, i++);
    contacts_free(had), contacts_free(now);
    *now = all;
    return 0;
}

/* ---- the report ---- */

static void add_balance(struct balance *to, const struct balance *b)
{
    to->change += b->change, to->gravity += b->gravity, to->drives += b->drives;
    to->loads += b->loads, to->dissipation += b->dissipation;
    to->bond_change += b->bond_change, to->broken += b->broken, to->gained += b->gained;
    to->implicit += b->implicit, to->rise += b->rise;
    to->projection += b->projection;
    to->peculiar = b->peculiar, to->peculiar_change += b->peculiar_change;
    for (int k = 0; k < 3; k++) to->impulse[k] += b->impulse[k], to->spun[k] += b->spun[k];
    to->kinetic = b->kinetic, to->potential = b->potential, to->bond_energy = b->bond_energy;
    for (int k = 0; k < 3; k++) to->momentum[k] = b->momentum[k];
}

/* to = what is reported of two parts, of which r is the later one */
static void add_report(struct report *to, const struct report *r)
{
    if (!(err_of(&r->err, r->criterion) <= err_of(&to->err, to->criterion))) {
        const double overlap = to->err.max_overlap;
        to->err = r->err;
        to->err.max_overlap = dmax(overlap, r->err.max_overlap);
    }
    to->err.max_overlap = dmax(to->err.max_overlap, r->err.max_overlap);
    add_balance(&to->balance, &r->balance);
    if (r->depth.deepest > to->depth.deepest)
        to->depth.deepest = r->depth.deepest,
        memcpy(to->depth.pair, r->depth.pair, sizeof to->depth.pair);
    if (r->depth.pinched > to->depth.pinched)
        to->depth.pinched = r->depth.pinched, to->depth.pinched_id = r->depth.pinched_id;
    if (r->fast > to->fast) to->fast = r->fast, to->fast_id = r->fast_id;
    to->watched = to->watched || r->watched;
    if (to->converged && !r->converged) memcpy(to->unsolved, r->unsolved, sizeof to->unsolved);
    to->endless = r->endless;
    to->balanced = to->balanced && r->balanced, to->converged = to->converged && r->converged;
    to->sweeps += r->sweeps, to->newton += r->newton;
    to->safeguarded += r->safeguarded, to->gave_up += r->gave_up;
    if (r->given_up) to->given_up = r->given_up;
    if (r->on_cpu) to->on_cpu = r->on_cpu;
    to->bus_to += r->bus_to, to->bus_from += r->bus_from, to->kernels += r->kernels;
    to->work += r->work, to->seconds += r->seconds, to->elapsed += r->elapsed;
    to->detection += r->detection;
}

void substeps_count(struct substeps *s)
{
    s->done += length(s), s->made++;
    s->ends = s->made == s->n;
}

int substeps_add(struct substeps *s, const struct packing *p, struct contacts *contacts,
                 struct report *r, struct failure *failure)
{
    const bool first = !s->made;
    substeps_count(s);
    r->substeps = s->made;
    if (s->n == 1) return 0;
    s->ends = s->ends || !report_made(r);
    if (!first && substeps_join(&s->sum, contacts, failure)) return failure->status;
    if (first)
        s->report = *r;
    else
        add_report(&s->report, r);
    if (!s->ends) {
        s->sum = *contacts, *contacts = (struct contacts){ 0 };
        return 0;
    }
    for (int64_t i = 0; contacts->found && i < contacts->n; i++)
        contacts->found[i].status = STATUS_SUMMED;
    memcpy(s->report.method, r->method, sizeof s->report.method);
    s->report.options = r->options, s->report.history = r->history;
    *r = s->report;
    r->t = p->t, r->err.contacts = contacts->n, r->substeps = s->made;
    return 0;
}
