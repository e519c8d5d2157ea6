/* solve/assembly.c: Jacobians, and the matrices made of them [solve/assembly.h]. */
#include "solve/assembly.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

static int assembly_short_of_memory(struct failure *failure)
{
    return failure_set(failure, EX_SOFTWARE, "out of memory for an FCLIB problem");
}

void assembly_free(struct assembly *A)
{
    free(A->slot), free(A->end), free(A->q), free(A->w), free(A->free), free(A->pulled);
    lists_free(&A->of);
    lists_free(&A->yield);
    *A = (struct assembly){ 0 };
}

static const struct bundle *assembly_bundle(const struct assembly *A, int64_t c)
{
    return slot_bundle(A->p, A->slot[c]);
}

/* out[n d] = D u~ = u + E u^- of every contact, with the velocities of body[] */
static void assembly_velocity(const struct assembly *A, struct body *body, double *out)
{
    int d = A->p->d;
    assert(d == 2 || d == 3);
    for (int64_t c = 0; c < A->p->n; c++) {
        const struct rebound *e = slot_rebound(A->p, A->slot[c]);
        int lane = slot_lane(A->slot[c]);
        double u[3];
        problem_velocity(A->p, body, A->slot[c] / BUNDLE, NULL, lane, u);
        for (int k = 0; k < d; k++) {
            const double s =
                e ? e->s[k > 0][lane] : 1; // without the springs: r is not that of body[]
            *out++ = e ? (s * u[k] + e->offset[k][lane]) / s : u[k];
        }
    }
}

/* m/s, rad/s: of a freedom without the reactions */
static double free_speed(const struct assembly *A, const struct freedom *f)
{
    double pull = A->pulled ? A->pulled[f - A->p->coupling->freedoms.f] : 0;
    return f->speed + A->p->dt * f->force / f->mass + pull;
}

/* m/s, rad/s: of the freedoms, what cohesion pulls; NULL: nothing, or no memory, which *good tells */
static double *pulled(const struct assembly *A, bool *good)
{
    const struct couplings *y = A->p->coupling;
    *good = true;
    if (!y || !A->p->pull) return NULL;
    double *speed = calloc((size_t)y->freedoms.n + 1, sizeof *speed);
    *good = speed != NULL;
    for (int64_t i = 0; speed && i < y->n; i++) {
        const struct coupling *c = &y->of[i];
        double pull = A->p->pull[A->slot[c->contact]];
        speed[c->freedom] -= c->J[0] * pull / y->freedoms.f[c->freedom].mass;
    }
    return speed;
}

/* The bodies are as fast as the freedoms were before the step: q gets what the forces add to that,
   and w loses it. */
static bool assembly_add_freedoms(struct assembly *A)
{
    A->pulled = NULL;
    bool good;
    if (!(A->pulled = pulled(A, &good)) && !good) return false;
    const struct couplings *y = A->p->coupling;
    int d = A->p->d;
    for (int64_t i = 0; y && i < y->n; i++) {
        const struct coupling *c = &y->of[i];
        const struct freedom *f = &y->freedoms.f[c->freedom];
        double more = free_speed(A, f) - f->speed;
        for (int k = 0; k < d; k++) {
            A->q[d * c->contact + k] += more * c->J[k];
            A->w[d * c->contact + k] -= f->speed * c->J[k];
        }
    }
    return true;
}

static bool list_freedoms(struct assembly *A)
{
    const struct couplings *y = A->p->coupling;
    int64_t n = y ? y->n : 0;
    int32_t *owner = malloc((size_t)(n + 1) * sizeof *owner);
    for (int64_t i = 0; owner && i < n; i++) owner[i] = y->of[i].freedom;
    bool good = owner && lists_init(&A->yield, y ? y->freedoms.n : 0, n, owner);
    free(owner);
    return good;
}

/* q from the bodies without the reactions; w with the movable bodies at rest as well */
static bool assembly_vectors(struct assembly *A)
{
    const struct problem *p = A->p;
    struct body *still = calloc((size_t)p->bodies + 1, sizeof *still);
    if (!still) return false;
    if (p->bodies) memcpy(A->free, p->body, (size_t)p->bodies * sizeof *still);
    for (int64_t i = 0; i < p->slots; i++) {
        double r[3], u[3];
        if (p->contact[i] < 0) continue;
        slot_get(p, i, r, u);
        const double back[3] = { -r[0], -r[1], -r[2] };
        problem_push(p, A->free, i / BUNDLE, slot_lane(i), back);
    }
    for (int64_t i = 0; i < p->bodies; i++) {
        still[i] = A->free[i];
        if (still[i].im > 0) memset(still[i].v, 0, sizeof still[i].v);
        if (still[i].im > 0 && still[i].ii > 0) memset(still[i].w, 0, sizeof still[i].w);
    }
    assembly_velocity(A, A->free, A->q);
    assembly_velocity(A, still, A->w);
    free(still);
    return assembly_add_freedoms(A);
}

