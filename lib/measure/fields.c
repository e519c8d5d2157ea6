#include "measure/fields.h"

#include "measure/ball_part.h"
#include "measure/branch.h"
#include "measure/tensor.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double CUT = 4; /* widths */
/* Sums over bodies of m phi times these, d the way from the point to a body */
enum { MOMENT_VD = 0, MOMENT_DD = 9, MOMENT_D = 18, MOMENT_DIAMETER = 21, MOMENTS = 22 };
static const double FLAT =
    1e-6; /* of w^2 rho/2: bodies that lie this much in a plane have no gradient across it */
static const int64_t MOST_POINTS = 1500000; /* 1 GB: a point has 632 bytes */
static const double USUAL_CELLS = 32;       /* along an axis: what a picture shows, in a moment */

const struct quantity field_quantity[CONTINUUM_COUNT + 1] = {
    [CONTINUUM_DENSITY] = { "density", "kg m-3", 1, "mass" },
    [CONTINUUM_FRACTION] = { "fraction", "1", 1, "solid volume" },
    [CONTINUUM_MOMENTUM] = { "momentum", "kg m-2 s-1", 3, "momentum" },
    [CONTINUUM_VELOCITY] = { "velocity", "m s-1", 3, "momentum over density" },
    [CONTINUUM_STRESS] = { "stress", "Pa", 9, "of contacts and motion, compression positive" },
    [CONTINUUM_CONTACTS] = { "contact_stress", "Pa", 9, "of contacts" },
    [CONTINUUM_KINETIC] = { "kinetic_stress", "Pa", 9, "of motion" },
    [CONTINUUM_GRADIENT] = { "velocity_gradient", "s-1", 9,
                             "dv_i/dx_j of the affine flow that fits best" },
    [CONTINUUM_STRAIN_RATE] = { "strain_rate", "s-1", 9, "its symmetric part" },
    [CONTINUUM_SHEAR_RATE] = { "shear_rate", "s-1", 1, "size of its deviator, sqrt(2 D:D)" },
    [CONTINUUM_TEMPERATURE] = { "temperature", "m2 s-2", 1,
                                "granular temperature about that flow" },
    [CONTINUUM_INERTIAL] = { "inertial_number", "1", 1, "shear rate times d sqrt(rho_s/p)" },
};

/* ---- the grid ---- */

static double fields_mean_diameter(const struct packing *p)
{
    double sum = 0;
    for (int64_t i = 0; i < p->n; i++) sum += 2 * p->radius[i] / (double)p->n;
    return sum;
}

static int grid_init(struct fields *f, const struct snapshot *s, double spacing,
                     struct failure *failure)
{
    const struct region *r = &s->region;
    double origin[3] = { 0, 0, 0 }, step[3] = { 1, 1, 1 }, points = 1;
    for (int k = 0; k < 3; k++) {
        f->n[k] = 1;
        if (k >= s->p->dim) continue;
        double size = r->hi[k] - r->lo[k];
        double wide = spacing > 0 ? spacing : fmax(fields_mean_diameter(s->p), size / USUAL_CELLS);
        double cells = fmax(ceil(size / wide * (1 - 1e-12)), 1);
        if (!(size > 0)) return failure_set(failure, EX_DATAERR, "no volume to lay a grid over");
        points *= cells;
        if (!(points <= (double)MOST_POINTS))
            return failure_set(
                failure, EX_DATAERR,
                "a grid of more than %lld points: a larger --spacing or a smaller --box "
                "has fewer",
                (long long)MOST_POINTS);
        f->n[k] = (int64_t)cells, step[k] = size / cells, origin[k] = r->lo[k] + 0.5 * step[k];
    }
    f->origin = v3(origin[0], origin[1], origin[2]), f->step = v3(step[0], step[1], step[2]);
    return 0;
}

int fields_init(struct fields *f, const struct snapshot *s, double width, double spacing,
                struct failure *failure)
{
    *f = (struct fields){ .width = width > 0 ? width : fields_mean_diameter(s->p) };
    if (!s->p->n) return failure_set(failure, EX_DATAERR, "no bodies to lay a grid over");
    if (grid_init(f, s, spacing, failure)) return failure->status;
    for (int k = 0; k < CONTINUUM_COUNT; k++) {
        size_t numbers = (size_t)fields_points(f) * (size_t)field_quantity[k].width;
        if (!(f->x[k] = calloc(numbers, sizeof *f->x[k])))
            return failure_set(failure, EX_SOFTWARE, "no memory for fields");
    }
    f->moment = calloc((size_t)fields_points(f) * MOMENTS, sizeof *f->moment);
    return f->moment ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for fields");
}

