/* measure/coordination.c: how many contacts bodies have. */
#include "measure/branch.h"
#include "measure/measures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct quantity quantities[] = {
    { "bodies", "1", 1, "number of movable bodies with their centre in the region" },
    { "contacts", "1", 1, "number of contacts: of non-zero normal force; if unsolved, touching" },
    { "z", "1", 1, "mean number of contacts per body" },
    { "neighbours", "1", 1, "mean number of grains and walls that a body touches, each once" },
    { "z_mechanical", "1", 1, "the same of bodies with more than one contact (Thornton 2000)" },
    { "z_without_rattlers", "1", 1,
      "the same of bodies that are not rattlers, without contacts of rattlers" },
    { "rattlers", "1", 1, "number of bodies with too few contacts to carry load" },
    { 0 },
};

/* Contacts without which a body bears nothing: two with friction, else one more than dimensions */
static int least_contacts(const struct snapshot *s)
{
    for (int64_t i = 0; i < s->s->n; i++)
        if (s->s->c[i].mu > 0) return 2;
    return s->p->dim + 1;
}

/* Of one of the bodies to which the measure keeps? */
static bool of_chosen(const struct snapshot *s, const struct contact *c)
{
    return snapshot_body(s, c->b) || (c->a >= 0 && snapshot_body(s, c->a));
}

/* Mean over bodies with at least `least` contacts; *n of them */
static double mean(const struct snapshot *s, const int32_t *count, int least, int64_t *n)
{
    int64_t sum = 0;
    *n = 0;
    for (int64_t i = 0; i < s->p->n; i++)
        if (count[i] >= least && counts_body(s, i)) sum += count[i], ++*n;
    return *n ? (double)sum / (double)*n : NAN;
}

enum { SHIFTS = 64 }; /* images of one body that another touches: more count again */

/* Is the shift of contact c none of shift[n]? */
static bool is_new(const struct contact *c, int8_t (*shift)[3], int n)
{
    for (int k = 0; k < n; k++)
        if (!memcmp(shift[k], c->shift, sizeof c->shift)) return false;
    return true;
}

/* Mean over bodies of those that they touch: faces that lie on each other touch at several places */
static double neighbours(const struct snapshot *s, int32_t *count)
{
    int8_t shift[SHIFTS][3];
    int64_t bodies;
    int n = 0;
    memset(count, 0, (size_t)s->p->n * sizeof *count);
    for (int64_t i = 0; i < s->s->n; i++) { // contacts of two bodies follow each other
        const struct contact *c = &s->s->c[i];
        if (i && (c[-1].a != c->a || c[-1].b != c->b)) n = 0;
        if (!branch_counts(s->s, i) || !is_new(c, shift, n)) continue;
        if (n < SHIFTS) memcpy(shift[n++], c->shift, sizeof c->shift);
        if (c->a >= 0) count[c->a]++;
        count[c->b]++;
    }
    return mean(s, count, 0, &bodies);
}

static int coordination_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    int64_t bodies, bearing, more, contacts = 0;
    double *at = table_row(t, failure);
    int32_t *count = counts_of(s);
    if (!at || !count) {
        free(count);
        return failure_set(failure, EX_SOFTWARE, "no memory to count contacts");
    }
    for (int64_t i = 0; i < s->s->n; i++)
        contacts += branch_counts(s->s, i) && of_chosen(s, &s->s->c[i]);
    double z = mean(s, count, 0, &bodies), mechanical = mean(s, count, 2, &more);
    if (counts_without_rattlers(count, s, least_contacts(s)))
        failure_set(failure, EX_SOFTWARE, "no memory to count contacts");
    double bears = mean(s, count, 1, &bearing), touched = neighbours(s, count);
    put(&at, (double)bodies), put(&at, (double)contacts);
    put(&at, z), put(&at, touched), put(&at, mechanical), put(&at, bears),
        put(&at, (double)(bodies - bearing));
    if (!bodies) table_null(t, "no body that moves is in the region");
    if (!more) table_null(t, "no body has two contacts");
    if (!bearing) table_null(t, "every body is a rattler");
    free(count);
    return failure->status;
}

const struct measure measure_coordination = {
    .name = "coordination",
    .help = "coordination numbers, rattlers",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_BODIES,
    .usual = true,
    .needs = NEEDS_CONTACTS,
    .rows = coordination_rows,
};

/* ---- how many bodies have how many ---- */

static const struct quantity numbers[] = {
    { "contacts", "1", 1, "number of contacts of a body" },
    { "bodies", "1", 1, "number of bodies with this number of contacts" },
    { "share", "1", 1, "fraction of all bodies" },
    { 0 },
};

static int coordination_number_rows(struct table *t, const struct snapshot *s,
                                    struct failure *failure)
{
    int32_t *count = counts_of(s), most = 0;
    int64_t all = 0;
    if (!count) return failure_set(failure, EX_SOFTWARE, "no memory to count contacts");
    for (int64_t i = 0; i < s->p->n; i++) {
        if (!counts_body(s, i)) count[i] = -1;
        all += count[i] >= 0;
        if (count[i] > most) most = count[i];
    }
    int64_t *bodies = calloc((size_t)(most > 0 ? most : 0) + 1, sizeof *bodies);
    if (!bodies) failure_set(failure, EX_SOFTWARE, "no memory to count contacts");
    for (int64_t i = 0; bodies && i < s->p->n; i++)
        if (count[i] >= 0) bodies[count[i]]++;
    for (int32_t k = 0; bodies && all && k <= most; k++) {
        double *at = table_row(t, failure);
        if (!at) break;
        put(&at, k), put(&at, (double)bodies[k]), put(&at, (double)bodies[k] / (double)all);
    }
    if (!all) table_null(t, "no body that moves is in the region");
    free(bodies), free(count);
    return failure->status;
}

const struct measure measure_contact_numbers = {
    .name = "contact_numbers",
    .help = "distribution of the number of contacts per body",
    .quantity = numbers,
    .keeps_to = KEEPS_TO_BODIES,
    .list = true,
    .needs = NEEDS_CONTACTS,
    .rows = coordination_number_rows,
};
