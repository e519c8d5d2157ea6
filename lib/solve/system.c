/* solve/system.c: the reduction of faces, the factors, and refinement [solve/system.h]. */
#include "solve/system.h"

#include "base/matrix.h"
#include "solve/faces.h"
#include "solve/solver.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <stdlib.h>
#include <string.h>

/*
 * The reduction of a face with rank < rows: D N P = Q (R over 0), as gsl_linalg_QRPT_decomp()
 * stores it. D is large where a contact is open and small where it sticks, so the rows are first
 * scaled and sorted, the largest first, lest the small ones be lost in rounding.
 */
struct reduced {
    double *QR, *tau; /* [rows][rows - rank], [rows - rank] */
    double *inverse;  /* [rank][rank] (L' + D')^-1, by which L' and D' were then multiplied */
    double *scale;    /* [rows] factors of the face's rows */
    int *order;       /* [rows] their order: row i here is the face's row order[i] */
    size_t *columns;  /* [rows - rank] P */
};

struct system {
    const struct scaled *a;
    const double *L, *D; /* of the last system_solve(), borrowed */
    struct faces faces;
    struct lu *lu;
    double *entries;         /* of L' S + D', S's pattern */
    double *w, *y;           /* [faces.size] T' x; S w */
    double *b, *r, *x;       /* [n d] */
    int sign;                /* of the determinants of the faces' transformations */
    struct reduced *reduced; /* [faces.n] */
    double *room;            /* holds the matrices of reduced[] */
    size_t *columns;         /* holds their columns[] */
    int *order;              /* holds their order[] */
    double *l, *d, *t;       /* [rows][rows] of one face: Q' L T, Q' D M, work space */
    double *Z;               /* [common][n d] A^-1 L J; NULL: nothing in common */
    double small[COMMON_MAX * COMMON_MAX]; /* 1 + J^T Z, its factors and their order */
    size_t small_order[COMMON_MAX];
    int small_sign; /* of its determinant */
};

void system_free(struct system *s)
{
    if (!s) return;
    faces_free(&s->faces), lu_free(s->lu);
    free(s->entries), free(s->w), free(s->y), free(s->b), free(s->r), free(s->x);
    free(s->reduced), free(s->room), free(s->columns), free(s->order);
    free(s->l), free(s->d), free(s->t), free(s->Z), free(s);
}

static double *doubles(int64_t n)
{
    return malloc(((size_t)n + 1) * sizeof(double));
}

/* Gives each face its share of room, columns and order. */
static void share_room(struct system *s)
{
    double *at = s->room;
    int *order = s->order;
    size_t *columns = s->columns;
    for (int32_t i = 0; i < s->faces.n; i++) {
        int64_t rows = s->faces.face[i].rows, rank = s->faces.face[i].rank, left = rows - rank;
        struct reduced *q = s->reduced + i;
        if (!left) continue;
        q->QR = at, at += rows * left;
        q->tau = at, at += left;
        q->inverse = at, at += rank * rank;
        q->scale = at, at += rows;
        q->order = order, order += rows;
        q->columns = columns, columns += left;
    }
}

struct system *system_new(const struct scaled *w, double bytes, bool *too_large)
{
    *too_large = false;
    struct system *s = calloc(1, sizeof *s);
    struct faces *f = s ? &s->faces : NULL;
    if (!s || !faces_init(f, &w->W)) {
        free(s);
        return NULL;
    }
    s->a = w;
    int64_t rows = 0, columns = 0, squares = 0, rows_max = 0;
    for (int32_t i = 0; i < f->n; i++) {
        int64_t n = f->face[i].rows, left = n - f->face[i].rank;
        rows_max = n > rows_max ? n : rows_max;
        if (left) rows += n, columns += left, squares += n * left + (n - left) * (n - left);
    }
    s->entries = doubles(f->first[f->size]), s->w = doubles(f->size), s->y = doubles(f->size);
    s->b = doubles(w->size), s->r = doubles(w->size), s->x = doubles(w->size);
    s->room = doubles(squares + columns + rows);
    s->order = malloc(((size_t)rows + 1) * sizeof *s->order);
    s->columns = malloc(((size_t)columns + 1) * sizeof *s->columns);
    s->l = doubles(rows_max * rows_max), s->d = doubles(rows_max * rows_max),
    s->t = doubles(rows_max * rows_max);
    s->reduced = calloc((size_t)f->n + 1, sizeof *s->reduced);
    s->Z = doubles((int64_t)w->size * w->W.common);
    s->lu = lu_new(f->size, f->first, f->col, bytes, too_large);
    if (!s->entries || !s->w || !s->y || !s->b || !s->r || !s->x || !s->room || !s->order ||
        !s->columns || !s->l || !s->d || !s->t || !s->Z || !s->reduced || !s->lu) {
        system_free(s);
        return NULL;
    }
    share_room(s);
    return s;
}