void fields_free(struct fields *f)
{
    for (int k = 0; k < CONTINUUM_COUNT; k++) free(f->x[k]);
    free(f->moment);
    *f = (struct fields){ 0 };
}

/* ---- the points within the cut of a way from x to x + l ---- */

struct fields_patch {
    int64_t from[3], to[3];
};

static struct fields_patch patch_of(const struct fields *f, int dim, vec3 x, vec3 l)
{
    const double at[3] = { x.x, x.y, x.z }, by[3] = { l.x, l.y, l.z };
    const double o[3] = { f->origin.x, f->origin.y, f->origin.z };
    const double h[3] = { f->step.x, f->step.y, f->step.z };
    struct fields_patch b = { { 0, 0, 0 }, { 0, 0, 0 } };
    for (int k = 0; k < 3 && k < dim; k++) {
        double lo = ceil((at[k] + fmin(by[k], 0) - CUT * f->width - o[k]) / h[k]);
        double hi = floor((at[k] + fmax(by[k], 0) + CUT * f->width - o[k]) / h[k]);
        double last = (double)(f->n[k] - 1);
        b.from[k] = (int64_t)fmin(fmax(lo, 0), last + 1),
        b.to[k] = (int64_t)fmax(fmin(hi, last), -1);
    }
    return b;
}

static vec3 point_at(const struct fields *f, int64_t i, int64_t j, int64_t k)
{
    return v3(f->origin.x + (double)i * f->step.x, f->origin.y + (double)j * f->step.y,
              f->origin.z + (double)k * f->step.z);
}

/* 1/m^3, 1/m^2: phi at 0 */
static double greatest(const struct fields *f, int dim)
{
    double w = sqrt(M_PI) * f->width;
    return 1 / (dim == 2 ? w * w : w * w * w);
}

/* The integral over 0 < s < 1 of phi(d - s l), d the way from the beginning of l */
static double fields_along(const struct fields *f, int dim, vec3 d, vec3 l)
{
    double L = v3_norm(l), w = f->width;
    if (!(L > 1e-9 * w)) {
        double d2 = v3_dot(d, d);
        return d2 > CUT * CUT * w * w ? 0 : greatest(f, dim) * exp(-d2 / (w * w));
    }
    double s = v3_dot(d, l) / L, across = fmax(v3_dot(d, d) - s * s, 0);
    double over = fmax(fmax(-s, s - L), 0); // beyond either end
    if (across + over * over > CUT * CUT * w * w) return 0;
    return greatest(f, dim) * exp(-across / (w * w)) * 0.5 * sqrt(M_PI) * w / L *
           (erf(s / w) - erf((s - L) / w));
}

/* ---- the sums ---- */

struct fields_body {
    double mass, volume, radius;
    vec3 v;
};

static void add_tensor(double *to, double s, vec3 a, vec3 b)
{
    const double x[3] = { s * a.x, s * a.y, s * a.z }, y[3] = { b.x, b.y, b.z };
    for (int k = 0; k < 9; k++) to[k] += x[k / 3] * y[k % 3];
}

static void fields_add_body(struct fields *f, int dim, vec3 x, const struct fields_body *b)
{
    struct fields_patch c = patch_of(f, dim, x, v3(0, 0, 0));
    for (int64_t k = c.from[2]; k <= c.to[2]; k++)
        for (int64_t j = c.from[1]; j <= c.to[1]; j++)
            for (int64_t i = c.from[0]; i <= c.to[0]; i++) {
                int64_t at = (k * f->n[1] + j) * f->n[0] + i;
                const vec3 d = v3_sub(x, point_at(f, i, j, k));
                double phi = fields_along(f, dim, v3_scale(-1, d), v3(0, 0, 0));
                if (phi == 0) continue;
                double *momentum = f->x[CONTINUUM_MOMENTUM] + 3 * at, m = phi * b->mass;
                f->x[CONTINUUM_DENSITY][at] += m, f->x[CONTINUUM_FRACTION][at] += phi * b->volume;
                momentum[0] += m * b->v.x, momentum[1] += m * b->v.y, momentum[2] += m * b->v.z;
                add_tensor(f->x[CONTINUUM_KINETIC] + 9 * at, m, b->v, b->v);
                double *sum = f->moment + MOMENTS * at;
                add_tensor(sum + MOMENT_VD, m, b->v, d), add_tensor(sum + MOMENT_DD, m, d, d);
                sum[MOMENT_D] += m * d.x, sum[MOMENT_D + 1] += m * d.y,
                    sum[MOMENT_D + 2] += m * d.z;
                sum[MOMENT_DIAMETER] += 2 * m * b->radius;
            }
}

