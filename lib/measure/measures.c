#include "measure/measures.h"

#include <math.h>
#include <string.h>

static const struct measure *const measures[] = {
    &measure_fraction,
    &measure_coordination,
    &measure_contact_numbers,
    &measure_fabric,
    &measure_stress,
    &measure_boundaries,
    &measure_energy,
    &measure_temperature,
    &measure_profile,
    &measure_friction,
    &measure_normal_forces,
    &measure_tangential_forces,
    &measure_mobilised,
    &measure_pairs,
    &measure_sizes,
    &measure_segregation,
    &measure_displacement,
    &measure_surface,
    &measure_flux,
    &measure_grains,
    &measure_strain,
    &measure_names,
    &measure_sums,
    &measure_sums_by_name,
    &measure_sums_by_face,
    &measure_mixing,
    &measure_residence,
    &measure_departures,
    &measure_lifetimes,
    &measure_separations,
    NULL,
};

const struct measure *measure_at(int k)
{
    return measures[k];
}

const struct measure *measure_named(const char *name, size_t n)
{
    for (int k = 0; measures[k]; k++)
        if (!strncmp(measures[k]->name, name, n) && !measures[k]->name[n]) return measures[k];
    return NULL;
}

/* Why this cannot be measured here, or NULL */
static const char *lacks(const struct snapshot *s, enum needs needs)
{
    if (!s->p->n) return "the frame has no bodies";
    if (needs == NEEDS_SUMS && !s->p->sums.n)
        return "the document has no sums over steps: nsd-step --sums keeps them";
    if ((needs == NEEDS_CONTACTS || needs == NEEDS_FORCES || needs == NEEDS_CONTACTS_BEFORE) &&
        !s->s)
        return "the frame has no contacts: steps find them, and nsd-step --contacts keeps them";
    if ((needs == NEEDS_BEFORE || needs == NEEDS_CONTACTS_BEFORE) && !s->before)
        return "no previous frame";
    if (needs == NEEDS_CONTACTS_BEFORE && !s->before->pair)
        return "the contacts of the previous frame were not read";
    if (needs == NEEDS_FORCES && !s->s->found && s->s->n)
        return "the contacts are not solved: use nsd-solve first";
    return NULL;
}

int measure_run(struct table *t, const struct measure *m, const struct snapshot *s, struct failure *failure)
{
    table_init(t, m->quantity);
    t->names = &s->p->names;
    const char *lack = lacks(s, m->needs);
    if (lack) {
        table_null(t, "%s", lack);
        return 0;
    }
    if (m->rows(t, s, failure)) return failure->status;
    const struct quantity *q = m->quantity;
    for (int k = 0, in = 0; k < t->width; k++, in++) {
        if (in == q->width) q++, in = 0;
        for (int64_t i = 0; i < t->rows && !quantity_is_name(q); i++)
            if (!isfinite(t->x[i * t->width + k]))
                table_null(t, "the value is out of the range of numbers");
    }
    return 0;
}
