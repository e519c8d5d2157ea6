/* scene/scene_cell.c: the cell that repeats, from its JSON. */
#include "scene/scene_read.h"

/* dim rows of dim numbers; where `given` is not NULL an item may be null, which leaves it out. */
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
            if (given && json_is_null(x.json)) continue;
            if (json_node_number(x, J_ANY, &M[i][j])) return 1;
            if (given) given[i][j] = true;
        }
    }
    return 0;
}

static int scene_cell_read_edges(jnode o, int dim, struct cell *c)
{
    jnode edges = json_node_key(&o, "edges");
    size_t n = 0;
    int which = json_node_choice(o, "edges lengths");
    if (which < 0) return 1;
    if (which == 1) {
        vec3 length = v3(0, 0, 0);
        jnode lengths = json_node_key(&o, "lengths");
        if (json_node_vector(lengths, dim, &length)) return 1;
        if (!(length.x > 0 && length.y > 0 && (dim == 2 || length.z > 0)))
            return json_node_fault(lengths, "must be positive");
        c->edge[0].x = length.x, c->edge[1].y = length.y;
        if (dim == 3) c->edge[2].z = length.z;
        return 0;
    }
    if (json_node_array(edges, &n)) return 1;
    if (n != (size_t)dim) return json_node_fault(edges, "needs %d vectors", dim);
    for (size_t k = 0; k < n; k++)
        if (json_node_vector(json_node_item(&edges, k), dim, &c->edge[k])) return 1;
    return 0;
}

static int scene_cell_read_repeats(jnode a, int dim, struct cell *c)
{
    size_t n = 0;
    for (int k = 0; k < dim; k++) c->repeats[k] = true;
    if (!a.json) return 0;
    if (json_node_array(a, &n)) return 1;
    if (n != (size_t)dim) return json_node_fault(a, "needs true or false for %d edges", dim);
    for (size_t k = 0; k < n; k++)
        if (json_node_bool(json_node_item(&a, k), &c->repeats[k])) return 1;
    return cell_repeats(c) ? 0 : json_node_fault(a, "no edge is periodic");
}

static int read_moment(jnode o, int dim, struct cell_gradient *g)
{
    return json_node_only(o, "t L") || json_node_need(&o, "t L") ||
           json_node_number(json_node_key(&o, "t"), J_ANY, &g->t) ||
           scene_cell_read_matrix(json_node_key(&o, "L"), dim, g->L, NULL);
}

static int read_gradient(jnode a, int dim, struct cell *c)
{
    size_t n = 0;
    if (!a.json) return 0;
    if (json_node_array(a, &n)) return 1;
    bool table = n && json_is_object(json_node_item(&a, 0).json);
    if (!table) n = 1;
    if (!(c->gradient = scene_alloc(a, n, sizeof *c->gradient))) return 1;
    c->gradients = (int32_t)n;
    if (!table) return scene_cell_read_matrix(a, dim, c->gradient[0].L, NULL);
    for (size_t m = 0; m < n; m++) {
        jnode moment = json_node_item(&a, m);
        if (read_moment(moment, dim, &c->gradient[m])) return 1;
        if (m && !(c->gradient[m].t > c->gradient[m - 1].t))
            return json_node_fault(json_node_key(&moment, "t"),
                                   "must be later than the one before");
    }
    return 0;
}

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
static int read_factor(jnode a, struct cell *c)
{
    size_t n = 0, two = 0;
    if (!a.json) return 0;
    if (json_node_array(a, &n)) return 1;
    if (!n || n >= 1 << 24) return json_node_fault(a, "needs [[time, factor], ...]");
    if (!(c->factor = scene_alloc(a, n, sizeof *c->factor))) return 1;
    c->factors = (int32_t)n;
    for (size_t k = 0; k < n; k++) {
        struct cell_factor *f = &c->factor[k];
        jnode pair = json_node_item(&a, k), t = json_node_item(&pair, 0);
        if (json_node_array(pair, &two)) return 1;
        if (two != 2) return json_node_fault(pair, "needs [time, factor]");
        if (json_node_number(t, J_ANY, &f->t) ||
            json_node_number(json_node_item(&pair, 1), J_ANY, &f->x))
            return 1;
        if (k && !(f->t > f[-1].t)) return json_node_fault(t, "times must rise");
    }
    return 0;
}

/* The size yields to a mean stress; the gradient gives the distortion beside it. */
static int read_mean(jnode o, int dim, struct scene_cell *out)
{
    struct cell *c = &out->cell;
    jnode mass = json_node_key(&o, "mass"), mean = json_node_key(&o, "mean");
    double one = 1;
    if (json_node_number(mean, J_ANY, &c->mean) ||
        (mass.json && json_node_number(mass, J_POSITIVE, &one)))
        return 1;
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

static int read_stress(jnode o, int dim, struct scene_cell *out)
{
    struct cell *c = &out->cell;
    double target[3][3] = { { 0 } };
    bool yields[3][3] = { { false } };
    if (!o.json) return 0;
    int which = json_node_choice(o, "pressure target mean");
    if (which < 0 || json_node_only(o, "pressure target mean mass factor") ||
        read_factor(json_node_key(&o, "factor"), c))
        return 1;
    if (which == 2) return read_mean(o, dim, out);
    jnode pressure = json_node_key(&o, "pressure"), matrix = json_node_key(&o, "target");
    if (which == 1 && scene_cell_read_matrix(matrix, dim, target, yields)) return 1;
    for (int k = 0; which == 0 && k < dim; k++) {
        yields[k][k] = c->repeats[k];
        if (json_node_number(pressure, J_ANY, &target[k][k])) return 1;
    }
    if (set_target(which == 1 ? matrix : pressure, dim, target, yields, c)) return 1;
    return read_mass(json_node_key(&o, "mass"), dim, yields, out);
}

int scene_read_cell(jnode o, int dim, double t, bool documents, struct scene_cell *out)
{
    struct cell *c = &out->cell;
    struct failure failure = { 0 };
    *c = cell_none();
    if (!o.json) return 0;
    if (json_is_null(o.json)) return out->none = true, 0;
    out->given = true;
    out->repeats = json_node_key(&o, "repeats").json;
    out->origin = json_node_key(&o, "origin").json;
    out->affine =
        !documents && json_node_key(&o, "gradient").json; // or the border would be a slip plane
    out->goes_on =
        documents && !json_node_key(&o, "edges").json && !json_node_key(&o, "lengths").json;
    if (json_node_only(o, "edges lengths repeats origin gradient affine stress") ||
        (!out->goes_on && scene_cell_read_edges(o, dim, c)) ||
        scene_cell_read_repeats(json_node_key(&o, "repeats"), dim, c) ||
        json_node_vector(json_node_key(&o, "origin"), dim, &c->origin) ||
        read_gradient(json_node_key(&o, "gradient"), dim, c) ||
        json_node_bool(json_node_key(&o, "affine"), &out->affine) ||
        read_stress(json_node_key(&o, "stress"), dim, out))
        return 1;
    if (out->goes_on) return 0;
    cell_set_rate(c, t);
    return cell_check(c, dim, 0, &failure) ? json_node_fault(o, "%s", failure.text) : 0;
}
