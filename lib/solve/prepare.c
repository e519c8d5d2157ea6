/* solve/prepare.c: the problem of a packing given by W [solve/prepare.h]. */
#include "solve/prepare.h"

#include "solve/assembly.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- M + H K H^T, condensed ---- */

#define GB 1e9 /* bytes */

static int bonded_check_memory(const struct problem *p, struct failure *failure)
{
    double entries = (double)p->n * (double)p->n * p->d * p->d, need = 3 * 16 * entries;
    double have = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (need <= have) return 0;
    return failure_set(failure, EX_SOFTWARE,
                       "the bonds couple %lld contacts: needs %.3g GB, the machine has %.3g; "
                       "without loads no W is needed, nor for --fclib=global",
                       (long long)p->n, need / GB, have / GB);
}

/* K and a of component j (0 to d-1) of contact c */
static double stiffness(const struct assembly *A, int64_t c, int j)
{
    int64_t i = A->slot[c];
    return A->p->extra[i / BUNDLE].K[j > 0][slot_lane(i)];
}
static double prestress(const struct assembly *A, int64_t c, int j)
{
    int64_t i = A->slot[c];
    return A->p->extra[i / BUNDLE].a[j][slot_lane(i)];
}

/* M += H K H^T, f -= H (a + K w); false when memory is short. */
static bool prepare_add_bonds(const struct assembly *A, struct global *P)
{
    struct lists of;
    int d = A->p->d;
    bool good = lists_init(&of, P->H.n, P->H.count, P->H.col);
    if (!good) return false;
    for (int64_t col = 0; good && col < P->H.n; col++) {
        int64_t c = col / d, from = of.first[col], to = of.first[col + 1];
        double K = stiffness(A, c, (int)(col % d)), a = prestress(A, c, (int)(col % d));
        for (int64_t k = from; good && k < to && (K > 0 || a != 0); k++) {
            int64_t e = of.item[k];
            P->f[P->H.row[e]] -= P->H.x[e] * (a + K * A->w[col]);
            for (int64_t l = from; good && l < to; l++) {
                int64_t g = of.item[l];
                good = sparse_add(&P->M, P->H.row[e], P->H.row[g], K * P->H.x[e] * P->H.x[g]);
            }
        }
    }
    lists_free(&of);
    return good;
}

int bonded_global(const struct assembly *A, struct global *P, struct failure *failure)
{
    struct stored M = { 0 }, H = { 0 };
    *P = (struct global){ 0 };
    int e = assembly_MH(A, &M, &H, &P->f, failure);
    P->nv = M.n;
    if (!e) e = sparse_unpack(&P->M, &M, "M", failure) || sparse_unpack(&P->H, &H, "H", failure);
    if (!e && !prepare_add_bonds(A, P))
        failure_set(failure, EX_SOFTWARE, "no memory for the bonds");
    stored_free(&M), stored_free(&H);
    return failure->status;
}

int bonded_local(const struct assembly *A, struct sparse *W, double *q, struct failure *failure)
{
    struct global P = { 0 };
    struct motion U = { 0 };
    *W = (struct sparse){ 0 };
    int e = bonded_check_memory(A->p, failure);
    if (!e) e = bonded_global(A, &P, failure);
    if (!e) memcpy(q, A->w, (size_t)(A->p->n * A->p->d) * sizeof *q);
    if (!e) e = condense(&P, &U, W, q, failure);
    global_free(&P), motion_free(&U);
    return e;
}

static int prepare_fill(const struct assembly *A, struct delassus *W, struct failure *failure)
{
    struct sparse w = { 0 };
    int64_t n = A->p->n, d = A->p->d;
    double *q = malloc((size_t)(n * d + 1) * sizeof *q);
    int e = q ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for the bonds");
    if (!e) e = bonded_local(A, &w, q, failure);
    if (!e) e = delassus_init(W, (int)d, n, &w, failure);
    if (!e) memcpy(W->q, q, (size_t)(n * d) * sizeof *q);
    for (int64_t c = 0; !e && c < n; c++)
        W->mu[c] = slot_bundle(A->p, A->slot[c])->mu[slot_lane(A->slot[c])];
    free(q);
    sparse_free(&w);
    return e;
}

