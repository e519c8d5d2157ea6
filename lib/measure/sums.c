/* measure/sums.c: what bodies have done to walls since the frame before, over all steps [state/wall_load.h]. */

#include "measure/measures.h"
#include "state/face_of.h"

#include <math.h>
#include <string.h>

#define NUMBERS                                                                                    \
    { "span", "s", 1, "time since the previous frame, or since the sums began" },                  \
        { "force", "N", 3, "mean force of the bodies over the span" },                             \
        { "torque", "N m", 3,                                                                      \
          "mean torque about --point over the span, rolling and pivoting friction included" },     \
        { "normal", "N", 1, "mean of the sum of normal forces" },                                  \
        { "tangential", "N", 1, "mean of the sum of magnitudes of tangential forces" },            \
        { "area", "m2", 1,                                                                         \
          "area, of a plane between planes upright to it or across the cell; null if infinite" },  \
        { "pressure", "Pa", 1, "normal over area" },                                               \
        { "power", "W", 1, "mean power of the bodies on the moving wall" },                        \
        { "friction", "J", 1,                                                                      \
          "energy dissipated by friction in the span, rolling and pivoting friction included" },   \
        { "sliding_work", "J", 1, "sum of normal force times sliding distance in the span" },      \
        { "wear", "m3", 1,                                                                         \
          "volume worn in the span by Archard's law, coefficient times sliding_work" },

static const struct quantity of_walls[] = {
    { "wall", "1", 1, "number of the wall" },
    { "name", "name", 1, "name of the wall" },
    NUMBERS{ 0 },
};
static const struct quantity of_names[] = {
    { "name", "name", 1, "name of walls or of parts of walls" },
    NUMBERS{ 0 },
};
static const struct quantity of_faces[] = {
    { "wall", "1", 1, "number of the wall" },
    { "name", "name", 1, "name of the part, else of the wall" },
    { "face", "1", 1, "number of the triangle, from 0; other walls have one face" },
    NUMBERS{ 0 },
};

/* What is summed for a row: faces of one wall or of several */
struct sum {
    struct face_sums x;
    double area, wear; /* m^2; m^3, NaN without a coefficient */
};

/* What a measure looks at */
struct look {
    const struct snapshot *s;
    const struct packing *p;
    struct wall_faces faces;
    const struct wall_sums *from; /* NULL: from 0 */
    double span;                  /* s */
};

static void look_free(struct look *l)
{
    wall_faces_free(&l->faces);
}

static int look_init(struct look *l, const struct snapshot *s, struct failure *failure)
{
    const struct packing *p = s->p;
    const struct wall_sums *before = s->before ? &s->before->sums : NULL;
    bool same = before && before->n == p->sums.n && before->since == p->sums.since;
    *l = (struct look){ .s = s, .p = p, .from = same ? before : NULL };
    l->span = p->t - (same ? s->before->t : p->sums.since);
    return face_of_init(&l->faces, p, false, failure);
}

/* Adds a face, from which that of the frame before is taken. */
static void sums_add(struct sum *to, const struct look *l, int32_t wall, int32_t face)
{
    const int32_t i = l->faces.first[wall] + face;
    struct face_sums x = l->p->sums.face[i];
    const struct face_sums none = { 0 }, *y = l->from ? &l->from->face[i] : &none;
    const double asked = l->s->asked->wear, own = l->p->wall[wall].wear,
                 k = asked > 0 ? asked : own;
    to->x.impulse = v3_add(to->x.impulse, v3_sub(x.impulse, y->impulse));
    to->x.moment = v3_add(to->x.moment, v3_sub(x.moment, y->moment));
    to->x.normal += x.normal - y->normal, to->x.tangential += x.tangential - y->tangential;
    to->x.work += x.work - y->work, to->x.friction += x.friction - y->friction;
    to->x.rub += x.rub - y->rub;
    to->area += face_of_area(l->p, wall, face);
    to->wear += k > 0 ? k * (x.rub - y->rub) : NAN;
}

static void sums_add_faces(struct sum *to, const struct look *l, int32_t wall, int32_t first,
                           int32_t count)
{
    for (int32_t k = first; k < first + count; k++) sums_add(to, l, wall, k);
}

static int32_t sums_count_of(const struct look *l, int32_t wall)
{
    return l->faces.first[wall + 1] - l->faces.first[wall];
}

