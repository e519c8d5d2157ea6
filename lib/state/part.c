#include "state/part.h"

#include "state/breakage.h"
#include "state/fields.h"
#include "state/wall_faces.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A table of one field, whose rows are numbers and no structs */
#define ALONE(type_, width_, name_, unit_, traits_)                                                \
    (const struct field[])                                                                         \
    {                                                                                              \
        { .name = (name_),                                                                         \
          .units = (unit_),                                                                        \
          .type = COLUMN_##type_,                                                                  \
          .width = (width_),                                                                       \
          .traits = (traits_) },                                                                   \
            { 0 },                                                                                 \
    }
/* An array, with room for more rows than there are where `spare` is not 0 */
#define ARRAY(one, much, marks, rows, number, of, spare, ...)                                      \
    {                                                                                              \
        .name = (one), .many = (much), .traits = (marks), .array = offsetof(struct packing, rows), \
        .bytes = sizeof *((struct packing *)NULL)->rows, .how = (number),                          \
        .count = offsetof(struct packing, of), .room = (spare), .fields = __VA_ARGS__              \
    }
#define SETTING(one, many, array, count, fields)                                                   \
    ARRAY(one, many, PART_SETTING, array, PART_I32, count, 0, fields)
#define LIST(one, many, array, count, spare, ...)                                                  \
    ARRAY(one, many, 0, array, PART_I64, count, offsetof(struct packing, spare), __VA_ARGS__)
#define FORCE(array, unit)                                                                         \
    ARRAY("force", "forces", PART_BODY, array, PART_I64, n, 0, ALONE(F64, 3, "force", unit, 0))
#define PUSH(array)                                                                                \
    ARRAY("push", "pushes", 0, array, PART_I32, walls, 0, ALONE(F64, 1, "push", "N, N m", 0))
#define TEXTS(one, many, traits, array, how, count)                                                \
    ARRAY(one, many, (traits) | PART_TEXT, array, how, count, 0,                                   \
          ALONE(I8, 1, "text", NULL, FIELD_SAME))

#define BODY(ctype, member, type, width, name, unit, bounds, traits)                               \
    ARRAY("body", "bodies", PART_BODY, member, PART_I64, n, 0,                                     \
          ALONE(type, width, name, unit, traits)),
#define STEERED(member)                                                                            \
    (offsetof(struct packing, member) == offsetof(struct packing, mu) ? FIELD_STEERED : 0)
#define PAIR(member, name, unit, ...)                                                              \
    ARRAY("pair of materials", "pairs of materials", PART_SETTING, member, PART_SQUARE, materials, \
          0, ALONE(F64, 1, name, unit, FIELD_SAME | STEERED(member))),

const struct part packing_parts[] = {
    EACH_BODY_COLUMN(BODY) // rows of macros end with commas
    TEXTS("material", "materials", PART_SETTING, material_name, PART_I32, materials),
    EVERY_PAIR_COLUMN(PAIR) // these, too
    ARRAY("pair of materials", "pairs of materials", PART_SETTING, law, PART_SQUARE, materials, 0,
          law_fields),
    ARRAY("breakage of material", "materials that break", PART_SETTING, breakage, PART_I32,
          materials, 0, breakage_fields),
    ARRAY("material", "materials", 0, broken, PART_I32, materials, 0, broken_fields),
    SETTING("wall", "walls", wall, walls, wall_fields),
    ARRAY("load", "walls", PART_SETTING | PART_AGAIN, wall, PART_I32, walls, 0, load_fields),
    SETTING("drive", "drives", drives.drive, drives.n, drive_fields),
    SETTING("row of drives", "rows of drives", drives.row, drives.rows, drive_row_fields),
    SETTING("push", "pushes", pushes.drive, pushes.n, drive_fields),
    SETTING("row of pushes", "rows of pushes", pushes.row, pushes.rows, drive_row_fields),
    SETTING("force", "forces", pulls.drive, pulls.n, pull_fields),
    SETTING("row of forces", "rows of forces", pulls.row, pulls.rows, drive_row_fields),
    SETTING("mesh", "vertices of meshes", mesh.vertex, mesh.vertices, vertex_fields),
    SETTING("mesh", "elements of meshes", mesh.element, mesh.elements, element_fields),
    TEXTS("name", "names", PART_SETTING, names.text, PART_I32, names.n),
    SETTING("row of names", "rows of names", names.row, names.rows, named_fields),
    SETTING("cell", "moments of the cell", cell.gradient, cell.gradients, gradient_fields),
    SETTING("cell", "factors of the cell", cell.factor, cell.factors, factor_fields),
    TEXTS("scene", "scenes", 0, scene, PART_ONE_TEXT, scene),
    LIST("bond", "bonds", bonds.bond, bonds.n, bonds.room, bond_fields),
    LIST("reaction", "reactions", memory.recall, memory.n, memory.room, recall_fields),
    LIST("event", "events", events.e, events.n, events.room, event_fields),
    ARRAY("face", "faces", 0, sums.face, PART_I32, sums.n, 0, sum_fields),
    ARRAY("pour", "pours", 0, poured, PART_I32, pours, 0, poured_fields),
    ARRAY("removal", "removals", 0, removed, PART_I32, removals, 0, removed_fields),
    FORCE(outside.force, "N"),
    FORCE(outside.torque, "N m"),
    FORCE(outside.lasts.force, "N"),
    FORCE(outside.lasts.torque, "N m"),
    PUSH(outside.push),
    PUSH(outside.lasts.push),
    LIST("byte", "bytes", outside.words, outside.length, outside.room,
         ALONE(I8, 1, "text", NULL, 0)),
    { 0 },
};

