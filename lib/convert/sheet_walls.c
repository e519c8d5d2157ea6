/*
 * convert/sheet_walls.c: walls as polygons, in the plane as lines, at the moment's time. A plane
 * is infinite: it is cut off where the region of the grains ends, and by the other planes.
 */
#include "convert/sheet.h"

#include "base/array.h"

#include "draw/outline.h"
#include "draw/walls.h"
#include "state/face_of.h"
#include "state/selection.h"

#include <math.h>
#include <stdlib.h>

/* Which wall each cell is of, and which of its faces */
struct owners {
    struct owner {
        int32_t wall, face;
    } * of;
    int64_t room;
    struct selection chosen; /* walls that are wanted */
};

static int sheet_walls_add_cell(struct sheet *s, struct owners *o, struct owner of, int corners,
                                const vec3 *corner, struct failure *failure)
{
    if (!array_grow(&o->of, &o->room, s->cells + 1, sizeof *o->of) || !o->of)
        return failure_set(failure, EX_SOFTWARE, "no memory for the walls");
    o->of[s->cells] = of;
    return sheet_add(s, corners, corner, failure);
}

static int sheet_walls_add_planes(struct sheet *s, struct owners *o, const struct packing *p,
                                  const struct extent *region, struct failure *failure)
{
    vec3 corner[WALLS_CORNERS];
    for (int32_t i = 0; i < p->walls && i < WALLS_PANELS; i++) {
        int corners = walls_polygon(p, i, region, corner);
        if (corners >= 2 && selection_wall(&o->chosen, p, i) &&
            sheet_walls_add_cell(s, o, (struct owner){ i, 0 }, corners, corner, failure))
            return failure->status;
    }
    return 0;
}

static int sheet_walls_add_outlines(struct sheet *s, struct owners *o, const struct packing *p,
                                    const struct extent *region, struct failure *failure)
{
    struct outline line;
    if (outline_init(&line, p, v3_norm(v3_sub(region->hi, region->lo)), failure))
        return failure->status;
    for (int64_t i = 0; p->dim == 3 && i < line.triangles && !failure->status; i++) {
        const struct owner of = { line.triangle[i].wall, line.triangle[i].face };
        if (selection_face(&o->chosen, p, of.wall, of.face))
            sheet_walls_add_cell(s, o, of, 3, line.triangle[i].corner, failure);
    }
    for (int64_t i = 0; p->dim == 2 && i < line.lines && !failure->status; i++) {
        const struct owner of = { line.line[i].wall, line.line[i].face };
        if (selection_face(&o->chosen, p, of.wall, of.face))
            sheet_walls_add_cell(s, o, of, 2, line.line[i].end, failure);
    }
    outline_free(&line);
    return failure->status;
}

static void sheet_walls_put(double *out, int64_t i, vec3 x)
{
    out[3 * i] = x.x, out[3 * i + 1] = x.y, out[3 * i + 2] = x.z;
}

static int sheet_walls_add_columns(struct sheet *s, const struct owners *o, const struct packing *p,
                                   struct failure *failure)
{
    int32_t *number = sheet_whole(s, "wall", "", failure),
            *material = sheet_whole(s, "material", "", failure);
    double *point = sheet_real(s, "point", "xyz", failure),
           *n = sheet_real(s, "normal", "xyz", failure);
    double *v = sheet_real(s, "velocity", "xyz", failure);
    if (failure->status) return failure->status;
    for (int64_t k = 0; o->of && k < s->cells; k++) {
        const struct wall *w = &p->wall[o->of[k].wall];
        vec3 x = wall_at(p, w, p->t);
        number[k] = o->of[k].wall, material[k] = w->material;
        sheet_walls_put(point, k, x), sheet_walls_put(n, k, wall_normal(p, w, p->t)),
            sheet_walls_put(v, k, wall_velocity(p, w, x));
    }
    return 0;
}

/* Of solved contacts: those on each cell's face, and their forces (N) on it. A face of several cells, a cylinder or a
   sphere, has them in each. */
