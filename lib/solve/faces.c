/* solve/faces.c: the search for faces, their matrices, and S [solve/faces.h]. */
#include "solve/faces.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SAME 1e-9 /* entries of order 1 that differ by less are equal */

/* ---- which contacts have the same neighbours ---- */

struct mark {
    uint64_t sum; /* of the hashes of its neighbours and its own */
    int32_t contact;
};

static uint64_t hash(uint64_t x)
{
    x = (x + 1) * 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 31)) * 0xbf58476d1ce4e5b9u;
    return x ^ (x >> 29);
}

static int by_sum(const void *a, const void *b)
{
    const struct mark *x = a, *y = b;
    if (x->sum != y->sum) return x->sum < y->sum ? -1 : 1;
    return x->contact < y->contact ? -1 : 1;
}

/* W_ab, d x d by columns; NULL: zeros */
static const double *block(const struct delassus *W, int32_t a, int32_t b)
{
    int64_t low = W->first[a], high = W->first[a + 1];
    while (low < high) {
        int64_t mid = (low + high) / 2;
        if (W->col[mid] < b)
            low = mid + 1;
        else
            high = mid;
    }
    return low < W->first[a + 1] && W->col[low] == b ? W->block + W->d * W->d * low : NULL;
}

static double entry(const struct delassus *W, int32_t a, int i, int32_t b, int j)
{
    if (a == b) return W->diag[9 * (int64_t)a + i + 3 * j];
    const double *B = block(W, a, b);
    return B ? B[i + W->d * j] : 0;
}

/* ---- one face ---- */

/*
 * Finds rows of W_gg of which all others are combinations, by QR with column pivoting: pivot[rank],
 * and the combinations T[rows][rank]. Returns the rank.
 */
static int find_pivots(const gsl_matrix *Wgg, int *pivot, gsl_matrix *T)
{
    int n = (int)Wgg->size1, rank = 0, sign;
    double a[9 * FACE_CONTACTS_MAX * FACE_CONTACTS_MAX], tau[3 * FACE_CONTACTS_MAX],
        norm[3 * FACE_CONTACTS_MAX];
    size_t order[3 * FACE_CONTACTS_MAX];
    gsl_permutation P = { (size_t)n, order };
    gsl_matrix_view A = gsl_matrix_view_array(a, (size_t)n, (size_t)n);
    gsl_vector_view Tau = gsl_vector_view_array(tau, (size_t)n),
                    Norm = gsl_vector_view_array(norm, (size_t)n);
    gsl_matrix_memcpy(&A.matrix, Wgg);
    gsl_linalg_QRPT_decomp(&A.matrix, &Tau.vector, &P, &sign, &Norm.vector);
    while (rank < n && fabs(a[rank * n + rank]) > SAME) rank++;
    gsl_matrix_set_zero(T);
    for (int j = 0; j < n; j++) { // column order[j] is the sum of z_i times pivot column i
        double z[3 * FACE_CONTACTS_MAX];
        for (int i = 0; i < rank; i++) z[i] = j == i;
        for (int i = rank - 1; j >= rank && i >= 0; i--) {
            z[i] = a[i * n + j];
            for (int k = i + 1; k < rank; k++) z[i] -= a[i * n + k] * z[k];
            z[i] /= a[i * n + i];
        }
        for (int i = 0; i < rank; i++) gsl_matrix_set(T, order[j], (size_t)i, z[i]);
    }
    for (int i = 0; i < rank; i++) pivot[i] = (int)order[i];
    return rank;
}

/* Whether the rows of W_gb are the same combinations of the pivots' rows */
static bool rows_follow(const struct delassus *W, const struct face *f, int32_t b, const int *pivot,
                        const gsl_matrix *T)
{
    int d = W->d;
    for (int j = 0; j < d; j++)
        for (int i = 0; i < f->rows; i++) {
            double off = entry(W, f->contact[i / d], i % d, b, j);
            for (int k = 0; k < f->rank; k++)
                off -= gsl_matrix_get(T, (size_t)i, (size_t)k) *
                       entry(W, f->contact[pivot[k] / d], pivot[k] % d, b, j);
            if (!(fabs(off) < SAME)) return false;
        }
    return true;
}