void *part_array(const struct part *a, const struct packing *p)
{
    void *array;
    memcpy(&array, (const char *)p + a->array, sizeof array);
    return array;
}

void part_set_array(const struct part *a, struct packing *p, void *array)
{
    memcpy((char *)p + a->array, &array, sizeof array);
}

int64_t part_count(const struct part *a, const struct packing *p)
{
    const void *at = (const char *)p + a->count;
    if (a->how == PART_ONE_TEXT) return part_array(a, p) != NULL;
    if (a->how == PART_I64) return *(const int64_t *)at;
    int64_t n = *(const int32_t *)at;
    return a->how == PART_SQUARE ? n * n : n;
}

/* The strings of a part: its array, or where the only one of them is */
static char **part_texts(const struct part *a, struct packing *p)
{
    return a->how == PART_ONE_TEXT ? (char **)(void *)((char *)p + a->array) : part_array(a, p);
}

void packing_free(struct packing *p)
{
    for (const struct part *a = packing_parts; a->name; a++) {
        if (a->traits & PART_AGAIN) continue;
        char **text = a->traits & PART_TEXT ? part_texts(a, p) : NULL;
        for (int64_t i = 0; text && i < part_count(a, p); i++) free(text[i]);
        if (a->how != PART_ONE_TEXT) free(part_array(a, p));
    }
    shapes_free(&p->shapes), sums_forget_faces(&p->sums);
    memset(p, 0, sizeof *p);
}

/* The rows of p in an array of their own, in place of to's, which are p's too or none */
static bool part_copy(const struct part *a, struct packing *to, const struct packing *p)
{
    const size_t n = (size_t)part_count(a, p);
    if (a->traits & PART_AGAIN || !part_array(a, p)) return true;
    if (a->how == PART_ONE_TEXT) return (*part_texts(a, to) = strdup(part_array(a, p)));
    const size_t bytes = n * a->bytes;
    void *rows = a->traits & PART_TEXT ? calloc(n + 1, a->bytes) : malloc(bytes + 1);
    if (!rows) return false;
    part_set_array(a, to, rows);
    if (a->room) memcpy((char *)to + a->room, (const char *)p + a->count, sizeof(int64_t));
    if (!(a->traits & PART_TEXT)) return memcpy(rows, part_array(a, p), bytes);
    char *const *from = part_array(a, p), **text = rows;
    for (size_t i = 0; i < n; i++)
        if (!(text[i] = strdup(from[i]))) return false;
    return true;
}

void packing_disown(struct packing *p)
{
    p->shapes = (struct shapes){ 0 }, p->sums.faces = NULL, p->whole = NULL;
    for (const struct part *a = packing_parts; a->name; a++) part_set_array(a, p, NULL);
}

int packing_copy(struct packing *to, const struct packing *p, struct failure *failure)
{
    *to = *p;
    packing_disown(to);
    bool good = !shapes_copy(&to->shapes, &p->shapes, failure);
    for (const struct part *a = packing_parts; good && a->name; a++) good = part_copy(a, to, p);
    if (good) return 0;
    packing_free(to);
    return failure_set(failure, EX_SOFTWARE, "no memory for a copy of the packing");
}