double system_price(const struct system *s)
{
    return price_newton_step(lu_cost(s->lu), s->faces.first[s->faces.size]);
}

double system_price_new(const struct scaled *a)
{
    return price_analysis(delassus_entries(&a->W));
}

double system_price_least(const struct scaled *a)
{
    return price_newton_step(0, delassus_entries(&a->W));
}

/* out[rows][columns] = B A for one face: B is L or D, A[rows][columns] */
static void multiply_blocks(const struct system *s, const struct face *f, const double *B,
                            const double *A, int columns, double *out)
{
    int d = s->a->W.d;
    for (int i = 0; i < f->rows; i++) {
        const double *b = B + 9 * (int64_t)f->contact[i / d] + 3 * (i % d);
        const double *a = A + i / d * d * columns;
        for (int j = 0; j < columns; j++) {
            out[i * columns + j] = 0;
            for (int k = 0; k < d; k++) out[i * columns + j] += b[k] * a[k * columns + j];
        }
    }
}

static gsl_matrix_view view(double *a, int rows, int columns)
{
    return gsl_matrix_view_array(a, (size_t)rows, (size_t)columns);
}

/* out[rows][columns] = the rows of in[rows][columns], scaled and sorted as in the face's QR */
static void sort_rows(const struct face *f, const struct reduced *q, const double *in, int columns,
                      double *out)
{
    for (int i = 0; i < f->rows; i++)
        for (int j = 0; j < columns; j++)
            out[i * columns + j] = q->scale[q->order[i]] * in[q->order[i] * columns + j];
}

static double system_largest(const double *x, int n)
{
    double max = 0;
    for (int i = 0; i < n; i++) max = fmax(max, fabs(x[i]));
    return max;
}

/* scale[] and order[], from DN[rows][rows - rank], by insertion */
static void order_rows(struct system *s, const struct face *f, const struct reduced *q,
                       const double *DN)
{
    int d = s->a->W.d, left = f->rows - f->rank;
    for (int i = 0; i < f->rows; i++) {
        int64_t at = 9 * (int64_t)f->contact[i / d] + 3 * (i % d);
        double size = system_largest(s->L + at, d) + system_largest(s->D + at, d);
        q->scale[i] = size > 0 ? 1 / size : 1;
        int k = i;
        for (; k > 0; k--) {
            int o = q->order[k - 1];
            if (q->scale[o] * system_largest(DN + o * left, left) >=
                q->scale[i] * system_largest(DN + i * left, left))
                break;
            q->order[k] = o, s->sign = -s->sign;
        }
        q->order[k] = i;
    }
}

/*
 * Multiplies L' and D' by (L' + D')^-1, so that their sum is 1: KLU takes its pivots from the
 * diagonal of L' S + D', and the rows that Q' leaves have diagonals of any size. False where L' +
 * D' is singular.
 */