static void fields_add_contact(struct fields *f, int dim, vec3 x, vec3 l, vec3 force)
{
    struct fields_patch c = patch_of(f, dim, x, l);
    for (int64_t k = c.from[2]; k <= c.to[2]; k++)
        for (int64_t j = c.from[1]; j <= c.to[1]; j++)
            for (int64_t i = c.from[0]; i <= c.to[0]; i++) {
                double phi = fields_along(f, dim, v3_sub(point_at(f, i, j, k), x), l);
                int64_t at = (k * f->n[1] + j) * f->n[0] + i;
                if (phi > 0) add_tensor(f->x[CONTINUUM_CONTACTS] + 9 * at, phi, force, l);
            }
}

/* Velocities from momenta; the motion's stress about them; the whole stress. Where there is no mass
   there is no velocity: 0. */
static void fields_finish(struct fields *f)
{
    for (int64_t i = 0; i < fields_points(f); i++) {
        double density = f->x[CONTINUUM_DENSITY][i], *v = f->x[CONTINUUM_VELOCITY] + 3 * i;
        double *kinetic = f->x[CONTINUUM_KINETIC] + 9 * i;
        for (int k = 0; k < 3; k++)
            v[k] = density > 0 ? f->x[CONTINUUM_MOMENTUM][3 * i + k] / density : 0;
        for (int k = 0; k < 9; k++) {
            kinetic[k] -= density * v[k / 3] * v[k % 3];
            f->x[CONTINUUM_STRESS][9 * i + k] = kinetic[k] + f->x[CONTINUUM_CONTACTS][9 * i + k];
        }
    }
}

/* The inverse of a symmetric matrix of dim dimensions whose eigenvalues are above `least`; false: one is not */
static bool fields_invert(double inverse[9], const double A[9], int dim, double least)
{
    struct tensor T;
    double value[3];
    for (int k = 0; k < 9; k++) T.x[k / 3][k % 3] = A[k], inverse[k] = 0;
    tensor_principal(&T, dim, value);
    if (!(value[dim - 1] > least)) return false;
    if (dim == 2) {
        double det = A[0] * A[4] - A[1] * A[3];
        inverse[0] = A[4] / det, inverse[4] = A[0] / det;
        inverse[1] = -A[1] / det, inverse[3] = -A[3] / det;
        return true;
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            inverse[3 * i + j] = A[3 * a + c] * A[3 * b + d] - A[3 * a + d] * A[3 * b + c];
        }
    double det = A[0] * inverse[0] + A[1] * inverse[3] + A[2] * inverse[6];
    for (int k = 0; k < 9; k++) inverse[k] /= det;
    return true;
}

/* c = a b */
static void fields_multiply(double c[9], const double a[9], const double b[9])
{
    for (int k = 0; k < 9; k++) {
        const int i = k / 3, j = k % 3;
        c[k] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
    }
}

/* G = C M^-1, C = sum m phi (v - V)(d - D)^T and M = sum m phi (d - D)(d - D)^T about the means: the affine flow that
   fits best [Falk and Langer 1998]. What it leaves of sum m phi (v - V)(v - V)^T is the temperature's
   [Artoni and Richard 2015]. NaN where the bodies within reach do not span the space. */
static void finish_gradient(struct fields *f, int dim, int64_t i)
{
    const double density = f->x[CONTINUUM_DENSITY][i], *v = f->x[CONTINUUM_VELOCITY] + 3 * i;
    const double *sum = f->moment + MOMENTS * i, *kinetic = f->x[CONTINUUM_KINETIC] + 9 * i;
    double *G = f->x[CONTINUUM_GRADIENT] + 9 * i, *D = f->x[CONTINUUM_STRAIN_RATE] + 9 * i;
    double C[9], M[9], inverse[9], flow[9], trace = 0, size = 0, left = 0;
    for (int k = 0; k < 9; k++) {
        C[k] = sum[MOMENT_VD + k] - v[k / 3] * sum[MOMENT_D + k % 3];
        M[k] = sum[MOMENT_DD + k] - sum[MOMENT_D + k / 3] * sum[MOMENT_D + k % 3] / density;
    }
    if (!(density > 0) ||
        !fields_invert(inverse, M, dim, FLAT * 0.5 * f->width * f->width * density)) {
        for (int k = 0; k < 9; k++) G[k] = D[k] = NAN;
        f->x[CONTINUUM_SHEAR_RATE][i] = f->x[CONTINUUM_TEMPERATURE][i] =
            f->x[CONTINUUM_INERTIAL][i] = NAN;
        return;
    }
    fields_multiply(G, C, inverse);
    const double turned[9] = { C[0], C[3], C[6], C[1], C[4], C[7], C[2], C[5], C[8] };
    fields_multiply(flow, G, turned); // C M^-1 C^T
    for (int k = 0; k < 9; k++) D[k] = 0.5 * (G[k] + G[3 * (k % 3) + k / 3]);
    for (int k = 0; k < dim; k++) trace += D[4 * k], left += kinetic[4 * k] - flow[4 * k];
    for (int k = 0; k < 9; k++) {
        const bool diagonal = k % 4 == 0 && k / 4 < dim;
        const double d = D[k] - (diagonal ? trace / dim : 0);
        size += 2 * d * d;
    }
    f->x[CONTINUUM_SHEAR_RATE][i] = sqrt(size);
    f->x[CONTINUUM_TEMPERATURE][i] = fmax(left, 0) / (dim * density);
}