int assembly_init(struct assembly *A, const struct problem *p, struct failure *failure)
{
    *A = (struct assembly){ .p = p };
    size_t n = (size_t)p->n, nd = n * (size_t)p->d;
    A->slot = malloc((n + 1) * sizeof *A->slot);
    A->end = calloc(2 * n + 1, sizeof *A->end);
    A->q = malloc((nd + 1) * sizeof *A->q);
    A->w = malloc((nd + 1) * sizeof *A->w);
    A->free = calloc((size_t)p->bodies + 1, sizeof *A->free);
    bool good = A->slot && A->end && A->q && A->w && A->free;
    for (int64_t i = 0; good && i < p->slots; i++) {
        int64_t c = p->contact[i];
        if (c < 0) continue;
        int64_t a = body_index(slot_bundle(p, i)->a[slot_lane(i)]),
                b = body_index(slot_bundle(p, i)->b[slot_lane(i)]);
        A->slot[c] = i;
        A->end[2 * c] = p->body[a].im > 0 ? (int32_t)a : -1;
        A->end[2 * c + 1] = p->body[b].im > 0 ? (int32_t)b : -1;
    }
    good = good && lists_init(&A->of, p->bodies, 2 * p->n, A->end) && list_freedoms(A) &&
           assembly_vectors(A);
    return good ? 0 : assembly_short_of_memory(failure);
}

/* J: u_c = J (v, w), or J (v, y) of levers, for the body at this end of the contact, as in bundle_velocity() */
static void jacobian(const struct assembly *A, int64_t contact, int end, double J[3][6])
{
    const struct bundle *c = assembly_bundle(A, contact);
    const struct levers *g = A->p->lever ? &A->p->lever[A->slot[contact] / BUNDLE] : NULL;
    int i = slot_lane(A->slot[contact]);
    double sign = end ? 1 : -1, l = end ? c->lb[i] : c->la[i], n[3], t1[3], t2[3];
    bundle_basis(c, bundle_beside(A->p, c), i, n, t1, t2);
    for (int k = 0; k < 3; k++) {
        J[0][k] = sign * n[k], J[0][3 + k] = 0;
        J[1][k] = sign * t1[k], J[1][3 + k] = -l * t2[k];
        J[2][k] = sign * t2[k], J[2][3 + k] = l * t1[k];
        for (int j = 0; j < 3 && g; j++) J[j][3 + k] = sign * (end ? g->Gb : g->Ga)[3 * j + k][i];
    }
}

/* Whose freedoms are in the blocks of W: of all, or of those that not all contacts have in common */
enum blocks_of { ALL, NOT_COMMON };

static bool in_blocks(const struct couplings *y, const struct coupling *of, enum blocks_of which)
{
    return which == ALL || !freedom_common(&y->freedoms.f[of->freedom]);
}

/* B += J_c J_b^T / m over the freedoms that c and b share */
static void assembly_add_shared(const struct couplings *y, int64_t c, int64_t b,
                                enum blocks_of which, double B[3][3])
{
    for (int64_t k = y->first[c]; k < y->first[c + 1]; k++)
        for (int64_t l = y->first[b]; l < y->first[b + 1]; l++) {
            const struct coupling *of_c = &y->of[k], *of_b = &y->of[l];
            if (of_c->freedom != of_b->freedom || !in_blocks(y, of_c, which)) continue;
            double m = y->freedoms.f[of_c->freedom].mass;
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++) B[i][j] += of_c->J[i] * of_b->J[j] / m;
        }
}

/* kg^-1: of component k of contact c, in D u~; 0: rigid */
static double compliance(const struct assembly *A, int64_t c, int k)
{
    const struct rebound *e = slot_rebound(A->p, A->slot[c]);
    const int lane = slot_lane(A->slot[c]);
    return e ? e->soft[k > 0][lane] / e->s[k > 0][lane] : 0;
}

/* B = W_cb, the sum of J_c M^-1 J_b^T over the movable bodies and the freedoms that c and b
   share */
