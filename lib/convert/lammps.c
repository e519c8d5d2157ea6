/*
 * convert/lammps.c: the text of LAMMPS' dumps, for OVITO and what else reads them: grains in SI units.
 * Only what every reader takes: neither UNITS nor TIME, with which MDAnalysis' cannot go on.
 * Types are materials, counted from 1. The box is the cell where it repeats; else it goes as far as the
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
                p->material[i] + 1, x.x, x.y, x.z, v.x, v.y, v.z);
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

/*
 * A data file of LAMMPS or LIGGGHTS [docs.lammps.org, read_data], atom_style sphere (LIGGGHTS:
 * granular): balls in SI units, with their velocities. Types are materials, counted from 1. The box is the cell where it
 * is periodic, else as large as the grains need; along which edges it is periodic the file does not say.
 */

/* A data file has nothing but balls that move. */
static int lammps_check(const struct packing *p, struct failure *failure)
{
    if (p->dim == 2)
        return failure_set(failure, EX_DATAERR, "discs: a LAMMPS data file holds only balls");
    for (int64_t i = 0; i < p->n; i++) {
        if (packing_shape(p, i))
            return failure_set(
                failure, EX_DATAERR,
                "grain %" PRId32
                " is not a ball: a LAMMPS data file holds only balls; --to gsd writes shapes",
                p->id[i]);
        if (!(p->mass[i] > 0))
            return failure_set(
                failure, EX_DATAERR,
                "grain %" PRId32 " is fixed: a LAMMPS data file needs a density of each", p->id[i]);
    }
    return 0;
}

static int lammps_data_put_box(FILE *out, const struct packing *p, struct failure *failure)
{
    struct box b;
    export_frame_box(&b, p);
    const vec3 *e = b.edge, o = b.origin;
    if (!(e[0].x > 0 && e[0].y == 0 && e[0].z == 0 && e[1].y > 0 && e[1].z == 0 && e[2].z > 0))
        return failure_set(
            failure, EX_DATAERR,
            "the cell's first edge is not along x, or the second not in the plane of x "
            "and y: a LAMMPS data file has no such box; --to lammps does");
    fprintf(out, "%.17g %.17g xlo xhi\n%.17g %.17g ylo yhi\n%.17g %.17g zlo zhi\n", o.x,
            o.x + e[0].x, o.y, o.y + e[1].y, o.z, o.z + e[2].z);
    if (e[1].x != 0 || e[2].x != 0 || e[2].y != 0)
        fprintf(out, "%.17g %.17g %.17g xy xz yz\n", e[1].x, e[2].x, e[2].y);
    return 0;
}

/* LAMMPS counts from 1, and nsd from 0. */
static int64_t id_of(const struct packing *p, int64_t i)
{
    return (int64_t)p->id[i] + 1;
}

static int write_data(FILE *out, const struct export_frame *m, enum part part, bool first,
                      struct failure *failure)
{
    const struct packing *p = m->packing;
    (void)part, (void)first;
    if (lammps_check(p, failure)) return failure->status;
    fprintf(out,
            "# nsd, step %" PRId64 ": SI units\n\n%" PRId64 " atoms\n%" PRId32 " atom types\n\n",
            p->step, p->n, p->materials);
    if (lammps_data_put_box(out, p, failure)) return failure->status;
    fputs("\nAtoms\n\n", out);
    for (int64_t i = 0; i < p->n; i++) {
        double mass, inertia;
        moment_tell(m, i, p->n);
        packing_solid(3, p->radius[i], 1, &mass, &inertia);
        fprintf(out, "%" PRId64 " %" PRId32 " %.17g %.17g %.17g %.17g %.17g", id_of(p, i),
                p->material[i] + 1, 2 * p->radius[i], p->mass[i] / mass, p->x[i].x, p->x[i].y,
                p->x[i].z);
        export_put_image(out, p, i);
        putc('\n', out);
    }
    fputs("\nVelocities\n\n", out);
    for (int64_t i = 0; i < p->n; i++)
        fprintf(out, "%" PRId64 " %.17g %.17g %.17g %.17g %.17g %.17g\n", id_of(p, i), p->v[i].x,
                p->v[i].y, p->v[i].z, p->w[i].x, p->w[i].y, p->w[i].z);
    return 0;
}

const struct format format_lammps_data = {
    .name = "data",
    .ending = "data",
    .help = "LAMMPS or LIGGGHTS data file: balls",
    .write = write_data,
};
