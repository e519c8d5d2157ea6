/*
 * convert/import_units.c: the unit systems of LAMMPS and LIGGGHTS [docs.lammps.org, units]. Those of grains are converted to
 * SI; those of atoms (real, metal, electron) are refused. lj has no units: its numbers are taken for SI.
 */
#include "convert/imported.h"

#include <stdio.h>

struct import_units {
    const char *name;
    double length, mass, time; /* m, kg, s; 0: not converted */
};

static const struct import_units systems[] = {
    { "si", 1, 1, 1 },
    { "lj", 1, 1, 1 },
    { "cgs", 1e-2, 1e-3, 1 },
    { "micro", 1e-6, 1e-15, 1e-6 }, /* picograms */
    { "nano", 1e-9, 1e-21, 1e-9 },  /* attograms */
    { "real", 0, 0, 0 },
    { "metal", 0, 0, 0 },
    { "electron", 0, 0, 0 },
};

enum { SYSTEMS = sizeof systems / sizeof systems[0] };

static const struct import_units *import_units_find(struct word name)
{
    for (int k = 0; k < SYSTEMS; k++)
        if (word_is(name, systems[k].name)) return &systems[k];
    return NULL;
}

bool import_are_units(struct word name)
{
    return import_units_find(name) != NULL;
}

int import_find_units(const struct import_units **units, struct words *w, struct word name)
{
    static const char cure[] = "units si, cgs, micro, nano and lj are read: convert the file";
    char trouble[120];
    *units = import_units_find(name);
    if (*units && (*units)->length > 0) return 0;
    snprintf(trouble, sizeof trouble, "%s; %s",
             *units ? "are units of atoms" : "is no unit system of LAMMPS", cure);
    return word_fault(w, name, trouble);
}

void import_to_si(struct imported *to)
{
    const struct import_units *u = to->units;
    if (!u) return;
    const double L = u->length, speed = L / u->time, density = u->mass / (L * L * L);
    struct imported_head *h = &to->head;
    h->origin = v3_scale(L, h->origin);
    for (int k = 0; k < 3; k++) h->edge[k] = v3_scale(L, h->edge[k]);
    for (int64_t i = 0; i < h->n; i++) {
        struct imported_ball *b = &to->ball[i];
        b->x = v3_scale(L, b->x), b->v = v3_scale(speed, b->v), b->w = v3_scale(1 / u->time, b->w);
        b->radius *= L, b->mass *= u->mass, b->density *= density;
    }
}