/* d and rho_s are the means by mass of the bodies within reach; p is that of contacts and motion. Where nothing presses
   there is no inertial number. */
static void finish_inertial(struct fields *f, int dim, int64_t i)
{
    const double density = f->x[CONTINUUM_DENSITY][i], *stress = f->x[CONTINUUM_STRESS] + 9 * i;
    const double diameter = f->moment[MOMENTS * i + MOMENT_DIAMETER] / density;
    const double solid = density / f->x[CONTINUUM_FRACTION][i];
    const double p = (stress[0] + stress[4] + (dim == 3 ? stress[8] : 0)) / dim;
    f->x[CONTINUUM_INERTIAL][i] =
        p > 0 ? f->x[CONTINUUM_SHEAR_RATE][i] * diameter * sqrt(solid / p) : NAN;
}

/* The grid as a region, for images */
static struct region grid_region(const struct fields *f, const struct packing *p)
{
    struct region r;
    vec3 first = f->origin, last = point_at(f, f->n[0] - 1, f->n[1] - 1, f->n[2] - 1);
    const double lo[3] = { first.x, first.y, first.z }, hi[3] = { last.x, last.y, last.z };
    region_box(&r, p, lo, hi);
    return r;
}

/* Do widths, and the ways of bodies to where contacts are, reach few images of the cell? */
static int check_reach(const struct fields *f, const struct packing *p, const struct region *r,
                       double ahead, struct failure *failure)
{
    double fastest = 0;
    for (int64_t i = 0; ahead != 0 && i < p->n; i++) fastest = fmax(fastest, v3_norm(p->v[i]));
    return region_check_images(r, p->n, CUT * f->width + fabs(ahead) * fastest,
                               "--fields: 4 widths and the way of the fastest body reach", failure);
}

int fields_set(struct fields *f, const struct snapshot *s, struct failure *failure)
{
    const struct packing *p = s->p;
    const struct region r = grid_region(f, p);
    const bool solved = s->s && (s->s->found || !s->s->n);
    const double ahead = !s->s ? 0 : s->moved ? -step_after(p) : step_ahead(p);
    if (check_reach(f, p, &r, ahead, failure)) return failure->status;
    for (int k = 0; k < CONTINUUM_COUNT; k++)
        memset(f->x[k], 0,
               (size_t)fields_points(f) * (size_t)field_quantity[k].width * sizeof(double));
    memset(f->moment, 0, (size_t)fields_points(f) * MOMENTS * sizeof *f->moment);
    for (int64_t i = 0; i < p->n; i++) {
        const double margin = CUT * f->width + fabs(ahead) * v3_norm(p->v[i]);
        struct region_walk w = region_walk(&r, p->x[i], margin);
        for (vec3 y; region_next(&w, &r, p->x[i], &y);) {
            vec3 v = v3_add(p->v[i], region_rate(&w, &r)); // an image moves as its cell does
            const struct fields_body b = { p->mass[i], grain_volume(p, i), p->radius[i], v };
            fields_add_body(f, p->dim, v3_axpy(y, ahead, v), &b);
        }
    }
    for (int64_t i = 0; solved && i < s->s->n; i++) {
        vec3 x = branch_from(p, &s->s->c[i]), l = branch_way(p, &s->s->c[i]);
        struct region_walk w = region_walk(&r, x, CUT * f->width + v3_norm(l));
        for (vec3 y; region_next(&w, &r, x, &y);)
            fields_add_contact(f, p->dim, v3_axpy(y, ahead, region_rate(&w, &r)), l,
                               branch_force(p, s->s, i));
    }
    for (int64_t i = 0; !solved && i < 9 * fields_points(f); i++) f->x[CONTINUUM_CONTACTS][i] = NAN;
    fields_finish(f);
    for (int64_t i = 0; i < fields_points(f); i++)
        finish_gradient(f, p->dim, i), finish_inertial(f, p->dim, i);
    return 0;
}