static bool normalise(struct system *s, const struct face *f, const struct reduced *q, double *l,
                      double *d)
{
    int rank = f->rank, sign;
    size_t order[3 * FACE_CONTACTS_MAX];
    gsl_permutation P = { (size_t)rank, order };
    gsl_matrix_view t = view(s->t, rank, rank), F = view(q->inverse, rank, rank);
    for (int i = 0; i < rank * rank; i++) s->t[i] = l[i] + d[i];
    gsl_linalg_LU_decomp(&t.matrix, &P, &sign);
    sign = gsl_linalg_LU_sgndet(&t.matrix, sign);
    if (!sign) return false;
    s->sign *= sign;
    gsl_linalg_LU_invert(&t.matrix, &P, &F.matrix);
    for (int k = 0; k < 2; k++) {
        gsl_matrix_view A = view(k ? d : l, rank, rank);
        gsl_matrix_memcpy(&t.matrix, &A.matrix);
        gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, &F.matrix, &t.matrix, 0, &A.matrix);
    }
    return true;
}

/* L' and D' [rank][rank] of one face; false where it is singular */
static bool system_reduce(struct system *s, const struct face *f, const struct reduced *q,
                          const double **l, const double **d)
{
    int left = f->rows - f->rank, rows = f->rows, rank = f->rank;
    if (!left) {
        for (int i = 0; i < rank; i++)
            for (int j = 0; j < rank; j++) {
                int64_t at = 9 * (int64_t)f->contact[0] + 3 * i + j;
                s->l[rank * i + j] = s->L[at], s->d[rank * i + j] = s->D[at];
            }
        *l = s->l, *d = s->d;
        return true;
    }
    multiply_blocks(s, f, s->D, f->N, left, s->t);
    order_rows(s, f, q, s->t);
    sort_rows(f, q, s->t, left, q->QR);
    multiply_blocks(s, f, s->L, f->T, rank, s->t);
    sort_rows(f, q, s->t, rank, s->l);
    multiply_blocks(s, f, s->D, f->M, rank, s->t);
    sort_rows(f, q, s->t, rank, s->d);
    gsl_matrix_view QR = view(q->QR, rows, left), l0 = view(s->l, rows, rank),
                    d0 = view(s->d, rows, rank);
    gsl_vector_view tau = gsl_vector_view_array(q->tau, (size_t)left),
                    norm = gsl_vector_view_array(s->t, (size_t)left);
    gsl_permutation P = { (size_t)left, q->columns };
    int sign;
    gsl_linalg_QRPT_decomp(&QR.matrix, &tau.vector, &P, &sign, &norm.vector);
    s->sign *= sign;
    for (int i = 0; i < left; i++) s->sign *= q->QR[i * left + i] < 0 ? -1 : 1;
    gsl_linalg_QR_QTmat(&QR.matrix, &tau.vector, &l0.matrix);
    gsl_linalg_QR_QTmat(&QR.matrix, &tau.vector, &d0.matrix);
    *l = s->l + left * rank, *d = s->d + left * rank;
    return normalise(s, f, q, s->l + left * rank, s->d + left * rank);
}

/* entries = L' S + D'; false where a face shows that this is singular */
static bool system_assemble(struct system *s)
{
    const struct faces *F = &s->faces;
    s->sign = 1;
    for (int32_t c = 0; c < F->n; c++) {
        const struct face *f = F->face + c;
        const double *l, *d;
        if (!system_reduce(s, f, s->reduced + c, &l, &d)) return false;
        int32_t first = F->first[f->at], length = F->first[f->at + 1] - first;
        for (int i = 0; i < f->rank; i++) {
            double *a = s->entries + first + (int64_t)i * length;
            memset(a, 0, (size_t)length * sizeof *a);
            for (int k = 0; k < f->rank; k++) {
                const double *S = F->S + first + (int64_t)k * length;
                double lik = l[i * f->rank + k];
                for (int32_t e = 0; e < length; e++) a[e] += lik * S[e];
            }
            for (int32_t e = 0; e < length; e++)
                if (F->col[first + e] == f->at)
                    for (int k = 0; k < f->rank; k++) a[e + k] += d[i * f->rank + k];
        }
    }
    return true;
}

/* Copies of the numbers of a face's rows, from x[n d] and into it */
static void system_load(const struct system *s, const struct face *f, const double *x, double *out)
{
    int d = s->a->W.d;
    for (int i = 0; i < f->rows; i++) out[i] = x[d * (int64_t)f->contact[i / d] + i % d];
}
static void system_store(const struct system *s, const struct face *f, const double *in, double *x)
{
    int d = s->a->W.d;
    for (int i = 0; i < f->rows; i++) x[d * (int64_t)f->contact[i / d] + i % d] = in[i];
}