/* W^, q^, mu, r = 0, of a packing's problem with its bodies. Returns 0, EX_SOFTWARE or EX_DATAERR, with
   nothing to free. */
static int bonded_blocks(const struct problem *bodies, struct delassus *W, struct failure *failure)
{
    struct assembly A;
    int e = assembly_init(&A, bodies, failure);
    if (!e) e = prepare_fill(&A, W, failure);
    assembly_free(&A);
    return e;
}

#define GB 1e9 /* bytes */

/* Whether the blocks that freedoms couple fit into the machine, W and its rows in the sweep's
   order */
static int prepare_check_memory(const struct problem *p, struct failure *failure)
{
    double blocks = couplings_pairs(p->coupling), size = 8.0 * p->d * p->d + 4;
    double need = 2 * blocks * size;
    double have = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (need <= have) return 0;
    return failure_set(
        failure, EX_SOFTWARE,
        "the loads couple %.0f pairs of contacts: needs %.3g GB, the machine has %.3g", blocks,
        need / GB, have / GB);
}

/* W of the bodies and the freedoms */
static int assemble_free(const struct problem *bodies, struct delassus *W, struct failure *failure)
{
    struct assembly A = { 0 };
    if (prepare_check_memory(bodies, failure)) return failure->status;
    int e = assembly_init(&A, bodies, failure);
    if (!e) e = assembly_blocks(&A, W, failure);
    assembly_free(&A);
    return e;
}

/* What the contact in a slot of `bodies` has besides the push of its surfaces, by its D u~ (m/s) */
static void besides(const struct problem *bodies, int64_t i, const double u[3], double p[3])
{
    const struct extra *x = bodies->extra ? &bodies->extra[i / BUNDLE] : NULL;
    int lane = slot_lane(i);
    for (int k = 0; k < 3; k++) p[k] = x ? -x->a[k][lane] - x->K[k > 0][lane] * u[k] : 0;
    if (bodies->pull) p[0] -= bodies->pull[i];
}

/* W, with the pushes of the reactions found; NULL and why where it fails */
static struct delassus *prepare_assemble(const struct problem *bodies, const struct contacts *s,
                                         struct failure *failure)
{
    struct delassus *W = calloc(1, sizeof *W);
    if (!W) return failure_set(failure, EX_SOFTWARE, "no memory for the contact problem"), NULL;
    int e =
        bodies->kind.extra ? bonded_blocks(bodies, W, failure) : assemble_free(bodies, W, failure);
    if (e) return free(W), NULL;
    for (int64_t i = 0; s->found && i < bodies->slots; i++) {
        int64_t c = bodies->contact[i];
        if (c < 0) continue;
        double p[3];
        besides(bodies, i, s->found[c].u, p);
        for (int k = 0; k < W->d && k < 3; k++) W->r[W->d * c + k] = s->found[c].r[k] - p[k];
    }
    return W;
}

/* What cohesion pulls, and bonds, in the slots of the problem given by W, which has them in it; false
   when memory is short. */
