/*
 * export/lammps.c: the text of LAMMPS' dumps, for OVITO and what else reads them: grains in SI units.
 * Only what every reader takes: neither UNITS nor TIME, with which MDAnalysis' cannot go on.
 * Types are kinds, counted from 1. The box is the cell where it repeats; else it goes as far as the
 * grains reach.
 */
#include "export/format.h"

#include <inttypes.h>

/* "pp" where the box repeats, "ff" where it does not */
static const char *ends(const struct box *b, int k)
{
    return b->repeats[k] ? "pp" : "ff";
}

static double part_of(vec3 a, int k)
{
    return k == 0 ? a.x : k == 1 ? a.y : a.z;
}

/* Does each edge run along its axis? */
static bool is_upright(const struct box *b)
{
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
            if (l != k && part_of(b->edge[k], l) != 0) return false;
    return true;
}

static void put_box(FILE *out, const struct packing *p)
{
    struct box b;
    moment_box(&b, p);
    bool upright = is_upright(&b); // else edges as they are, LAMMPS' general triclinic box
    fprintf(out, "ITEM: BOX BOUNDS %s%s %s %s\n", upright ? "" : "abc origin ", ends(&b, 0),
            ends(&b, 1), ends(&b, 2));
    for (int k = 0; k < 3; k++) {
        double from = part_of(b.origin, k);
        const vec3 e = b.edge[k];
        if (upright)
            fprintf(out, "%.17g %.17g\n", from, from + part_of(e, k));
        else
            fprintf(out, "%.17g %.17g %.17g %.17g\n", e.x, e.y, e.z, from);
    }
}

static int dump(FILE *out, const struct moment *m, enum part part, bool first, struct why *why)
{
    const struct packing *p = m->packing;
    (void)part, (void)first, (void)why;
    fprintf(out, "ITEM: TIMESTEP\n%" PRId64 "\nITEM: NUMBER OF ATOMS\n%" PRId64 "\n", p->step,
            p->n);
    put_box(out, p);
    fprintf(out, "ITEM: ATOMS id type x y z vx vy vz omegax omegay omegaz radius mass "
                 "quati quatj quatk quatw\n");
    for (int64_t i = 0; i < p->n; i++) {
        const vec3 x = p->x[i], v = p->v[i], w = p->w[i];
        const quat q = p->q[i];
        fprintf(out, "%" PRId32 " %" PRId32 " %.17g %.17g %.17g %.17g %.17g %.17g ", p->id[i],
                p->kind[i] + 1, x.x, x.y, x.z, v.x, v.y, v.z);
        fprintf(out, "%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", w.x, w.y, w.z,
                p->radius[i], p->mass[i], q.x, q.y, q.z, q.w);
    }
    return 0;
}

const struct format format_lammps = {
    .name = "lammps",
    .ending = "lammpstrj",
    .help = "LAMMPS' dump, for OVITO: grains",
    .joins = true,
    .write = dump,
};