static void assembly_block(const struct assembly *A, int64_t c, int64_t b, enum blocks_of which,
                           double B[3][3])
{
    memset(B, 0, 9 * sizeof **B);
    for (int s = 0; s < 4; s++) {
        int32_t body = A->end[2 * c + s / 2];
        if (body < 0 || body != A->end[2 * b + s % 2]) continue;
        double im = A->p->body[body].im, ii = A->p->body[body].ii, J[3][6], K[3][6];
        jacobian(A, c, s / 2, J);
        jacobian(A, b, s % 2, K);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                B[i][j] += im * (J[i][0] * K[j][0] + J[i][1] * K[j][1] + J[i][2] * K[j][2]) +
                           ii * (J[i][3] * K[j][3] + J[i][4] * K[j][4] + J[i][5] * K[j][5]);
    }
    if (A->p->coupling) assembly_add_shared(A->p->coupling, c, b, which, B);
    for (int i = 0; c == b && A->p->kind.soft && i < 3; i++) B[i][i] += compliance(A, c, i);
}

/* The contacts of a body or a freedom, ascending, while they are being merged with others */
struct queue {
    const int64_t *at, *end;
    const struct coupling *of; /* of a freedom: contact of[*at].contact; of a body, NULL: *at / 2 */
};

static int64_t queue_first(const struct queue *q)
{
    if (q->at == q->end) return INT64_MAX;
    return q->of ? q->of[*q->at].contact : *q->at / 2;
}

static struct queue queue_of(const struct lists *lists, int64_t owner, const struct coupling *of)
{
    return (struct queue){ lists->item + lists->first[owner], lists->item + lists->first[owner + 1],
                           of };
}

/* near[] = the contacts that share a movable body or a freedom with c, c too, ascending; returns
   how many. */
static int64_t assembly_neighbours(const struct assembly *A, int64_t c, enum blocks_of which,
                                   int64_t *near)
{
    const struct couplings *y = A->p->coupling;
    struct queue q[2 + COUPLINGS_MAX];
    int64_t count = 0;
    int queues = 0;
    for (int s = 0; s < 2; s++)
        if (A->end[2 * c + s] >= 0) q[queues++] = queue_of(&A->of, A->end[2 * c + s], NULL);
    for (int64_t k = y ? y->first[c] : 0; y && k < y->first[c + 1]; k++)
        if (in_blocks(y, &y->of[k], which))
            q[queues++] = queue_of(&A->yield, y->of[k].freedom, y->of);
    for (;;) {
        int64_t next = INT64_MAX;
        for (int k = 0; k < queues; k++) {
            int64_t first = queue_first(&q[k]);
            next = first < next ? first : next;
        }
        if (next == INT64_MAX) return count;
        near[count++] = next;
        for (int k = 0; k < queues; k++)
            while (queue_first(&q[k]) == next) q[k].at++;
    }
}

static void fill_W(const struct assembly *A, struct stored *W, int64_t *near)
{
    int d = A->p->d;
    int64_t k = 0;
    for (int64_t c = 0; c < A->p->n; c++) {
        int64_t count = assembly_neighbours(A, c, ALL, near);
        for (int64_t b = 0; b < count; b++) {
            double B[3][3];
            assembly_block(A, c, near[b], ALL, B);
            for (int i = 0; i < d; i++)
                for (int j = 0; j < d; j++) {
                    int64_t e = k + (i * count + b) * d + j;
                    W->i[e] = (int32_t)(d * near[b] + j), W->x[e] = B[i][j];
                }
        }
        for (int i = 0; i < d; i++) W->p[d * c + i + 1] = (int32_t)(k += count * d);
    }
}

int assembly_W(const struct assembly *A, struct stored *W, struct failure *failure)
{
    int64_t n = A->p->n, d = A->p->d, blocks = 0;
    *W = (struct stored){ 0 };
    int64_t *near = malloc((size_t)(n + 1) * sizeof *near);
    if (!near) return assembly_short_of_memory(failure);
    for (int64_t c = 0; c < n; c++) blocks += assembly_neighbours(A, c, ALL, near);
    int e = 0;
    if (n * d > INT32_MAX || blocks * d * d > INT32_MAX)
        e = failure_set(failure, EX_DATAERR,
                        "/fclib_local/W: too large for the 32-bit indices of FCLIB");
    else if (!stored_init(W, n * d, n * d, -2, blocks * d * d))
        e = assembly_short_of_memory(failure);
    else
        fill_W(A, W, near);
    free(near);
    return e;
}

