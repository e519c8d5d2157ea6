/* scene/scene_bodies.c: groups of bodies from their JSON. */

#include "scene/scene_height.h"
#include "scene/scene_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int check_lattice(const jnode *o, int dim, const struct scene_bodies *b)
{
    jnode box = json_node_key(o, "box");
    for (int i = 0; i < dim; i++) {
        if (!isfinite(b->box.lo[i]) || (i < dim - 1 && !isfinite(b->box.hi[i])))
            return json_node_fault(box, "a lattice may be open above only, %s is not closed",
                                   axis_name[i]);
        if (!(b->box.hi[i] - b->box.lo[i] <= 1e9 * b->size.max || i == dim - 1))
            return json_node_fault(box, "too wide for bodies of %g m", b->size.max);
    }
    if (b->from == SCENE_SHELVES) return 0; // scene_build sees what fits
    struct scene_lattice l = scene_lattice(b, dim);
    double places = 1;
    for (int i = 0; i < dim; i++) {
        places *= l.cells[i];
        if (!(l.cells[i] >= 1))
            return json_node_fault(box, "%s is narrower than a cell, %g m", axis_name[i],
                                   2 * b->spacing * b->size.max);
    }
    if ((double)b->count <= places) return 0;
    return json_node_fault(
        json_node_key(o, "count"),
        "%lld bodies, but the box has cells for %.0f: they need a height of %.4g m along %s",
        (long long)b->count, places, scene_lattice_height(b, dim), axis_name[dim - 1]);
}

/* A group that fills the cell: its box is that of heights above the faces. */
static int fill_cell(jnode o, const struct scene_cell *of, struct scene_bodies *b)
{
    if (of->goes_on)
        return json_node_fault(o, "needs a box: the cell's edges come with a document");
    b->in_cell = true;
    cell_heights(&of->cell, b->box.hi);
    for (int k = 0; k < 3; k++) b->box.lo[k] = 0;
    return 0;
}

#define AT(member) offsetof(struct scene_bodies, member)

/* ---- what the bodies of every group have in common ---- */

static const struct key group_key[] = {
    { "v", &key_vector, AT(v), "m/s", "0", "[0, 0, -1]", "Velocity." },
    { "w", &key_spin, AT(w), "rad/s", "0", "3", "Angular velocity." },
    { "material", &key_material, AT(material), "-", "\"ball\"", "\"steel\"", "Material." },
    { "density", &key_positive, AT(density), "kg/m^3", "of the material", "2600",
      "Density; in 2D in kg/m^2." },
    { "mass", &key_positive, AT(mass), "kg", "by density", "1e-3", "Mass, instead of density.",
      .without = "density", .why = "density is given too" },
    { "fixed", &key_bool, AT(fixed), "-", "false", "true",
      "Move with the constant velocities v and w regardless of contacts." },
    { "name", &key_group, AT(group), "-", "none", "\"charge\"",
      "Name of the group, which each of its bodies has, see Names. Default: none; bodies of a "
      "document keep theirs." },
    { 0 },
};

static int finish_group(jnode o, struct scene *s, void *out)
{
    struct scene_bodies *b = out;
    b->has_v = keys_has(&o, "v"), b->has_w = keys_has(&o, "w");
    b->has_material = keys_has(&o, "material"), b->has_fixed = keys_has(&o, "fixed");
    b->has_density = keys_has(&o, "density");
    if (!b->has_density) b->density = s->material[b->material].density;
    return 0;
}

static const struct keys group_keys = { "group", group_key, .finish = finish_group };

/* ---- one body ---- */

static const struct key one_key[] = {
    { "x", &key_vector, AT(x), "m", REQUIRED, "[0, 0, 0.1]", "Position of the centre of mass." },
    { "radius", &key_positive, AT(size.min), "m", REQUIRED, "1e-3",
      "Radius; not required with a shape.", .unless = "shape" },
    { "size", &key_positive, AT(size.min), "-", "1", "2", "Scale factor of the shape.",
      .with = "shape", .without = "radius", .why = "a radius is given too" },
    { SHAPE_OF(struct scene_bodies) },
    { ORIENTATION_OF(struct scene_bodies) },
    { "", &key_include, 0, .object = &group_keys },
    { 0 },
};

static int finish_one(jnode o, struct scene *s, void *out)
{
    struct scene_bodies *b = out;
    b->from = SCENE_ONE, b->count = 1;
    if (!keys_has(&o, "radius")) b->size.min *= s->solid[b->form.shape].reach;
    b->size.max = b->size.min;
    return 0;
}

static const struct keys one_keys = { "body", one_key, .finish = finish_one };

/* ---- a lattice ---- */

static const char *const cells[] = { "equal", "own", NULL };