static void put_sum(double **at, const struct look *l, const struct sum *sum)
{
    const double by = l->span > 0 ? 1 / l->span : NAN;
    const vec3 about = v3_cross(l->s->asked->point, sum->x.impulse);
    put(at, l->span), put_vec(at, v3_scale(by, sum->x.impulse));
    put_vec(at, v3_scale(by, v3_sub(sum->x.moment, about)));
    put(at, by * sum->x.normal), put(at, by * sum->x.tangential);
    put(at, isfinite(sum->area) ? sum->area : NAN);
    put(at, isfinite(sum->area) && sum->area > 0 ? by * sum->x.normal / sum->area : NAN);
    put(at, by * sum->x.work), put(at, sum->x.friction), put(at, sum->x.rub), put(at, sum->wear);
}

/* Why numbers are missing */
static void explain(struct table *t, const struct look *l)
{
    bool area = false, wear = false;
    for (int64_t i = 0; i < t->rows; i++) {
        const double *end = t->x + (i + 1) * t->width;
        area = area || !isfinite(end[-6]), wear = wear || !isfinite(end[-1]);
    }
    if (!(l->span > 0)) table_null(t, "no time has passed since the sums began");
    if (area || wear)
        table_null(t, "%s%s%s",
                   area ? "a wall without ends has no area, unless it is a plane between "
                          "others upright to it or across a periodic cell"
                        : "",
                   area && wear ? ", and " : "",
                   wear ? "wear needs a coefficient: --wear, or the key wear of the wall" : "");
}

static double sums_row_of(const struct packing *p, const char *name)
{
    return name ? names_find(&p->names, name, strlen(name)) : NAN;
}

static int walls_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    struct look l;
    if (look_init(&l, s, failure)) return failure->status;
    for (int32_t w = 0; w < s->p->walls; w++) {
        struct sum sum = { 0 };
        if (!snapshot_wall(s, w)) continue;
        double *at = table_row(t, failure);
        if (!at) break;
        sums_add_faces(&sum, &l, w, 0, sums_count_of(&l, w));
        put(&at, w), put(&at, sums_row_of(s->p, names_of_wall(&s->p->names, w)));
        put_sum(&at, &l, &sum);
    }
    explain(t, &l);
    look_free(&l);
    return failure->status;
}

static int sums_names_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    const struct names *names = &s->p->names;
    struct look l;
    if (look_init(&l, s, failure)) return failure->status;
    if (!names->rows) table_null(t, "no wall and no part of one has a name");
    for (int32_t k = 0, end; k < names->rows; k = end) { // rows are sorted by name
        struct sum sum = { 0 };
        for (end = k; end < names->rows && names->row[end].name == names->row[k].name; end++) {
            const struct named *r = &names->row[end];
            sums_add_faces(&sum, &l, r->wall, r->first,
                           r->count ? r->count : sums_count_of(&l, r->wall));
        }
        if (s->only.walls && !s->only.name[names->row[k].name]) continue;
        double *at = table_row(t, failure);
        if (!at) break;
        put(&at, names->row[k].name), put_sum(&at, &l, &sum);
    }
    explain(t, &l);
    look_free(&l);
    return failure->status;
}

static int faces_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    struct look l;
    if (look_init(&l, s, failure)) return failure->status;
    for (int32_t w = 0; w < s->p->walls && !failure->status; w++)
        for (int32_t k = 0; k < sums_count_of(&l, w); k++) {
            struct sum sum = { 0 };
            if (!snapshot_face(s, w, k)) continue;
            double *at = table_row(t, failure);
            if (!at) break;
            sums_add(&sum, &l, w, k);
            put(&at, w), put(&at, sums_row_of(s->p, names_of_face(&s->p->names, w, k))),
                put(&at, k);
            put_sum(&at, &l, &sum);
        }
    explain(t, &l);
    look_free(&l);
    return failure->status;
}

const struct measure measure_sums = {
    .name = "wall_loads",
    .help = "force, pressure, work and wear of each wall over all steps",
    .quantity = of_walls,
    .keeps_to = KEEPS_TO_WALLS,
    .list = true,
    .needs = NEEDS_SUMS,
    .rows = walls_rows,
};
const struct measure measure_sums_by_name = {
    .name = "wall_loads_by_name",
    .help = "the same by name, for walls and parts of walls",
    .quantity = of_names,
    .keeps_to = KEEPS_TO_WALLS,
    .list = true,
    .needs = NEEDS_SUMS,
    .rows = sums_names_rows,
};
const struct measure measure_sums_by_face = {
    .name = "wall_loads_by_face",
    .help = "the same by face: triangles of meshes, and other walls",
    .quantity = of_faces,
    .keeps_to = KEEPS_TO_WALLS,
    .list = true,
    .needs = NEEDS_SUMS,
    .rows = faces_rows,
};