/* M = Q_1 R^-T and N = Q_2, where T = Q R and Q = (Q_1 Q_2) */
static void null_space(struct face *f, const gsl_matrix *T)
{
    size_t n = (size_t)f->rows, r = (size_t)f->rank;
    double a[9 * FACE_CONTACTS_MAX * FACE_CONTACTS_MAX],
        q[9 * FACE_CONTACTS_MAX * FACE_CONTACTS_MAX], tau[3 * FACE_CONTACTS_MAX];
    gsl_matrix_view A = gsl_matrix_view_array(a, n, r), Q = gsl_matrix_view_array(q, n, n),
                    M = gsl_matrix_view_array(f->M, n, r);
    gsl_vector_view Tau = gsl_vector_view_array(tau, r);
    gsl_matrix_memcpy(&A.matrix, T);
    gsl_linalg_QR_decomp(&A.matrix, &Tau.vector);
    gsl_matrix_set_identity(&Q.matrix);
    for (size_t j = 0; j < n; j++) {
        gsl_vector_view Qj = gsl_matrix_column(&Q.matrix, j);
        gsl_linalg_QR_Qvec(&A.matrix, &Tau.vector, &Qj.vector);
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < r; j++) gsl_matrix_set(&M.matrix, i, j, q[i * n + j]);
        for (size_t j = r; j < n; j++) f->N[i * (n - r) + j - r] = q[i * n + j];
    }
    gsl_matrix_view R = gsl_matrix_submatrix(&A.matrix, 0, 0, r, r);
    gsl_blas_dtrsm(CblasRight, CblasUpper, CblasTrans, CblasNonUnit, 1, &R.matrix, &M.matrix);
}

/* Fills rank and matrices of f, whose contacts are known, into room[2 rows^2]; and pivot[rows].
   False where no contact repeats another. */
static bool face_init(const struct delassus *W, struct face *f, int *pivot, double *room)
{
    int d = W->d;
    size_t n = (size_t)f->rows;
    double wgg[9 * FACE_CONTACTS_MAX * FACE_CONTACTS_MAX],
        t[9 * FACE_CONTACTS_MAX * FACE_CONTACTS_MAX];
    gsl_matrix_view Wgg = gsl_matrix_view_array(wgg, n, n), All = gsl_matrix_view_array(t, n, n);
    for (int i = 0; i < f->rows; i++)
        for (int j = 0; j < f->rows; j++)
            wgg[(int)n * i + j] = entry(W, f->contact[i / d], i % d, f->contact[j / d], j % d);
    f->rank = find_pivots(&Wgg.matrix, pivot, &All.matrix);
    if (!f->rank || f->rank == f->rows) return false;
    size_t r = (size_t)f->rank;
    gsl_matrix_view T = gsl_matrix_submatrix(&All.matrix, 0, 0, n, r);
    for (int64_t e = W->first[f->contact[0]]; e < W->first[f->contact[0] + 1]; e++)
        if (!rows_follow(W, f, W->col[e], pivot, &T.matrix)) return false;
    f->T = room, f->M = room + n * r, f->N = room + 2 * n * r;
    gsl_matrix_view kept = gsl_matrix_view_array(f->T, n, r);
    gsl_matrix_memcpy(&kept.matrix, &T.matrix);
    null_space(f, &T.matrix);
    return true;
}

/* ---- all faces ---- */

/* The contacts sorted by the hash of their neighbours: those of a face are then side by side */
static void sort_by_neighbours(const struct delassus *W, struct mark *m)
{
    for (int64_t c = 0; c < W->n; c++) {
        m[c] = (struct mark){ hash((uint64_t)c), (int32_t)c };
        for (int64_t e = W->first[c]; e < W->first[c + 1]; e++)
            m[c].sum += hash((uint64_t)W->col[e]);
    }
    qsort(m, (size_t)W->n, sizeof *m, by_sum);
}

/* One more face g, with its pivots pivot[rank] */
static void add_face(struct faces *f, int d, struct face g, const int *pivot)
{
    g.at = f->size;
    for (int i = 0; i < g.rank; i++) f->row[f->size++] = d * g.contact[pivot[i] / d] + pivot[i] % d;
    f->face[f->n++] = g;
}

/* Contacts with the same neighbours, as one face or one each. Returns the rest of the room. */
static double *faces_add_faces(struct faces *f, const struct delassus *W, int32_t *contact,
                               int count, double *room)
{
    int pivot[3 * FACE_CONTACTS_MAX] = { 0 }, d = W->d;
    struct face g = { .contact = contact, .count = count, .rows = d * count };
    if (count > 1 && face_init(W, &g, pivot, room)) {
        add_face(f, d, g, pivot);
        return room + 2 * g.rows * g.rows;
    }
    for (int i = 0; i < d; i++) pivot[i] = i;
    for (int k = 0; k < count; k++)
        add_face(f, d, (struct face){ .contact = contact + k, .count = 1, .rows = d, .rank = d },
                 pivot);
    return room;
}