static int sheet_walls_add_contacts(struct sheet *s, const struct owners *o,
                                    const struct export_frame *m, const struct wall_faces *faces,
                                    struct failure *failure)
{
    const struct packing *p = m->packing;
    const struct contacts *t = m->contacts;
    int32_t *count = sheet_whole(s, "contacts", "", failure);
    double *force = sheet_real(s, "contact_force", "xyz", failure);
    vec3 *sum = calloc((size_t)faces->n + 1, sizeof *sum);
    int32_t *pushes = calloc((size_t)faces->n + 1, sizeof *pushes);
    if (!sum || !pushes) failure_set(failure, EX_SOFTWARE, "no memory for the forces on walls");
    for (int64_t i = 0; !failure->status && i < t->n && t->c[i].a < 0; i++) {
        int32_t k = faces->first[-1 - t->c[i].a] + face_of_contact(faces, p, &t->c[i], 0);
        sum[k] = v3_axpy(sum[k], -1 / p->dt, contact_in_space(&t->c[i], t->found[i].r));
        pushes[k] += t->found[i].r[0] > 0;
    }
    for (int64_t k = 0; !failure->status && o->of && k < s->cells; k++) {
        int32_t face = faces->first[o->of[k].wall] + o->of[k].face;
        count[k] = pushes[face], sheet_walls_put(force, k, sum[face]);
    }
    free(sum), free(pushes);
    return failure->status;
}

/* Of the sums over steps since they began [state/wall_load.h]: mean force (N) and pressure (Pa), work of friction and
   normal force by way (J), volume worn away (m^3; 0 where the wall has no coefficient); nan without an area */
static int add_sums(struct sheet *s, const struct owners *o, const struct packing *p,
                    const struct wall_faces *faces, struct failure *failure)
{
    const double span = p->t - p->sums.since, by = span > 0 ? 1 / span : NAN;
    double *force = sheet_real(s, "mean_force", "xyz", failure);
    double *pressure = sheet_real(s, "mean_pressure", "", failure);
    double *friction = sheet_real(s, "friction_work", "", failure),
           *rub = sheet_real(s, "sliding_work", "", failure);
    double *wear = sheet_real(s, "wear", "", failure);
    for (int64_t k = 0; !failure->status && o->of && k < s->cells; k++) {
        const struct owner of = o->of[k];
        const struct face_sums *x = &p->sums.face[faces->first[of.wall] + of.face];
        double area = face_of_area(p, of.wall, of.face);
        sheet_walls_put(force, k, v3_scale(by, x->impulse));
        pressure[k] = isfinite(area) ? by * x->normal / area : NAN;
        friction[k] = x->friction, rub[k] = x->rub, wear[k] = p->wall[of.wall].wear * x->rub;
    }
    return failure->status;
}

static int sheet_walls_add_forces(struct sheet *s, const struct owners *o,
                                  const struct export_frame *m, struct failure *failure)
{
    const struct packing *p = m->packing;
    bool solved = m->contacts && m->contacts->found;
    struct wall_faces faces;
    if (!solved && !p->sums.n) return 0;
    if (face_of_init(&faces, p, solved, failure)) return failure->status;
    int32_t *face = sheet_whole(s, "face", "", failure);
    for (int64_t k = 0; !failure->status && o->of && k < s->cells; k++) face[k] = o->of[k].face;
    if (!failure->status && solved) sheet_walls_add_contacts(s, o, m, &faces, failure);
    if (!failure->status && p->sums.n) add_sums(s, o, p, &faces, failure);
    wall_faces_free(&faces);
    return failure->status;
}

int sheet_walls(struct sheet *s, const struct export_frame *m, struct failure *failure)
{
    const struct packing *p = m->packing;
    struct extent region = { 0 };
    struct owners o = { 0 };
    s->shape = p->dim == 2 ? SHEET_LINE : SHEET_POLYGON;
    if (m->only && m->only->walls) o.chosen = *m->only;
    if (region_of(&region, p) && !sheet_walls_add_planes(s, &o, p, &region, failure))
        sheet_walls_add_outlines(s, &o, p, &region, failure);
    if (!failure->status && !sheet_walls_add_columns(s, &o, p, failure))
        sheet_walls_add_forces(s, &o, m, failure);
    free(o.of);
    return failure->status;
}