/* out = Q' in, a face's rows of a right-hand side */
static void apply_Q(const struct face *f, const struct reduced *q, const double *in, double *out)
{
    gsl_matrix_view QR = view(q->QR, f->rows, f->rows - f->rank);
    gsl_vector_view tau = gsl_vector_view_array(q->tau, QR.matrix.size2),
                    v = gsl_vector_view_array(out, (size_t)f->rows);
    sort_rows(f, q, in, 1, out);
    gsl_linalg_QR_QTvec(&QR.matrix, &tau.vector, &v.vector);
}

/* out[rows] = A[rows][columns] z */
static void system_multiply(const double *A, int rows, int columns, const double *z, double *out)
{
    for (int i = 0; i < rows; i++) {
        out[i] = 0;
        for (int j = 0; j < columns; j++) out[i] += A[i * columns + j] * z[j];
    }
}

/* A face's x = M w + N n, from w and y = S w */
static void recover(struct system *s, const struct face *f, const struct reduced *q,
                    const double *b, double *x)
{
    int rows = f->rows, rank = f->rank, left = rows - rank;
    double *e = s->l, *v = s->d, *xf = s->t;
    // e = b - L T y - D M w, and R n = the first rows of Q' e
    system_load(s, f, b, e);
    system_multiply(f->T, rows, rank, s->y + f->at, xf);
    multiply_blocks(s, f, s->L, xf, 1, v);
    for (int i = 0; i < rows; i++) e[i] -= v[i];
    system_multiply(f->M, rows, rank, s->w + f->at, xf);
    multiply_blocks(s, f, s->D, xf, 1, v);
    for (int i = 0; i < rows; i++) e[i] -= v[i];
    apply_Q(f, q, e, v);
    gsl_matrix_view QR = view(q->QR, rows, left),
                    R = gsl_matrix_submatrix(&QR.matrix, 0, 0, (size_t)left, (size_t)left);
    gsl_vector_view n = gsl_vector_view_array(v, (size_t)left);
    gsl_blas_dtrsv(CblasUpper, CblasNoTrans, CblasNonUnit, &R.matrix, &n.vector);
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < left; j++) xf[i] += f->N[i * left + (int)q->columns[j]] * v[j];
    system_store(s, f, xf, x);
}

/* x = A^-1 b, to the accuracy of the factors */
static bool substitute_blocks(struct system *s, const double *b, double *x)
{
    const struct faces *F = &s->faces;
    bool reduced = F->size < s->a->size;
    for (int32_t c = 0; c < F->n; c++) {
        const struct face *f = F->face + c;
        int left = f->rows - f->rank;
        system_load(s, f, b, left ? s->t : s->w + f->at);
        if (!left) continue;
        apply_Q(f, s->reduced + c, s->t, s->l);
        system_multiply(s->reduced[c].inverse, f->rank, f->rank, s->l + left, s->w + f->at);
    }
    if (!lu_substitute(s->lu, s->w)) return false;
    for (int32_t i = 0; reduced && i < F->size; i++) {
        s->y[i] = 0;
        for (int32_t k = F->first[i]; k < F->first[i + 1]; k++)
            s->y[i] += F->S[k] * s->w[F->col[k]];
    }
    for (int32_t c = 0; c < F->n; c++) {
        const struct face *f = F->face + c;
        if (f->rank < f->rows)
            recover(s, f, s->reduced + c, b, x);
        else
            system_store(s, f, s->w + f->at, x);
    }
    return true;
}

/* The factors of 1 + J^T Z as GSL has them */
static gsl_matrix_view small_of(struct system *s)
{
    return view(s->small, s->a->W.common, s->a->W.common);
}

