/* shape/cell.c: the edges' geometry, their motion, their cut [shape/cell.h]. */
#include "shape/cell.h"

#include <stdlib.h>
#include <string.h>

/* Of another edge: one that leans over it by more is cut. More than 1/2, so that a shear to and fro
   does not cut at each turn. */
static const double TOO_OBLIQUE = 0.75;

struct cell cell_none(void)
{
    return (struct cell){ .edge = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
}

void cell_free(struct cell *c)
{
    free(c->gradient), free(c->factor);
    *c = cell_none();
}

int cell_copy(struct cell *to, const struct cell *from)
{
    size_t gradients = (size_t)from->gradients * sizeof *to->gradient;
    size_t factors = (size_t)from->factors * sizeof *to->factor;
    *to = *from;
    to->gradient = NULL, to->factor = NULL;
    if (gradients && !(to->gradient = malloc(gradients))) return -1;
    if (factors && !(to->factor = malloc(factors))) return -1;
    if (gradients) memcpy(to->gradient, from->gradient, gradients);
    if (factors) memcpy(to->factor, from->factor, factors);
    return 0;
}

/* m^3: of the parallelepiped of the edges, negative where they are left-handed */
static double cell_volume(const vec3 e[3])
{
    return v3_dot(e[0], v3_cross(e[1], e[2]));
}

void cell_inverse(const vec3 e[3], vec3 inverse[3])
{
    double over = 1 / cell_volume(e);
    for (int k = 0; k < 3; k++)
        inverse[k] = v3_scale(over, v3_cross(e[(k + 1) % 3], e[(k + 2) % 3]));
}

void cell_heights(const struct cell *c, double height[3])
{
    vec3 inverse[3];
    cell_inverse(c->edge, inverse);
    for (int k = 0; k < 3; k++) height[k] = 1 / v3_norm(inverse[k]);
}

static const char *gradient_trouble(const struct cell *c, int dim)
{
    for (int32_t m = 0; m < c->gradients; m++) {
        const struct cell_gradient *g = &c->gradient[m];
        if (!isfinite(g->t)) return "a moment of its gradient is not finite";
        if (m && !(g->t > g[-1].t)) return "the moments of its gradient do not increase";
        for (int i = 0; i < 9; i++) {
            double x = g->L[i / 3][i % 3];
            if (!isfinite(x)) return "its gradient is not finite";
            if (dim == 2 && (i / 3 == 2 || i % 3 == 2) && x != 0)
                return "its gradient leaves the plane, and dim is 2";
        }
    }
    return NULL;
}

static const char *edge_trouble(const struct cell *c, int dim)
{
    double size = 1;
    if (!v3_finite(c->origin)) return "origin is not finite";
    for (int k = 0; k < 3; k++) {
        if (!v3_finite(c->edge[k])) return "an edge is not finite";
        if (!v3_finite(c->rate[k])) return "the rate of an edge is not finite";
        if (dim == 2 && (k == 2 ? c->edge[k].x != 0 || c->edge[k].y != 0 : c->edge[k].z != 0))
            return "an edge leaves the plane, and dim is 2";
        if (dim == 2 && (c->rate[k].z != 0 || (k == 2 && (c->rate[k].x != 0 || c->rate[k].y != 0))))
            return "the rate of an edge leaves the plane, and dim is 2";
        size *= v3_norm(c->edge[k]);
    }
    if (dim == 2 && c->repeats[2]) return "z repeats, and dim is 2";
    if (dim == 2 && c->origin.z != 0) return "origin leaves the plane, and dim is 2";
    if (!(fabs(cell_volume(c->edge)) > 1e-6 * size) || !isfinite(size))
        return "its edges have no volume between them";
    return NULL;
}

static const char *cell_load_trouble(const struct cell *c, int dim)
{
    for (int k = 0; k < 9; k++) {
        int i = k / 3, j = k % 3;
        if (!(c->mass[i][j] >= 0 && isfinite(c->mass[i][j])))
            return "the mass of an edge must be finite and not negative";
        if (!isfinite(c->stress[i][j])) return "its stress is not finite";
        if (c->stress[i][j] != c->stress[j][i]) return "its stress is not symmetric";
        if (dim == 2 && (i == 2 || j == 2) && (c->mass[i][j] != 0 || c->stress[i][j] != 0))
            return "its load leaves the plane, and dim is 2";
        if (c->mass[i][j] > 0 && !c->repeats[i]) return "an edge that is not periodic has a mass";
        if (c->mass[i][j] > 0 && c->size_mass > 0)
            return "both its size and a component of an edge are load-controlled";
    }
    if (!(c->size_mass >= 0 && isfinite(c->size_mass)))
        return "the mass of its size must be finite and not negative";
    if (!isfinite(c->mean)) return "its mean stress is not finite";
    for (int k = 0; k < dim && c->size_mass > 0; k++)
        if (!c->repeats[k]) return "its size is load-controlled, and an edge is not periodic";
    for (int32_t m = 0; m < c->factors; m++) {
        if (!isfinite(c->factor[m].t) || !isfinite(c->factor[m].x))
            return "a factor of its load is not finite";
        if (m && !(c->factor[m].t > c->factor[m - 1].t))
            return "the times of its load's factors do not increase";
    }
    return NULL;
}

int cell_check(const struct cell *c, int dim, double least, struct failure *failure)
{
    double height[3];
    const char *trouble = edge_trouble(c, dim);
    if (!trouble) trouble = gradient_trouble(c, dim);
    if (!trouble) trouble = cell_load_trouble(c, dim);
    if (trouble) return failure_set(failure, EX_DATAERR, "the cell: %s", trouble);
    cell_heights(c, height);
    for (int k = 0; k < 3; k++)
        if (c->repeats[k] && !(height[k] >= least))
            return failure_set(
                failure, EX_DATAERR,
                "the periodic cell is %.9g m wide across edge %d: less than the largest "
                "body with its gap, %.9g m, which would touch itself",
                height[k], k, least);
    return 0;
}

bool cell_yields(const struct cell *c)
{
    for (int k = 0; k < 9; k++)
        if (c->mass[k / 3][k % 3] > 0) return true;
    return c->size_mass > 0;
}

double cell_factor_at(const struct cell *c, double t)
{
    const struct cell_factor *f = c->factor;
    int32_t n = c->factors, k = 0;
    if (!n) return 1;
    while (k < n && f[k].t <= t) k++; // the first later than t
    if (k == 0 || k == n) return f[k ? n - 1 : 0].x;
    return f[k - 1].x + (t - f[k - 1].t) / (f[k].t - f[k - 1].t) * (f[k].x - f[k - 1].x);
}

double cell_factor_most(const struct cell *c)
{
    double most = c->factors ? 0 : 1;
    for (int32_t k = 0; k < c->factors; k++) most = fmax(most, fabs(c->factor[k].x));
    return most;
}

double cell_growth(const struct cell *c, double after)
{
    vec3 half[3], inverse[3];
    int dim = cell_dim(c);
    double sum = 0;
    for (int k = 0; k < 3; k++) half[k] = v3_axpy(c->edge[k], -after, c->rate[k]);
    cell_inverse(half, inverse);
    for (int k = 0; k < dim; k++) sum += v3_dot(inverse[k], c->rate[k]);
    return sum / dim;
}

static vec3 cell_times(double L[3][3], vec3 x)
{
    return v3(L[0][0] * x.x + L[0][1] * x.y + L[0][2] * x.z,
              L[1][0] * x.x + L[1][1] * x.y + L[1][2] * x.z,
              L[2][0] * x.x + L[2][1] * x.y + L[2][2] * x.z);
}

bool cell_moves(const struct cell *c, int k)
{
    bool moves = v3_norm(c->rate[k]) > 0;
    for (int i = 0; i < 3; i++) moves = moves || c->mass[k][i] > 0 || c->size_mass > 0;
    for (int32_t m = 0; m < c->gradients; m++)
        moves = moves || v3_norm(cell_times(c->gradient[m].L, c->edge[k])) > 0;
    return moves;
}

/* The velocity gradient at time t (s) */
static void cell_gradient_at(const struct cell *c, double t, double L[3][3])
{
    const struct cell_gradient *g = c->gradient;
    int32_t n = c->gradients, k = 0;
    memset(L, 0, 9 * sizeof **L);
    if (!n) return;
    while (k < n && g[k].t <= t) k++; // the first later than t
    const struct cell_gradient *one = &g[k > 0 ? k - 1 : 0], *other = &g[k < n ? k : n - 1];
    double share = one == other ? 0 : (t - one->t) / (other->t - one->t);
    for (int i = 0; i < 9; i++) {
        double a = one->L[i / 3][i % 3], b = other->L[i / 3][i % 3];
        L[i / 3][i % 3] = a + share * (b - a);
    }
    double trace = 0;
    int dim = c->size_mass > 0 ? cell_dim(c) : 0;
    for (int i = 0; i < dim; i++) trace += L[i][i];
    for (int i = 0; i < dim; i++) L[i][i] -= trace / dim;
}

/* The same with the growth of a size that yields, by which all edges are longer */
static void cell_grow(const struct cell *c, double growth, double L[3][3])
{
    for (int k = 0; k < cell_dim(c); k++) L[k][k] += growth;
}

/* out[k] = the e with (1 - s L) e = edge[k] */
static void cell_solve(double L[3][3], double s, const vec3 edge[3], vec3 out[3])
{
    vec3 column[3], row[3];
    column[0] = v3(1 - s * L[0][0], -s * L[1][0], -s * L[2][0]);
    column[1] = v3(-s * L[0][1], 1 - s * L[1][1], -s * L[2][1]);
    column[2] = v3(-s * L[0][2], -s * L[1][2], 1 - s * L[2][2]);
    cell_inverse(column, row);
    for (int k = 0; k < 3; k++)
        out[k] = v3(v3_dot(row[0], edge[k]), v3_dot(row[1], edge[k]), v3_dot(row[2], edge[k]));
}

void cell_predict(const struct cell *c, double ahead, vec3 out[3])
{
    for (int k = 0; k < 3; k++) out[k] = v3_axpy(c->edge[k], ahead, c->rate[k]);
}

/* Components that yield keep their rate, as bodies keep their velocity without a force. */
static void keep_yielding(const struct cell *c, vec3 rate[3])
{
    for (int k = 0; k < 3; k++) {
        if (c->mass[k][0] > 0) rate[k].x = c->rate[k].x;
        if (c->mass[k][1] > 0) rate[k].y = c->rate[k].y;
        if (c->mass[k][2] > 0) rate[k].z = c->rate[k].z;
    }
}

void cell_next_rate(const struct cell *c, double end_time, double ahead, double after, vec3 out[3])
{
    double L[3][3];
    vec3 half[3], end[3];
    cell_gradient_at(c, end_time, L);
    cell_predict(c, ahead, half);
    if (c->size_mass > 0) {
        cell_grow(c, cell_growth(c, after), L);
        for (int k = 0; k < 3; k++) out[k] = cell_times(L, half[k]);
        return;
    }
    cell_solve(L, after, half, end);
    for (int k = 0; k < 3; k++) out[k] = cell_times(L, end[k]);
    keep_yielding(c, out);
}

void cell_set_rate(struct cell *c, double t)
{
    double L[3][3];
    cell_gradient_at(c, t, L);
    for (int k = 0; k < 3; k++) c->rate[k] = cell_times(L, c->edge[k]);
    struct cell still = *c;
    for (int k = 0; k < 3; k++) still.rate[k] = v3(0, 0, 0);
    keep_yielding(&still, c->rate);
}

void cell_flow_init(struct cell_flow *f, const struct cell *c, const vec3 half[3],
                    const vec3 gain[3])
{
    *f = (struct cell_flow){ .origin = c->origin };
    for (int k = 0; k < 3; k++) {
        f->gain[k] = gain[k];
        f->changes = f->changes || (c->repeats[k] && v3_norm(gain[k]) > 0);
    }
    if (f->changes) cell_inverse(half, f->inverse);
}

void cell_move(struct cell *c, double ahead, double after, const vec3 next[3])
{
    for (int k = 0; k < 3; k++) {
        c->edge[k] = v3_axpy(c->edge[k], ahead, c->rate[k]);
        c->edge[k] = v3_axpy(c->edge[k], after, next[k]);
        c->rate[k] = next[k];
    }
}

void cell_unmove(struct cell *c, double t, double ahead, double after)
{
    double L[3][3];
    vec3 half[3], edge[3], rate[3];
    cell_gradient_at(c, t, L);
    cell_predict(c, -after, half);
    if (c->size_mass > 0) cell_grow(c, cell_growth(c, after), L);
    cell_solve(L, c->size_mass > 0 ? -(ahead + after) : -ahead, half, edge);
    for (int k = 0; k < 3; k++) rate[k] = cell_times(L, edge[k]);
    keep_yielding(c, rate);
    for (int k = 0; k < 3; k++) {
        c->rate[k] = rate[k];
        c->edge[k] = v3_axpy(half[k], -ahead, rate[k]);
    }
}

void cell_wraps(const struct cell *c, const vec3 inverse[3], vec3 x, int32_t wraps[3])
{
    const vec3 d = v3_sub(x, c->origin);
    for (int k = 0; k < 3; k++) {
        double u = c->repeats[k] ? floor(v3_dot(inverse[k], d)) : 0, far = 1e8;
        wraps[k] = (int32_t)(u < -far ? -far : u > far ? far : u);
    }
}

/* Edge k less edge j moves as an edge does whose components yield or are given as those of k: where
   one of j yields, that of k must too. */
static bool may_recut(const struct cell *c, int k, int j)
{
    for (int i = 0; i < 3; i++)
        if (c->mass[j][i] > 0 && !(c->mass[k][i] > 0)) return false;
    return c->repeats[j] && c->repeats[k];
}

int32_t cell_recut(struct cell *c, int *to, int *from)
{
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++) {
            if (j == k || !may_recut(c, k, j)) continue;
            double lean = v3_dot(c->edge[k], c->edge[j]) / v3_dot(c->edge[j], c->edge[j]);
            if (!(fabs(lean) > TOO_OBLIQUE && fabs(lean) < 1e6)) continue;
            double n = rint(lean);
            c->edge[k] = v3_axpy(c->edge[k], -n, c->edge[j]);
            c->rate[k] = v3_axpy(c->rate[k], -n, c->rate[j]);
            *to = k, *from = j;
            return (int32_t)n;
        }
    return 0;
}