static int read_cells(jnode n, struct scene *s, void *member)
{
    int own = 0;
    (void)s;
    if (json_node_word(n, cells, &own)) return 1;
    if (own) *(enum scene_source *)member = SCENE_SHELVES;
    return 0;
}

static const struct key lattice_key[] = {
    { "count", &key_integer, AT(count), "-", REQUIRED, "500", "Number of bodies.",
      .most = INT32_MAX },
    { RADIUS_OF(struct scene_bodies) },
    { SIZE_OF(struct scene_bodies) },
    { SHAPE_OF(struct scene_bodies) },
    { ORIENTATION_OF(struct scene_bodies) },
    { "box", &key_box, AT(box), "m", "cell, wall", "{\"x\": [0, 1], ...}",
      "Region to fill; only its last axis may be open above. Default: the periodic cell, in rows "
      "along its edges; otherwise the first wall that is a box." },
    { "cells", &key_word, AT(from), "-", "\"equal\"", "\"own\"",
      "equal: all cells have one size. own: each grain has a cell that fits it; grains are "
      "sorted by size, and fill the box in rows and layers from below.",
      .words = cells, .read = read_cells },
    { "spacing", &key_number, AT(spacing), "-", "1.05", "1",
      "Smallest edge of a cell, in largest diameters; with own cells, in diameters of the grain. "
      "The cells fill the width of the box, and are as low as possible along the last axis.",
      .least = 1, .most = INFINITY },
    { "jitter", &key_share, AT(jitter), "-", "1", "0",
      "Random displacement, as a fraction of the free space in the cell. It never makes bodies "
      "overlap." },
    { "thermal", &key_not_negative, AT(thermal), "m/s", "0", "0.5",
      "Standard deviation of a random velocity that is added to each component." },
    { "", &key_include, 0, .object = &group_keys },
    { 0 },
};

static int needs_box(jnode o, const struct scene *s)
{
    return keys_has(&o, "box") || s->boxed || s->cell.given
               ? 0
               : json_node_fault(json_node_key(&o, "box"), "is missing");
}

static int finish_lattice(jnode o, struct scene *s, void *out)
{
    struct scene_bodies *b = out;
    const bool box = keys_has(&o, "box"), own = b->from == SCENE_SHELVES;
    if (!own) b->from = SCENE_LATTICE;
    if (needs_box(o, s) || scene_finish_grain(o, s, &b->form, &b->size)) return 1;
    if (!box && s->cell.given && own && !s->cell.goes_on)
        return json_node_fault(o, "cells of their own need a box");
    if (!box && (s->cell.given || s->cell.goes_on) && fill_cell(o, &s->cell, b)) return 1;
    return check_lattice(&o, s->dim, b);
}

static const struct keys lattice_keys = { "lattice", lattice_key, .finish = finish_lattice };

/* ---- a random packing ---- */

static const struct key how_key[] = {
    { "phi", &key_share, AT(phi), "-", "-", "0.5",
      "As many bodies as fill this volume fraction of the box between the walls, at most 2^21.",
      .choice = 1 },
    { "count", &key_integer, AT(count), "-", "-", "500", "Number of bodies.", .choice = 1,
      .most = INT32_MAX },
    { 0 },
};
static const struct keys how_keys = { "random", how_key };

static const struct key random_key[] = {
    { "random", &key_object, 0, "-", REQUIRED, "{\"phi\": 0.5}", "How many bodies.",
      .object = &how_keys },
    { RADIUS_OF(struct scene_bodies) },
    { SIZE_OF(struct scene_bodies) },
    { SHAPE_OF(struct scene_bodies) },
    { ORIENTATION_OF(struct scene_bodies) },
    { "box", &key_box, AT(box), "m", "the cell", "{\"x\": [0, 1], ...}",
      "Closed box. Default: the periodic cell, of any size and shape; bodies and their images "
      "fill it across its border." },
    { "thermal", &key_not_negative, AT(thermal), "m/s", "0", "0.5", "As for a lattice." },
    { "", &key_include, 0, .object = &group_keys },
    { 0 },
};

static int finish_random(jnode o, struct scene *s, void *out)
{
    struct scene_bodies *b = out;
    jnode box = json_node_key(&o, "box");
    b->from = SCENE_RANDOM;
    if (needs_box(o, s) || scene_finish_grain(o, s, &b->form, &b->size)) return 1;
    if (!box.json && s->cell.given && fill_cell(o, &s->cell, b)) return 1;
    for (int i = 0; i < s->dim; i++) {
        double width = b->box.hi[i] - b->box.lo[i];
        if (!isfinite(width))
            return json_node_fault(box, "a random start needs a closed box, %s is open",
                                   axis_name[i]);
        if (!(width >= 2 * b->size.max))
            return json_node_fault(box, "%s is narrower than the largest grain, %g m", axis_name[i],
                                   2 * b->size.max);
    }
    return 0;
}

