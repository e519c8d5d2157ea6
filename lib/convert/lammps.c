/*
 * convert/lammps.c: the text of LAMMPS' dumps, for OVITO and what else reads them: grains in SI units.
 * Only what every reader takes: neither UNITS nor TIME, with which MDAnalysis' cannot go on.
 * Types are kinds, counted from 1. The box is the cell where it repeats; else it goes as far as the
 * grains reach.
 */
#include "convert/format.h"

#include <inttypes.h>

/* "pp" where the box repeats, "ff" where it does not */
static const char *ends(const struct box *b, int k)
{
    return b->repeats[k] ? "pp" : "ff";
}

/* Edge 0 along x and edge 1 in the plane of x and y: the box of LAMMPS that every reader knows */
static bool is_restricted(const vec3 e[3])
{
    return e[0].x > 0 && e[0].y == 0 && e[0].z == 0 && e[1].y > 0 && e[1].z == 0 && e[2].z > 0;
}

/* Bounds of x, y and z as far as the tilted box reaches, each with its tilt: xy, xz, yz */
static void put_tilted(FILE *out, const struct box *b)
{
    const double xy = b->edge[1].x, xz = b->edge[2].x, yz = b->edge[2].y;
    const vec3 o = b->origin;
    double lo = fmin(fmin(0, xy + xz), fmin(xy, xz)), hi = fmax(fmax(0, xy + xz), fmax(xy, xz));
    fprintf(out, "ITEM: BOX BOUNDS xy xz yz %s %s %s\n", ends(b, 0), ends(b, 1), ends(b, 2));
    fprintf(out, "%.17g %.17g %.17g\n", o.x + lo, o.x + b->edge[0].x + hi, xy);
    fprintf(out, "%.17g %.17g %.17g\n", o.y + fmin(0, yz), o.y + b->edge[1].y + fmax(0, yz), xz);
    fprintf(out, "%.17g %.17g %.17g\n", o.z, o.z + b->edge[2].z, yz);
}

static void lammps_put_box(FILE *out, const struct packing *p)
{
    struct box b;
    export_frame_box(&b, p);
    const vec3 *e = b.edge, o = b.origin;
    bool restricted = is_restricted(e);
    if (restricted && e[1].x == 0 && e[2].x == 0 && e[2].y == 0) {
        fprintf(out, "ITEM: BOX BOUNDS %s %s %s\n", ends(&b, 0), ends(&b, 1), ends(&b, 2));
        fprintf(out, "%.17g %.17g\n%.17g %.17g\n%.17g %.17g\n", o.x, o.x + e[0].x, o.y,
                o.y + e[1].y, o.z, o.z + e[2].z);
        return;
    }
    if (restricted) {
        put_tilted(out, &b);
        return;
    }
    const double from[3] = { o.x, o.y, o.z };
    fprintf(out, "ITEM: BOX BOUNDS abc origin %s %s %s\n", ends(&b, 0), ends(&b, 1), ends(&b, 2));
    for (int k = 0; k < 3; k++)
        fprintf(out, "%.17g %.17g %.17g %.17g\n", e[k].x, e[k].y, e[k].z, from[k]);
}

static int dump(FILE *out, const struct export_frame *m, enum part part, bool first,
                struct failure *failure)
{
    const struct packing *p = m->packing;
    (void)part, (void)first, (void)failure;
    fprintf(out, "ITEM: TIMESTEP\n%" PRId64 "\nITEM: NUMBER OF ATOMS\n%" PRId64 "\n", p->step,
            p->n);
    lammps_put_box(out, p);
    fprintf(out,
            "ITEM: ATOMS id type x y z vx vy vz omegax omegay omegaz radius mass "
            "quati quatj quatk quatw%s\n",
            p->image ? " ix iy iz" : "");
    for (int64_t i = 0; i < p->n; i++) {
        moment_tell(m, i, p->n);
        const vec3 x = p->x[i], v = p->v[i], w = p->w[i];
        const quat q = p->q[i];
        fprintf(out, "%" PRId32 " %" PRId32 " %.17g %.17g %.17g %.17g %.17g %.17g ", p->id[i],
                p->kind[i] + 1, x.x, x.y, x.z, v.x, v.y, v.z);
        fprintf(out, "%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g", w.x, w.y, w.z,
                p->radius[i], p->mass[i], q.x, q.y, q.z, q.w);
        export_put_image(out, p, i);
        putc('\n', out);
    }
    return 0;
}

const struct format format_lammps = {
    .name = "lammps",
    .ending = "lammpstrj",
    .help = "LAMMPS dump, for OVITO: grains",
    .joins = true,
    .write = dump,
};
