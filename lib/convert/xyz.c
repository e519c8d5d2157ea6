/*
 * convert/xyz.c: extended XYZ, for OVITO and ASE: the number of grains, a line that names the columns
 * (Properties) and the cell (Lattice, where it repeats), and a line a grain. The species is X, a
 * chemical symbol that stands for none: ASE takes no others; the material is a column. Lengths are in m,
 * the orientation is (x, y, z, w), as OVITO has it.
 */
#include "convert/format.h"

#include <inttypes.h>

static void xyz_put_cell(FILE *out, const struct packing *p)
{
    struct box b;
    const bool *r = p->cell.repeats;
    if (cell_repeats(&p->cell)) {
        export_frame_box(&b, p);
        const vec3 *e = b.edge;
        fprintf(out,
                "Lattice=\"%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\" "
                "Origin=\"%.17g %.17g %.17g\" ",
                e[0].x, e[0].y, e[0].z, e[1].x, e[1].y, e[1].z, e[2].x, e[2].y, e[2].z, b.origin.x,
                b.origin.y, b.origin.z);
    }
    fprintf(out, "pbc=\"%c %c %c\" ", r[0] ? 'T' : 'F', r[1] ? 'T' : 'F', r[2] ? 'T' : 'F');
}

static int write_xyz(FILE *out, const struct export_frame *m, enum part part, bool first,
                     struct failure *failure)
{
    const struct packing *p = m->packing;
    (void)part, (void)first, (void)failure;
    fprintf(out, "%" PRId64 "\n", p->n);
    xyz_put_cell(out, p);
    fprintf(out,
            "Properties=species:S:1:pos:R:3:id:I:1:material:I:1:radius:R:1:mass:R:1:velo:R:3:"
            "angular_velocity:R:3:orientation:R:4%s Step=%" PRId64 " Time=%.17g\n",
            p->image ? ":image:I:3" : "", p->step, p->t);
    for (int64_t i = 0; i < p->n; i++) {
        moment_tell(m, i, p->n);
        const vec3 x = p->x[i], v = p->v[i], w = p->w[i];
        const quat q = p->q[i];
        fprintf(out, "X %.17g %.17g %.17g %" PRId32 " %" PRId32 " %.17g %.17g ", x.x, x.y, x.z,
                p->id[i], p->material[i], p->radius[i], p->mass[i]);
        fprintf(out, "%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g", v.x, v.y, v.z,
                w.x, w.y, w.z, q.x, q.y, q.z, q.w);
        export_put_image(out, p, i);
        putc('\n', out);
    }
    return 0;
}

const struct format format_xyz = {
    .name = "xyz",
    .ending = "xyz",
    .help = "extended XYZ, for OVITO and ASE: grains",
    .joins = true,
    .write = write_xyz,
};