static const struct keys random_keys = { "random_packing", random_key, .finish = finish_random };

/* ---- files ---- */

static const struct key table_key[] = {
    { "file", &key_file, AT(file), "-", REQUIRED, "\"balls.txt\"",
      "Text file, one body per line: x y z r (x y r in 2D), in m; # begins a comment." },
    { "", &key_include, 0, .object = &group_keys },
    { 0 },
};

static int finish_table(jnode o, struct scene *s, void *out)
{
    (void)o, (void)s;
    ((struct scene_bodies *)out)->from = SCENE_TABLE;
    return 0;
}

static const struct keys table_keys = { "table", table_key, .finish = finish_table };

#define FRAME                                                                                      \
    "frame", &key_integer, AT(frame), "-", "-1", "10",                                             \
        "Frame, counted from 0, or from the end: -1 is the last.", .least = -1e9, .most = 1e9
#define AT_REST "at_rest", &key_bool, AT(at_rest), "-", "false", "true", "Set all velocities to 0."

static const struct key document_key[] = {
    { "document", &key_file, AT(file), "-", REQUIRED, "\"settled.h5\"",
      "Document (nsd-format(5)) whose bodies are taken with their motion, radii, masses, ids and "
      "the names of their materials, which the scene must define, too." },
    { FRAME },
    { AT_REST },
    { "", &key_include, 0, .object = &group_keys },
    { 0 },
};

static int finish_document(jnode o, struct scene *s, void *out)
{
    struct scene_bodies *b = out;
    (void)s;
    b->from = SCENE_DOCUMENT, b->foreign = keys_has(&o, "import");
    b->has_repeats = keys_has(&o, "repeats");
    return 0;
}

static const struct keys document_keys = { "document", document_key, .finish = finish_document };

/* "types": which material each type of the file is */
static int read_types(jnode o, struct scene *s, void *out)
{
    struct scene_bodies *b = out;
    const char *name;
    json_t *value;
    if (!json_is_object(o.json)) return json_node_fault(o, "needs an object {\"1\": NAME, ...}");
    if (!(b->type = scene_alloc(o, json_object_size(o.json), sizeof *b->type))) return 1;
    json_object_foreach(o.json, name, value)
    {
        jnode n = json_node_key(&o, name);
        if (!strcmp(name, "comment")) continue;
        if (!*name || strspn(name, "0123456789") != strlen(name))
            return json_node_fault(n, "types are whole numbers");
        if (key_material.read(n, NULL, s, &b->type[b->types].material)) return 1;
        if (!(b->type[b->types++].name = strdup(name)))
            return failure_set(o.in->failure, EX_SOFTWARE, "no memory for the types of a file");
    }
    return 0;
}

static const struct key_type key_types = { "object", "{'$ref': 'types'}", NULL, NULL };

static const struct key import_key[] = {
    { "import", &key_file, AT(file), "-", REQUIRED, "\"start.data\"",
      "File, see Files of other programs." },
    { FRAME },
    { AT_REST },
    { "types", &key_types, 0, "-", "by name", "{\"1\": \"glass\"}",
      "Material for each type of the file. Default: that of the same name; ball where the file "
      "has one type.",
      .read = read_types },
    { "repeats", &key_repeats, AT(repeats), "-", "of the file", "[true, true, false]",
      "Periodic edges of the box of the file." },
    { "", &key_include, 0, .object = &group_keys },
    { 0 },
};
static const struct keys import_keys = { "import", import_key, .finish = finish_document };

/* ---- "bodies" ---- */

static const struct keys *const forms[] = {
    &one_keys, &lattice_keys, &table_keys, &document_keys, &random_keys, &import_keys, NULL
};
const struct keys scene_bodies_keys = { "bodies", .forms = forms };

static int scene_bodies_read_group(jnode o, struct scene *s, void *out)
{
    int64_t *total = out;
    struct scene_bodies *b = &s->bodies[s->groups++];
    *b = (struct scene_bodies){ .form = { .turned = { 1, 0, 0, 0 }, .fill = 1 } };
    if (s->boxed) b->box = s->box;
    if (keys_read(o, &scene_bodies_keys, s, b)) return 1;
    *total += b->count;
    return *total <= INT32_MAX ? 0 : json_node_fault(o, "more than %d bodies", INT32_MAX);
}

int scene_read_bodies(jnode a, struct scene *s, void *out)
{
    int64_t total = 0;
    (void)out;
    if (!(s->bodies = scene_alloc(a, json_array_size(a.json), sizeof *s->bodies))) return 1;
    return keys_each(a, s, &total, scene_bodies_read_group);
}
