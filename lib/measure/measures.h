/*
 * measure/measures.h: the table of the measures. A measure is a file (measure/NAME.c) and its line in
 * the table: what it is called, what it needs, the numbers that it gives, and a function from a
 * snapshot to a table of them. Its formulas and their sources are in nsd-stat(1).
 */
#pragma once

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
    KEEPS_TO_BODIES,  /* bodies of groups and materials with the names */
};

struct measure {
    const char *name, *help;
    const struct quantity *quantity;
    bool list;  /* a row for each layer, bin ...; else one */
    bool usual; /* among those of a command that names none */
    enum needs needs;
    enum keeps_to keeps_to;
    bool remembers; /* it looks at frames before this one, where there are any */
    /* Adds to what is remembered of a frame what only this measure needs; NULL: nothing. Returns 0 or EX_SOFTWARE. */
    int (*keep)(struct frame_memory *now, const struct snapshot *s, struct failure *failure);
    /* Fills the table. A number that there is not is left NaN, with the reason by table_null().
       Returns 0 or EX_SOFTWARE. */
    int (*rows)(struct table *t, const struct snapshot *s, struct failure *failure);
};

extern const struct measure measure_fraction, measure_coordination, measure_contact_numbers,
    measure_fabric, measure_stress, measure_wall_forces, measure_energy, measure_temperature,
    measure_profile, measure_friction, measure_normal_forces, measure_tangential_forces,
    measure_mobilised, measure_pairs, measure_sizes, measure_segregation, measure_displacement,
    measure_surface, measure_flux, measure_grains, measure_strain, measure_names, measure_sums,
    measure_sums_by_name, measure_sums_by_face, measure_mixing, measure_residence,
    measure_departures, measure_lifetimes, measure_separations, measure_silhouette,
    measure_breakage, measure_grading;

/* The k-th; NULL past the last. */
const struct measure *measure_at(int k);
/* The one of that name, of n characters; NULL: none. */
const struct measure *measure_named(const char *name, size_t n);

/* t = the measure of a snapshot; to be freed. One without what it needs has no rows, and says why.
   Returns 0 or EX_SOFTWARE. */
int measure_run(struct table *t, const struct measure *m, const struct snapshot *s,
                struct failure *failure);

/*
 * Options in addition to the names of measures, from texts: options of nsd-stat, settings of a program.
 */

/* What nobody has asked for otherwise: 20 layers, which have a few grains where the height has a hundred; 50 bins,
   with enough contacts in each where there are a thousand */
#define ASKED_DEFAULT                                                                              \
    {                                                                                              \
        .axis = -1, .layers = 20, .bins = 50, .radius = INFINITY, .view = 1, .pixels = 400         \
    }
/* box X0,X1,Y0,Y1[,Z0,Z1]; layers AXIS:N; point X,Y,Z; plane NX,NY,NZ; radius M; bins N; distance M; only NAME,...; wear K;
   tracer MATERIAL, or large; sample M; view AXIS; window LEFT,RIGHT,LOWER,UPPER; pixels N; photo FILE.
   Returns 0, or EX_USAGE with "--name: trouble", where nothing has changed. */
int asked_set(struct asked *asked, const char *name, const char *text, struct failure *failure);
/* Is there one of that name? The names, NULL past the last */
bool asked_has(const char *name);
const char *asked_name(int k);

/* Measures of a snapshot, by their names, as JSON. */

enum { MOST_MEASURES = 32 }; /* at once */

/* chosen[MOST_MEASURES + 1] = those of the names "A,B,..." or "all", each once, ended by NULL. Returns 0, or EX_USAGE with
   "--measures: ...". */
int measured_choose(const struct measure **chosen, const char *names, struct failure *failure);
/* Does any of them look at earlier frames? */
bool measured_remember(const struct measure *const *chosen);
/* first, before = what they look back to from the next frame on; first only where the snapshot has none. Returns 0 or
   EX_SOFTWARE. */
int measured_keep(const struct measure *const *chosen, const struct snapshot *s,
                  struct frame_memory *first, struct frame_memory *before, struct failure *failure);
/* t[MOST_MEASURES] = the chosen ones, none where snapshot_init() has failed with this `why`; to be freed by measured_free in any case. Returns 0, EX_SOFTWARE, or EX_DATAERR where
   one of them cannot keep to what --only names. */
int measured_run(struct table *t, const struct measure *const *chosen, const struct snapshot *s,
                 struct failure *failure);
void measured_free(struct table *t);
/* {"step":...,"time":...,"bodies":...,"contacts":...,"unconverged":...,"NAME":{...},...,"why":{...}}, without an end of line */
void measured_json(FILE *out, const struct snapshot *s, const struct measure *const *chosen,
                   const struct table *t);

/* The units of the numbers of measures by their names, for who shows them. */

/* Of "measure.quantity", perhaps with ".more" behind it; in the plane, dim 2, per metre of depth. "": it has none, or there is
   no such number. */
const char *measure_unit(const char *name, int dim);
