/* scene/scene_cell.c: the cell that repeats, from its JSON. */
#include "scene/scene_read.h"

/* dim rows of dim numbers, or null where they are not given */
static int scene_cell_read_matrix(jnode n, int dim, double M[3][3], bool given[3][3])
{
    size_t rows = 0, columns = 0;
    if (json_node_array(n, &rows)) return 1;
    if (rows != (size_t)dim) return json_node_fault(n, "needs %d rows", dim);
    for (size_t i = 0; i < rows; i++) {
        jnode row = json_node_item(&n, i);
        if (json_node_array(row, &columns)) return 1;
        if (columns != (size_t)dim) return json_node_fault(row, "needs %d numbers", dim);
        for (size_t j = 0; j < columns; j++) {
            jnode x = json_node_item(&row, j);
            if (json_is_null(x.json)) continue;
            if (json_node_number(x, J_ANY, &M[i][j])) return 1;
            given[i][j] = true;
        }
    }
    return 0;
}

static int read_lengths(jnode n, struct scene *s, void *member)
{
    const struct key lengths = { .type = &key_lengths };
    double length[3] = { 0 };
    vec3 *edge = member;
    if (keys_read_array(n, &lengths, s, length)) return 1;
    edge[0].x = length[0], edge[1].y = length[1];
    if (s->dim == 3) edge[2].z = length[2];
    return 0;
}

const struct key_type key_repeats = { ARRAY("true or false", &key_bool, 0, sizeof(bool)) };

/* ---- the gradient ---- */

static const struct key moment_key[] = {
    { "t", &key_number, offsetof(struct cell_gradient, t), "s", REQUIRED, "0", "Time." },
    { "L", &key_matrix, offsetof(struct cell_gradient, L), "1/s", REQUIRED, "[[0, 1], [0, 0]]",
      "Velocity gradient at this time." },
    { 0 },
};
static const struct keys moment_keys = { "gradient", moment_key };

static int read_gradient(jnode a, struct scene *s, void *out)
{
    struct cell *c = &((struct scene_cell *)out)->cell;
    size_t n = 0;
    if (json_node_array(a, &n)) return 1;
    bool table = n && json_is_object(json_node_item(&a, 0).json);
    if (!table) n = 1;
    if (!(c->gradient = scene_alloc(a, n, sizeof *c->gradient))) return 1;
    c->gradients = (int32_t)n;
    const struct key whole = { .type = &key_matrix };
    if (!table) return keys_read_array(a, &whole, s, c->gradient[0].L);
    for (size_t m = 0; m < n; m++) {
        jnode moment = json_node_item(&a, m);
        if (keys_read(moment, &moment_keys, s, &c->gradient[m])) return 1;
        if (m && !(c->gradient[m].t > c->gradient[m - 1].t))
            return json_node_fault(json_node_key(&moment, "t"),
                                   "must be later than the one before");
    }
    return 0;
}

static const struct key_type key_gradient = { "MATRIX or array",
                                              "{'anyOf': [{'$ref': 'matrix'}, {'type': 'array', "
                                              "'items': {'$ref': 'gradient'}, 'minItems': 1}]}",
                                              NULL, NULL, &moment_keys };

/* ---- the stress ---- */

/* Each entry of a symmetric matrix may be given at one of its two places, or alike at both. */
static int set_target(jnode n, int dim, double target[3][3], bool given[3][3], struct cell *c)
{
    for (int i = 0; i < dim; i++)
        for (int j = 0; j < dim; j++) {
            if (!given[i][j]) continue;
            if (!c->repeats[j])
                return json_node_fault(n, "edge %d is not periodic: it cannot have a stress", j);
            if (given[j][i] && target[i][j] != target[j][i])
                return json_node_fault(n, "a stress is symmetric");
            c->stress[i][j] = c->stress[j][i] = target[i][j];
        }
    return 0;
}

/* kg, of what yields; without it the rule of scene/time_step.h */
static int read_mass(jnode n, int dim, bool yields[3][3], struct scene_cell *out)
{
    struct cell *c = &out->cell;
    double one = 1, mass[3][3] = { { 0 } };
    bool matrix = json_is_array(n.json), given[3][3] = { { false } };
    if (!n.json) out->by_rule = true;
    if (n.json && (matrix ? scene_cell_read_matrix(n, dim, mass, given)
                          : json_node_number(n, J_POSITIVE, &one)))
        return 1;
    for (int i = 0; i < dim; i++)
        for (int j = 0; j < dim; j++) {
            if (!yields[i][j]) continue;
            c->mass[j][i] = matrix ? mass[i][j] : one;
            if (!(c->mass[j][i] > 0))
                return json_node_fault(
                    n, "component %s of edge %d is stress-controlled and needs a mass",
                    axis_name[i], j);
        }
    return 0;
}