/* J m^-1/2 of the freedoms that all contacts have in common */
static int assembly_common(const struct assembly *A, struct delassus *W, struct failure *failure)
{
    const struct couplings *y = A->p->coupling;
    int32_t columns = 0, walls = 0; // the walls' come first
    for (int32_t k = 0; y && k < y->freedoms.n; k++)
        *(freedom_common(&y->freedoms.f[k]) ? &columns : &walls) += 1;
    if (!columns) return 0;
    if (delassus_alloc_common(W, columns, failure)) return failure->status;
    for (int64_t i = 0; i < y->n; i++) {
        const struct coupling *of = &y->of[i];
        if (!freedom_common(&y->freedoms.f[of->freedom])) continue;
        double root = 1 / sqrt(y->freedoms.f[of->freedom].mass);
        for (int k = 0; k < W->d; k++)
            W->J[columns * (W->d * of->contact + k) + of->freedom - walls] = of->J[k] * root;
    }
    return 0;
}

int assembly_blocks(const struct assembly *A, struct delassus *W, struct failure *failure)
{
    int d = A->p->d;
    int64_t n = A->p->n, blocks = 0;
    int64_t *near = malloc((size_t)(n + 1) * sizeof *near);
    if (!near) return assembly_short_of_memory(failure);
    for (int64_t c = 0; c < n; c++) blocks += assembly_neighbours(A, c, NOT_COMMON, near);
    if (!delassus_alloc(W, d, n, blocks, failure) && !assembly_common(A, W, failure)) {
        blocks = 0;
        for (int64_t c = 0; c < n; c++) {
            W->mu[c] = assembly_bundle(A, c)->mu[slot_lane(A->slot[c])];
            for (int k = 0; k < d; k++) W->q[d * c + k] = A->q[d * c + k];
            int64_t count = assembly_neighbours(A, c, NOT_COMMON, near);
            for (int64_t b = 0; b < count; b++) {
                double rows[3][3], B[9];
                assembly_block(A, c, near[b], NOT_COMMON, rows);
                for (int k = 0; k < d * d; k++) B[k] = rows[k % d][k / d];
                if (near[b] == c) {
                    delassus_set_diag(W, c, B);
                } else if (delassus_block_counts(d, B)) {
                    memcpy(W->block + d * d * blocks, B, (size_t)(d * d) * sizeof *B);
                    W->col[blocks++] = (int32_t)near[b];
                }
            }
            W->first[c + 1] = blocks;
        }
    }
    free(near);
    return failure->status;
}

/* The unknowns of a body are dof[0 .. dofs-1] of its (v, w). */
static const int dof_plane[] = { 0, 1, 5 }, dof_space[] = { 0, 1, 2, 3, 4, 5 };

static int32_t freedoms_of(const struct assembly *A)
{
    return A->p->coupling ? A->p->coupling->freedoms.n : 0;
}

/* M diagonal, f = M v_free; first[body] is the body's first unknown. The w of a body that cannot
   turn stays in the vector w; its unknowns are in no equation of a contact. spring: the first unknown of springs, each of
   which has a velocity c r, as a body of mass 1/c that only its contact's component pushes */
static void fill_M(const struct assembly *A, const int32_t *first, int32_t spring, struct stored *M,
                   double *f)
{
    int dofs = A->p->d == 2 ? 3 : 6;
    const int *dof = A->p->d == 2 ? dof_plane : dof_space;
    for (int64_t i = 0; i < A->p->bodies; i++) {
        const struct body *b = &A->free[i];
        for (int k = 0; first[i] >= 0 && k < dofs; k++) {
            int32_t row = first[i] + k;
            bool turns = dof[k] > 2;
            M->p[row + 1] = row + 1, M->i[row] = row;
            M->x[row] = !turns ? 1 / b->im : b->ii > 0 ? 1 / b->ii : 1;
            f[row] = M->x[row] * (turns ? b->w[dof[k] - 3] : b->v[dof[k]]);
        }
    }
    for (int64_t c = 0; A->p->kind.soft && c < A->p->n; c++)
        for (int k = 0; k < A->p->d; k++) {
            const double soft = compliance(A, c, k);
            if (!(soft > 0)) continue;
            M->p[spring + 1] = spring + 1, M->i[spring] = spring;
            M->x[spring] = 1 / soft, f[spring++] = 0;
        }
    for (int32_t i = 0; i < freedoms_of(A); i++) {
        const struct freedom *freedom = &A->p->coupling->freedoms.f[i];
        int32_t row = first[A->p->bodies + i];
        if (row < 0) continue;
        M->p[row + 1] = row + 1, M->i[row] = row;
        M->x[row] = freedom->mass;
        f[row] = freedom->mass * free_speed(A, freedom);
    }
}