/* Z and the factors of 1 + J^T Z; false where these are singular */
static bool factorise_common(struct system *s)
{
    const struct delassus *W = &s->a->W;
    const int n = W->common, d = W->d;
    const int64_t size = s->a->size;
    s->small_sign = 1;
    if (!n) return true;
    for (int k = 0; k < n; k++) {
        for (int64_t i = 0; i < size; i++) {
            const double *L = s->L + 9 * (i / d) + 3 * (i % d);
            s->r[i] = 0;
            for (int j = 0; j < d; j++) s->r[i] += L[j] * W->J[n * (i - i % d + j) + k];
        }
        if (!substitute_blocks(s, s->r, s->Z + size * k)) return false;
    }
    for (int k = 0; k < n; k++) {
        double part[COMMON_MAX];
        delassus_common(W, s->Z + size * k, part);
        for (int i = 0; i < n; i++) s->small[n * i + k] = (i == k) + part[i];
    }
    gsl_matrix_view A = small_of(s);
    gsl_permutation P = { (size_t)n, s->small_order };
    gsl_linalg_LU_decomp(&A.matrix, &P, &s->small_sign);
    s->small_sign = gsl_linalg_LU_sgndet(&A.matrix, s->small_sign);
    return s->small_sign != 0;
}

/* x = (L W + D)^-1 b, to the accuracy of the factors */
static bool substitute(struct system *s, const double *b, double *x)
{
    const int n = s->a->W.common;
    const int64_t size = s->a->size;
    if (!substitute_blocks(s, b, x)) return false;
    if (!n) return true;
    double y[COMMON_MAX];
    delassus_common(&s->a->W, x, y);
    gsl_matrix_view A = small_of(s);
    gsl_permutation P = { (size_t)n, s->small_order };
    gsl_vector_view v = gsl_vector_view_array(y, (size_t)n);
    gsl_linalg_LU_svx(&A.matrix, &P, &v.vector);
    for (int k = 0; k < n; k++)
        for (int64_t i = 0; i < size; i++) x[i] -= s->Z[size * k + i] * y[k];
    return true;
}

/* r = b - (L W + D) x; returns the largest |r| over the largest |b|. */
static double system_residual(struct system *s, const double *x)
{
    int d = s->a->W.d == 3 ? 3 : 2;
    double worst = 0, size = 0;
    scaled_product(s->a, x, s->r);
    for (int64_t c = 0; c < s->a->W.n; c++) {
        const double *L = s->L + 9 * c, *D = s->D + 9 * c;
        double v[3], e[3] = { 0 }, z[3];
        scaled_load(d, s->r + d * c, v), scaled_load(d, x + d * c, z);
        for (int i = 0; i < d; i++) {
            e[i] = s->b[d * c + i];
            for (int j = 0; j < d; j++) e[i] -= L[3 * i + j] * v[j] + D[3 * i + j] * z[j];
            if (isnan(e[i])) return NAN;
            worst = fmax(worst, fabs(e[i])), size = fmax(size, fabs(s->b[d * c + i]));
        }
        scaled_store(d, e, s->r + d * c);
    }
    return size > 0 ? worst / size : 0;
}

bool system_solve_again(struct system *s, double *x)
{
    int32_t size = s->a->size;
    memcpy(s->b, x, (size_t)size * sizeof *x);
    if (!substitute(s, s->b, x)) return false;
    double e = system_residual(s, x);
    for (int k = 0; k < 3 && e > 1e-10; k++) {
        if (!substitute(s, s->r, s->x)) return false;
        for (int32_t i = 0; i < size; i++) x[i] += s->x[i];
        double before = e;
        e = system_residual(s, x);
        if (e < before / 4) continue;
        if (e < before) break;
        for (int32_t i = 0; i < size; i++) x[i] -= s->x[i];
        e = before;
        break;
    }
    return e < 1e-4;
}

bool system_solve(struct system *s, const double *L, const double *D, double *x)
{
    s->L = L, s->D = D;
    return system_assemble(s) && lu_factorise(s->lu, s->entries) && factorise_common(s) &&
           system_solve_again(s, x);
}

int system_sign(const struct system *s)
{
    return s->sign * lu_sign(s->lu) * s->small_sign;
}