/* [[t, x], ...]: by what the stress is multiplied */
static int read_factor(jnode a, struct scene *s, void *out)
{
    struct cell *c = &((struct scene_cell *)out)->cell;
    size_t n = 0;
    (void)s;
    if (json_node_array(a, &n)) return 1;
    if (!n || n >= 1 << 24) return json_node_fault(a, "needs [[time, factor], ...]");
    if (!(c->factor = scene_alloc(a, n, sizeof *c->factor))) return 1;
    c->factors = (int32_t)n;
    return keys_read_rows(a, &c->factor->t);
}

/* The size yields to a mean stress; the gradient gives the distortion beside it. */
static int read_mean(jnode o, int dim, struct scene_cell *out)
{
    struct cell *c = &out->cell;
    jnode mass = json_node_key(&o, "mass"), mean = json_node_key(&o, "mean");
    double one = 1;
    if (mass.json && json_node_number(mass, J_POSITIVE, &one)) return 1;
    for (int k = 0; k < dim; k++)
        if (!c->repeats[k])
            return json_node_fault(
                mean, "edge %d is not periodic, so the size cannot follow a mean stress", k);
    for (int32_t m = 0; m < c->gradients; m++) {
        double(*L)[3] = c->gradient[m].L, trace = 0, most = 0;
        for (int k = 0; k < dim; k++) trace += L[k][k], most += fabs(L[k][k]);
        if (fabs(trace) > 1e-9 * most)
            return json_node_fault(mean,
                                   "the gradient changes the volume at %g per s, which the mean "
                                   "stress controls: subtract a third of it from each diagonal "
                                   "component (in 2D a half)",
                                   trace);
    }
    out->by_rule = !mass.json;
    c->size_mass = one; // kg, until the edges are known
    return 0;
}

/* What needs several keys is read in finish_stress(). */
static const struct key_type key_pressure = { "number", "{'type': 'number'}", scene_read_later,
                                              NULL };
static const struct key_type key_target = { "MATRIX", "{'$ref': 'loose_matrix'}", scene_read_later,
                                            NULL };
static const struct key_type key_factor = { "[[t, x], ...]", "{'$ref': 'rows'}", NULL, NULL };
static const struct key_type key_masses = {
    "number or MATRIX",
    "{'anyOf': [{'type': 'number', 'exclusiveMinimum': 0}, {'$ref': 'loose_matrix'}]}",
    scene_read_later, NULL
};

static const struct key stress_key[] = {
    { "pressure", &key_pressure, 0, "Pa", "-", "1",
      "The same stress on the diagonal, for periodic edges.", .choice = 1 },
    { "target", &key_target, 0, "Pa", "-", "[[1, null], ...]",
      "Stress by component: row i and column j belong to component i of edge j; null leaves it "
      "to the gradient.",
      .choice = 1 },
    { "mean", &key_number, offsetof(struct scene_cell, cell.mean), "Pa", "-", "1",
      "Mean stress under which the size of the cell changes, all edges in proportion. The "
      "gradient, whose trace must be 0, changes the shape: a test at constant mean stress. All "
      "edges must be periodic.",
      .choice = 1 },
    { "factor", &key_factor, 0, "s, 1", "1", "[[0, 0], [1, 1]]",
      "Multiply the stress by x, linear between these times, constant before and after: a load "
      "that increases without a shock, in stages, or in cycles.",
      .read = read_factor },
    { "mass", &key_masses, 0, "kg", "see below", "10",
      "Mass with which an edge moves under the difference between the target and the mean stress "
      "of the contacts, see nsd-methods(7), \"Loads\". With mean it is a number. Default: 3/(4 "
      "pi^2) of the mass of the bodies in the cell, with which an edge does not oscillate faster "
      "than a wave crosses the cell." },
    { 0 },
};

