/* problem/prepare.c: the problem of a packing with freedoms, given by W [problem/prepare.h]. */
#include "problem/prepare.h"

#include "problem/assembly.h"

#include <stdlib.h>
#include <unistd.h>

#define GB 1e9 /* bytes */

/* Whether the blocks that freedoms couple fit into the machine, W and its rows in the sweep's
   order */
static int check_memory(const struct problem *p, struct why *why)
{
    double blocks = couplings_pairs(p->coupling), size = 8.0 * p->d * p->d + 4;
    double need = 2 * blocks * size;
    double have = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (need <= have) return 0;
    return why_set(why, EX_SOFTWARE,
                   "the loads couple %.0f pairs of contacts: needs %.3g GB, the machine has %.3g",
                   blocks, need / GB, have / GB);
}

/* W of the bodies and the freedoms, with the reactions found; NULL and why where it fails */
static struct delassus *assemble(const struct problem *bodies, const struct contacts *s,
                                 struct why *why)
{
    struct assembly A = { 0 };
    struct delassus *W = calloc(1, sizeof *W);
    if (!W) return why_set(why, EX_SOFTWARE, "no memory for the contact problem"), NULL;
    int e = assembly_init(&A, bodies, why);
    if (!e) e = assembly_blocks(&A, W, why);
    assembly_free(&A);
    if (e) return free(W), NULL;
    for (int64_t c = 0; c < s->n && s->found; c++)
        for (int k = 0; k < W->d; k++) W->r[W->d * c + k] = s->found[c].r[k];
    for (int64_t i = 0; s->found && bodies->pull && i < bodies->slots; i++)
        if (bodies->contact[i] >= 0) W->r[W->d * bodies->contact[i]] += bodies->pull[i];
    return W;
}

/* What cohesion pulls, in the slots of the problem given by W; false when memory is short. */
static bool copy_pulls(struct problem *p, const struct problem *bodies)
{
    double *of = bodies->pull ? calloc((size_t)p->n + 1, sizeof *of) : NULL;
    if (!bodies->pull) return true;
    if (of) p->pull = calloc((size_t)p->slots + 1, sizeof *p->pull);
    for (int64_t i = 0; of && i < bodies->slots; i++)
        if (bodies->contact[i] >= 0) of[bodies->contact[i]] = bodies->pull[i];
    for (int64_t i = 0; of && p->pull && i < p->slots; i++)
        if (p->contact[i] >= 0) p->pull[i] = of[p->contact[i]];
    free(of);
    return p->pull != NULL;
}

/* What a problem given by W does not know of the packing */
static void describe(struct problem *p, const struct problem *bodies, const struct contacts *s)
{
    p->packing = bodies->packing;
    p->dt = bodies->dt, p->fall = bodies->fall, p->speed = bodies->speed;
    p->scale_v = bodies->scale_v, p->scale_r = bodies->scale_r;
    for (int64_t i = 0; s->found && i < p->slots; i++) {
        if (p->contact[i] < 0) continue;
        const struct contact *c = &s->c[p->contact[i]];
        const struct found *f = &s->found[p->contact[i]];
        double D[3] = { 1 + c->en, 1 + c->et, 1 + c->et }, u[3];
        double r[3] = { f->r[0], f->r[1], f->r[2] };
        if (p->pull) r[0] += p->pull[i];
        for (int k = 0; k < 3; k++) u[k] = D[k] * f->u[k];
        slot_set(p, i, r, u);
    }
}

static int prepare_coupled(struct problem *p, const struct packing *pack, const struct contacts *s,
                           double alpha, double rho_factor, enum order order, struct why *why)
{
    struct problem bodies;
    struct contacts unsolved = *s; // only W and q are wanted of the bodies
    unsolved.found = NULL;
    if (problem_prepare(&bodies, pack, &unsolved, alpha, rho_factor, ORDER_NATURAL, why))
        return why->status;
    if (bodies.rolls) {
        problem_free(&bodies);
        return why_set(why, EX_DATAERR, "rolling friction where loads push contacts: not known");
    }
    struct delassus *W = check_memory(&bodies, why) ? NULL : assemble(&bodies, s, why);
    if (W && !problem_prepare_delassus(p, W, alpha, rho_factor, order, why)) {
        p->own = W;
        if (copy_pulls(p, &bodies)) {
            describe(p, &bodies, s);
        } else {
            problem_free(p);
            why_set(why, EX_SOFTWARE, "no memory for the contact problem");
        }
    } else if (W) {
        delassus_free(W);
        free(W);
    }
    problem_free(&bodies);
    return why->status;
}

int prepare_packing(struct problem *p, const struct packing *pack, const struct contacts *s,
                    double alpha, double rho_factor, enum order order, struct why *why)
{
    if (!freedoms_in(pack)) return problem_prepare(p, pack, s, alpha, rho_factor, order, why);
    struct couplings touched;
    if (couplings_init(&touched, pack, s, why)) return why->status;
    int64_t n = touched.n;
    couplings_free(&touched);
    return (n ? prepare_coupled : problem_prepare)(p, pack, s, alpha, rho_factor, order, why);
}