struct packing packing_settings(const struct packing *p)
{
    struct packing q = *p;
    q.n = 0;
    for (const struct part *a = packing_parts; a->name; a++) {
        if (a->traits & (PART_SETTING | PART_BODY) || a->how == PART_ONE_TEXT) continue;
        part_set_array(a, &q, NULL);
        if (a->how == PART_I64) memset((char *)&q + a->count, 0, sizeof(int64_t));
    }
    q.sums = (struct wall_sums){ 0 }, q.pours = q.removals = 0;
    return q;
}

/* ---- what all frames of a trajectory share ---- */

/* Sets the failure: a number, or several, of a row whose name is before it, if it has one */
static int says_differs(const struct field *f, const char *row, const void *now, const void *then,
                        struct failure *failure)
{
    if (f->width == 1 && f->type == COLUMN_F64)
        return failure_set(failure, EX_DATAERR, "%s%s is %.15g, and the trajectory's is %.15g", row,
                           f->name, *(const double *)now, *(const double *)then);
    return failure_set(failure, EX_DATAERR, "%s%s differs from the trajectory's", row, f->name);
}

static bool field_is_shared(const struct field *f, const struct packing *p)
{
    return f->traits & FIELD_SAME && !(f->traits & FIELD_STEERED && p->outside.steered);
}

/* Of the members of a struct at `now`, and at `then` */
static int same_fields(const struct field *fields, const char *row, const void *now,
                       const void *then, const struct packing *p, struct failure *failure)
{
    for (const struct field *f = fields; f->name; f++) {
        const void *x = (const char *)now + f->offset, *y = (const char *)then + f->offset;
        if (field_is_shared(f, p) && !field_equal(f, x, y))
            return says_differs(f, row, x, y, failure);
    }
    return 0;
}

/* "wall 2: ", "materials ball and wall: " */
static void name_of_row(const struct part *a, const struct packing *p, int64_t i, char text[200])
{
    if (a->how == PART_SQUARE)
        snprintf(text, 200, "materials %.80s and %.80s: ", p->material_name[i / p->materials],
                 p->material_name[i % p->materials]);
    else
        snprintf(text, 200, "%s %lld: ", a->name, (long long)i);
}

static int part_same(const struct part *a, const struct packing *first, const struct packing *p,
                     struct failure *failure)
{
    const int64_t n = part_count(a, first), m = part_count(a, p);
    const char *then = part_array(a, first), *now = part_array(a, p);
    char row[200];
    if (n != m)
        return failure_set(failure, EX_DATAERR,
                           "the number of %s is %lld, and the trajectory's is %lld", a->many,
                           (long long)m, (long long)n);
    if (a->how == PART_ONE_TEXT) return 0;
    if (!then && !now) return 0;
    if (n && (!then || !now))
        return failure_set(failure, EX_DATAERR, "%s have %s in %s alone", a->many,
                           a->fields == law_fields ? "laws beyond friction and restitution"
                                                   : "these properties",
                           now ? "the frame" : "the trajectory");
    if (n && !(a->traits & PART_TEXT) && !memcmp(then, now, (size_t)n * a->bytes)) return 0;
    for (int64_t i = 0; i < n; i++) {
        const size_t at = (size_t)i * a->bytes;
        name_of_row(a, p, i, row);
        if (!(a->traits & PART_TEXT)) {
            if (same_fields(a->fields, row, now + at, then + at, p, failure)) break;
            continue;
        }
        const char *x = ((char *const *)(const void *)now)[i];
        const char *y = ((char *const *)(const void *)then)[i];
        if (strcmp(x, y) != 0)
            return failure_set(failure, EX_DATAERR, "%s%s, and the trajectory's is %s", row, x, y);
    }
    return failure->status;
}

int packing_same_settings(const struct packing *first, const struct packing *p,
                          struct failure *failure)
{
    if (same_fields(packing_fields, "", p, first, p, failure) ||
        same_fields(cell_fields, "cell: ", p, first, p, failure))
        return failure->status;
    for (const struct part *a = packing_parts; a->name; a++)
        if (a->traits & PART_SETTING && part_same(a, first, p, failure)) return failure->status;
    if (first->shapes.n != p->shapes.n && !(p->breakage && first->shapes.n < p->shapes.n))
        return failure_set(failure, EX_DATAERR,
                           "the number of shapes is %d, and the trajectory's is %d", p->shapes.n,
                           first->shapes.n);
    for (int32_t k = 1; k < first->shapes.n; k++)
        if (strcmp(p->shapes.s[k].name, first->shapes.s[k].name) != 0 ||
            !shape_same(&p->shapes.s[k], &first->shapes.s[k]))
            return failure_set(failure, EX_DATAERR, "shape %s differs from the trajectory's",
                               p->shapes.s[k].name);
    return 0;
}