static bool copy_ties(struct problem *p, const struct problem *bodies)
{
    int64_t *at = malloc((size_t)(p->n + 1) * sizeof *at);
    bool good = at != NULL;
    if (good && bodies->pull)
        good = (p->pull = calloc((size_t)p->slots + 1, sizeof *p->pull)) != NULL;
    if (good && bodies->extra)
        good = (p->in_W = calloc((size_t)p->bundles + 1, sizeof *p->in_W)) != NULL;
    for (int64_t i = 0; good && i < bodies->slots; i++)
        if (bodies->contact[i] >= 0) at[bodies->contact[i]] = i;
    for (int64_t i = 0; good && i < p->slots; i++) {
        if (p->contact[i] < 0) continue;
        int64_t from = at[p->contact[i]];
        if (p->pull && bodies->pull) p->pull[i] = bodies->pull[from];
        if (!p->in_W || !bodies->extra) continue;
        struct extra *to = &p->in_W[i / BUNDLE];
        const struct extra *x = &bodies->extra[from / BUNDLE];
        for (int k = 0; k < 3; k++) to->a[k][slot_lane(i)] = x->a[k][slot_lane(from)];
        for (int k = 0; k < 2; k++) to->K[k][slot_lane(i)] = x->K[k][slot_lane(from)];
    }
    free(at);
    return good;
}

/* kg: of the freedoms, as contacts feel them; 0: there are none */
static double heaviest_freedom(const struct couplings *y)
{
    double most = 0;
    for (int64_t i = 0; y && i < y->n; i++) {
        const double *J = y->of[i].J, J2 = J[0] * J[0] + J[1] * J[1] + J[2] * J[2];
        if (J2 > 0) most = fmax(most, y->freedoms.f[y->of[i].freedom].mass / J2);
    }
    return most;
}

/* What a problem given by W does not know of the packing */
static void describe(struct problem *p, const struct problem *bodies, const struct contacts *s)
{
    p->packing = bodies->packing;
    p->dt = bodies->dt, p->fall = bodies->fall, p->speed = bodies->speed;
    p->heaviest = fmax(bodies->heaviest, heaviest_freedom(bodies->coupling));
    problem_set_unit(p);
    p->scale_v = bodies->scale_v, p->scale_r = bodies->scale_r;
    for (int64_t i = 0; s->found && i < p->slots; i++) {
        if (p->contact[i] < 0) continue;
        const struct contact *c = &s->c[p->contact[i]];
        const struct found *f = &s->found[p->contact[i]];
        double D[3] = { 1 + c->en, 1 + c->et, 1 + c->et }, r[3] = { 0 }, u[3];
        for (int k = 0; k < 3; k++) u[k] = D[k] * f->u[k];
        for (int k = 0; k < p->d; k++) r[k] = p->W->r[p->d * p->contact[i] + k];
        slot_set(p, i, r, u);
    }
}

static int prepare_by_W(struct problem *p, const struct packing *pack, const struct contacts *s,
                        const struct prepare_opt *o, struct failure *failure)
{
    struct problem bodies;
    struct prepare_opt unordered = *o;
    unordered.order = ORDER_NATURAL, unordered.kept = NULL;
    struct contacts unsolved = *s; // only W and q are wanted of the bodies
    unsolved.found = NULL;
    if (problem_prepare(&bodies, pack, &unsolved, &unordered, failure)) return failure->status;
    if (bodies.kind.rolls) {
        problem_free(&bodies);
        return failure_set(failure, EX_DATAERR,
                           "rolling friction where loads push contacts: not known");
    }
    struct delassus *W = prepare_assemble(&bodies, s, failure);
    if (W && !problem_prepare_delassus(p, W, o, failure)) {
        p->own = W;
        if (copy_ties(p, &bodies)) {
            describe(p, &bodies, s);
        } else {
            problem_free(p);
            failure_set(failure, EX_SOFTWARE, "no memory for the contact problem");
        }
    } else if (W) {
        delassus_free(W);
        free(W);
    }
    problem_free(&bodies);
    return failure->status;
}

int prepare_packing(struct problem *p, const struct packing *pack, const struct contacts *s,
                    const struct prepare_opt *o, struct failure *failure)
{
    bool by_W = false;
    if (freedoms_in(pack)) {
        struct couplings touched;
        if (couplings_init(&touched, pack, s, failure)) return failure->status;
        by_W = touched.n > 0;
        couplings_free(&touched);
    }
    return (by_W ? prepare_by_W : problem_prepare)(p, pack, s, o, failure);
}