static bool find_faces(struct faces *f, const struct delassus *W)
{
    size_t n = (size_t)W->n;
    struct mark *m = malloc((n + 1) * sizeof *m);
    if (!m) return false;
    sort_by_neighbours(W, m);
    size_t room = 1;
    for (int pass = 0; pass < 2; pass++) { // first the size of the room, then its contents
        double *free_room = f->room;
        for (size_t i = 0, j; i < n; i = j) {
            for (j = i + 1; j < n && j < i + FACE_CONTACTS_MAX && m[j].sum == m[i].sum; j++)
                continue;
            size_t rows = (j - i) * (size_t)W->d;
            if (!pass) {
                room += j > i + 1 ? 2 * rows * rows : 0;
                continue;
            }
            for (size_t k = i; k < j; k++) f->contact[k] = m[k].contact;
            free_room = faces_add_faces(f, W, f->contact + i, (int)(j - i), free_room);
        }
        if (!pass && !(f->room = malloc(room * sizeof *f->room))) break;
    }
    free(m);
    return f->room != NULL;
}

static int ascending(const void *a, const void *b)
{
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* near[]: the faces that face g has blocks of W with, itself among them, ascending; returns their
   number. of[c] is the face of contact c. */
static int32_t neighbour_faces(const struct faces *f, const struct delassus *W,
                               const struct face *g, const int32_t *of, int32_t *near)
{
    int32_t count = 0, distinct = 0, c = f->row[g->at] / W->d;
    near[count++] = of[c];
    for (int64_t e = W->first[c]; e < W->first[c + 1]; e++) near[count++] = of[W->col[e]];
    qsort(near, (size_t)count, sizeof *near, ascending);
    for (int32_t i = 0; i < count; i++)
        if (!i || near[i] != near[i - 1]) near[distinct++] = near[i];
    return distinct;
}

/* S by rows; near[n] is work space. */
static void fill_S(struct faces *f, const struct delassus *W, const int32_t *of, int32_t *near)
{
    int d = W->d;
    int32_t k = 0;
    for (int32_t i = 0; i < f->n; i++) {
        const struct face *g = f->face + i;
        int32_t distinct = neighbour_faces(f, W, g, of, near);
        for (int32_t row = g->at; row < g->at + g->rank; row++) {
            f->first[row] = k;
            for (int32_t h = 0; h < distinct; h++)
                for (int j = 0; j < f->face[near[h]].rank; j++, k++) {
                    f->col[k] = f->face[near[h]].at + j;
                    int32_t a = f->row[row], b = f->row[f->col[k]];
                    f->S[k] = entry(W, a / d, a % d, b / d, b % d);
                }
        }
    }
    f->first[f->size] = k;
}

static bool build_S(struct faces *f, const struct delassus *W)
{
    size_t n = (size_t)W->n, most = (size_t)(W->first[n] + W->n) * (size_t)(W->d * W->d);
    int32_t *of = calloc(n + 1, sizeof *of), *near = calloc(n + 1, sizeof *near);
    f->first = malloc(((size_t)f->size + 1) * sizeof *f->first);
    f->col = malloc((most + 1) * sizeof *f->col), f->S = malloc((most + 1) * sizeof *f->S);
    bool good = of && near && f->first && f->col && f->S;
    if (good) {
        for (int32_t i = 0; i < f->n; i++)
            for (int32_t c = 0; c < f->face[i].count; c++) of[f->face[i].contact[c]] = i;
        fill_S(f, W, of, near);
    }
    free(of), free(near);
    return good;
}

void faces_free(struct faces *f)
{
    free(f->face), free(f->contact), free(f->room), free(f->row);
    free(f->first), free(f->col), free(f->S);
    *f = (struct faces){ 0 };
}

bool faces_init(struct faces *f, const struct delassus *W)
{
    size_t n = (size_t)W->n;
    *f = (struct faces){ 0 };
    f->face = calloc(n + 1, sizeof *f->face);
    f->contact = calloc(n + 1, sizeof *f->contact);
    f->row = calloc(3 * n + 1, sizeof *f->row);
    if (f->face && f->contact && f->row && find_faces(f, W) && build_S(f, W)) return true;
    faces_free(f);
    return false;
}
