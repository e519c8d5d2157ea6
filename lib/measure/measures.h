/*
 * measure/measures.h: the table of the measures. A measure is a file (measure/NAME.c) and its line in
 * the table: what it is called, what it needs, the numbers that it gives, and a function from a
 * snapshot to a table of them. Its formulas and their sources are in nsd-stat(1).
 */
#ifndef NSD_MEASURES_H
#define NSD_MEASURES_H

#include "measure/snapshot.h"
#include "measure/table.h"

#include <stdbool.h>

enum needs {
    NEEDS_BODIES,          /* at least one */
    NEEDS_CONTACTS,        /* contacts, solved or not */
    NEEDS_FORCES,          /* contacts that are solved */
    NEEDS_BEFORE,          /* a frame before this one */
    NEEDS_CONTACTS_BEFORE, /* both have contacts */
    NEEDS_SUMS, /* sums over steps [state/wall_load.h], and the frame before if there is one */
};

/* What names of --only mean to a measure. Names of walls mean nothing to one of bodies, which is then of all. */
enum keeps_to {
    KEEPS_TO_NOTHING, /* it is of all bodies, or of none: names of bodies are refused */
    KEEPS_TO_WALLS,   /* walls and parts of them with the names */
    KEEPS_TO_BODIES,  /* bodies of groups and kinds with the names */
};

struct measure {
    const char *name, *help;
    const struct quantity *quantity;
    bool list;  /* a row for each layer, bin ...; else one */
    bool usual; /* among those of a command that names none */
    enum needs needs;
    enum keeps_to keeps_to;
    bool remembers; /* it looks at frames before this one, where there are any */
    /* Fills the table. A number that there is not is left NaN, with the reason by table_null().
       Returns 0 or EX_SOFTWARE. */
    int (*rows)(struct table *t, const struct snapshot *s, struct failure *failure);
};

extern const struct measure measure_fraction, measure_coordination, measure_contact_numbers,
    measure_fabric, measure_stress, measure_boundaries, measure_energy, measure_temperature,
    measure_profile, measure_friction, measure_normal_forces, measure_tangential_forces,
    measure_mobilised, measure_pairs, measure_sizes, measure_segregation, measure_displacement,
    measure_surface, measure_flux, measure_grains, measure_strain, measure_names, measure_sums,
    measure_sums_by_name, measure_sums_by_face, measure_mixing, measure_residence,
    measure_departures, measure_lifetimes, measure_separations;

/* The k-th; NULL past the last. */
const struct measure *measure_at(int k);
/* The one of that name, of n characters; NULL: none. */
const struct measure *measure_named(const char *name, size_t n);

/* t = the measure of a snapshot; to be freed. One without what it needs has no rows, and says why.
   Returns 0 or EX_SOFTWARE. */
int measure_run(struct table *t, const struct measure *m, const struct snapshot *s,
                struct failure *failure);

#endif