static int finish_stress(jnode o, struct scene *s, void *out)
{
    struct scene_cell *to = out;
    struct cell *c = &to->cell;
    const int dim = s->dim;
    double target[3][3] = { { 0 } };
    bool yields[3][3] = { { false } };
    if (keys_has(&o, "mean")) return read_mean(o, dim, to);
    jnode pressure = json_node_key(&o, "pressure"), matrix = json_node_key(&o, "target");
    if (matrix.json && scene_cell_read_matrix(matrix, dim, target, yields)) return 1;
    for (int k = 0; pressure.json && k < dim; k++) {
        yields[k][k] = c->repeats[k];
        if (json_node_number(pressure, J_ANY, &target[k][k])) return 1;
    }
    if (set_target(matrix.json ? matrix : pressure, dim, target, yields, c)) return 1;
    return read_mass(json_node_key(&o, "mass"), dim, yields, to);
}

static const struct keys stress_keys = { "stress", stress_key, .finish = finish_stress };

/* ---- the cell ---- */

#define AT(member) offsetof(struct scene_cell, member)

static const struct key cell_key[] = {
    { "edges", &key_matrix, AT(cell.edge), "m", "of a document", "[[1, 0], [0, 1]]",
      "Edges from the origin; they need not be perpendicular. Default: those of the first "
      "document, and then origin and repeats, too; load-controlled edges keep their speed.",
      .choice = -1 },
    { "lengths", &key_lengths, AT(cell.edge), "m", "-", "[1, 1, 1]",
      "Edges along x, y and z, instead of edges.", .choice = -1, .read = read_lengths },
    { "repeats", &key_repeats, AT(cell.repeats), "-", "all true", "[true, false]",
      "Periodic edges; others only bound a lattice." },
    { "origin", &key_vector, AT(cell.origin), "m", "0", "[0, 0]",
      "Corner from which the edges start." },
    { "gradient", &key_gradient, 0, "1/s", "0", "[[0, 1], [0, 0]]",
      "Velocity gradient L, d edge/dt = L edge: [[0, G], [0, 0]] is simple shear, [[-A, 0], [0, "
      "-A]] compression. As a function of time: [{\"t\": s, \"L\": MATRIX}, ...], linear between "
      "the entries and constant before and after.",
      .read = read_gradient },
    { "affine", &key_bool, AT(affine), "-", "see below", "true",
      "Give free bodies the velocity L (x - origin) at the start, in addition to their own. "
      "Default: true if there is a gradient and no document among the bodies. Without it, bodies "
      "at rest would slide relative to their images." },
    { "stress", &key_object, 0, "-", "none", "{\"pressure\": 1}", "Stress control, see below.",
      .object = &stress_keys },
    { 0 },
};
const struct keys scene_cell_keys = { "cell", cell_key };

const struct key_type key_cell = { "object or null",
                                   "{'anyOf': [{'type': 'null'}, {'$ref': 'cell'}]}", NULL, NULL,
                                   &scene_cell_keys };

static bool takes_documents(jnode bodies)
{
    bool any = false;
    for (size_t k = 0; k < json_array_size(bodies.json); k++)
        any = any || json_object_get(json_array_get(bodies.json, k), "document") ||
              json_object_get(json_array_get(bodies.json, k), "import");
    return any;
}

int scene_read_cell(jnode o, struct scene *s, void *member)
{
    struct scene_cell *out = member;
    struct cell *c = &out->cell;
    struct failure failure = { 0 };
    *c = cell_none();
    if (!o.json) return 0;
    if (json_is_null(o.json)) return out->none = true, 0;
    const bool documents = takes_documents(json_node_key(o.up, "bodies"));
    const bool sized = keys_has(&o, "edges") || keys_has(&o, "lengths");
    out->given = true;
    out->repeats = keys_has(&o, "repeats"), out->origin = keys_has(&o, "origin");
    out->affine = !documents && keys_has(&o, "gradient"); // or the border would be a slip plane
    out->goes_on = documents && !sized;
    for (int k = 0; k < s->dim; k++) c->repeats[k] = true;
    if (json_is_object(o.json) && !out->goes_on && !sized)
        return json_node_fault(o, "needs one of the keys edges lengths");
    if (keys_read(o, &scene_cell_keys, s, out)) return 1;
    if (!cell_repeats(c))
        return json_node_fault(json_node_key(&o, "repeats"), "no edge is periodic");
    if (out->goes_on) return 0;
    cell_set_rate(c, s->t);
    return cell_check(c, s->dim, 0, &failure) ? json_node_fault(o, "%s", failure.text) : 0;
}
