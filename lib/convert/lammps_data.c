/*
 * convert/lammps_data.c: a data file of LAMMPS or LIGGGHTS [docs.lammps.org, read_data], atom_style sphere (LIGGGHTS:
 * granular): balls in SI units, with their velocities. Types are kinds, counted from 1. The box is the cell where it
 * is periodic, else as large as the grains need; along which edges it is periodic the file does not say.
 */
#include "convert/format.h"

#include <inttypes.h>

/* A data file has nothing but balls that move. */
static int lammps_check(const struct packing *p, struct failure *failure)
{
    if (p->dim == 2) return failure_set(failure, EX_DATAERR, "discs: a LAMMPS data file holds only balls");
    for (int64_t i = 0; i < p->n; i++) {
        if (packing_shape(p, i))
            return failure_set(
                failure, EX_DATAERR,
                "grain %" PRId32
                " is not a ball: a LAMMPS data file holds only balls; --to gsd writes shapes",
                p->id[i]);
        if (!(p->mass[i] > 0))
            return failure_set(failure, EX_DATAERR,
                           "grain %" PRId32 " is fixed: a LAMMPS data file needs a density of each",
                           p->id[i]);
    }
    return 0;
}

static int lammps_data_put_box(FILE *out, const struct packing *p, struct failure *failure)
{
    struct box b;
    export_frame_box(&b, p);
    const vec3 *e = b.edge, o = b.origin;
    if (!(e[0].x > 0 && e[0].y == 0 && e[0].z == 0 && e[1].y > 0 && e[1].z == 0 && e[2].z > 0))
        return failure_set(failure, EX_DATAERR,
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
            p->step, p->n, p->kinds);
    if (lammps_data_put_box(out, p, failure)) return failure->status;
    fputs("\nAtoms\n\n", out);
    for (int64_t i = 0; i < p->n; i++) {
        double mass, inertia;
        moment_tell(m, i, p->n);
        packing_solid(3, p->radius[i], 1, &mass, &inertia);
        fprintf(out, "%" PRId64 " %" PRId32 " %.17g %.17g %.17g %.17g %.17g", id_of(p, i),
                p->kind[i] + 1, 2 * p->radius[i], p->mass[i] / mass, p->x[i].x, p->x[i].y,
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