/* H = J^T by columns; those of freedoms come after those of bodies, in the order of the freedoms, then those of springs */
static void fill_H(const struct assembly *A, const int32_t *first, int32_t spring, struct stored *H)
{
    int d = A->p->d, dofs = d == 2 ? 3 : 6;
    const int *dof = d == 2 ? dof_plane : dof_space;
    const struct couplings *y = A->p->coupling;
    int32_t count = 0;
    for (int64_t c = 0; c < A->p->n; c++) {
        double J[2][3][6];
        for (int s = 0; s < 2; s++) jacobian(A, c, s, J[s]);
        int before = A->end[2 * c] > A->end[2 * c + 1]; // rows ascend
        for (int i = 0; i < d; i++) {
            for (int s = 0; s < 2; s++) {
                int32_t body = A->end[2 * c + (s ^ before)];
                for (int k = 0; body >= 0 && k < dofs; k++) {
                    double x = J[s ^ before][i][dof[k]];
                    if (x == 0 || (dof[k] > 2 && A->free[body].ii == 0)) continue;
                    H->i[count] = first[body] + k, H->x[count++] = x;
                }
            }
            for (int64_t k = y ? y->first[c] : 0; y && k < y->first[c + 1]; k++) {
                if (y->of[k].J[i] == 0) continue;
                H->i[count] = first[A->p->bodies + y->of[k].freedom];
                H->x[count++] = y->of[k].J[i];
            }
            if (A->p->kind.soft && compliance(A, c, i) > 0)
                H->i[count] = spring++, H->x[count++] = 1;
            H->p[d * c + i + 1] = count;
        }
    }
}

/* first[body], -1 for those that do not move or have no contact, and after these first[p->bodies
   + f] of freedom f; returns the number of unknowns. */
static int64_t assembly_unknowns(const struct assembly *A, int32_t *first)
{
    int64_t nv = 0, bodies = A->p->bodies;
    for (int64_t i = 0; i < bodies; i++) {
        bool in = A->of.first[i] < A->of.first[i + 1];
        first[i] = in ? (int32_t)nv : -1;
        if (in) nv += A->p->d == 2 ? 3 : 6;
    }
    for (int32_t i = 0; i < freedoms_of(A); i++) {
        bool in = A->yield.first[i] < A->yield.first[i + 1];
        first[bodies + i] = in ? (int32_t)nv++ : -1;
    }
    return nv;
}

/* How many unknowns springs have */
static int64_t springs_of(const struct assembly *A)
{
    int64_t n = 0;
    for (int64_t c = 0; A->p->kind.soft && c < A->p->n; c++)
        for (int k = 0; k < A->p->d; k++) n += compliance(A, c, k) > 0;
    return n;
}

int assembly_MH(const struct assembly *A, struct stored *M, struct stored *H, double **f,
                struct failure *failure)
{
    int64_t nd = A->p->n * A->p->d, couplings = A->p->coupling ? A->p->coupling->n : 0;
    const int64_t most = A->p->kind.soft ? 13 : 12; // numbers of a column of H
    *M = *H = (struct stored){ 0 }, *f = NULL;
    if (A->p->bodies > (INT32_MAX - nd) / 6 - freedoms_of(A) ||
        nd > (INT32_MAX - 3 * couplings) / most)
        return failure_set(failure, EX_DATAERR,
                           "/fclib_global/H: too large for the 32-bit indices of FCLIB");
    int32_t *first = malloc((size_t)(A->p->bodies + freedoms_of(A) + 1) * sizeof *first);
    if (!first) return assembly_short_of_memory(failure);
    const int64_t of_bodies = assembly_unknowns(A, first), nv = of_bodies + springs_of(A);
    *f = malloc((size_t)(nv + 1) * sizeof **f);
    bool good = *f && stored_init(M, nv, nv, -1, nv) &&
                stored_init(H, nv, nd, -1, most * nd + 3 * couplings);
    if (good) {
        fill_M(A, first, (int32_t)of_bodies, M, *f);
        fill_H(A, first, (int32_t)of_bodies, H);
    }
    free(first);
    return good ? 0 : assembly_short_of_memory(failure);
}
