/* solve/problem_of_W.c: the bundles of a problem given by W [solve/problem.h]. */
#include "solve/lay.h"
#include "solve/plan.h"
#include "solve/problem.h"

#include <float.h>
#include <math.h>

/* Whether D[9] is diag(w_n, w_t, w_t) to rounding, as between balls. */
static bool like_balls(const double D[9])
{
    double noise = 16 * DBL_EPSILON * fmin(D[0], D[4]), most = fabs(D[8] - D[4]);
    for (int i = 0; i < 9; i++)
        if (i % 4 > 0) most = fmax(most, fabs(D[i]));
    return most < noise;
}

int problem_prepare_delassus(struct problem *p, struct delassus *W, const struct prepare_opt *o,
                             struct failure *failure)
{
    *p = (struct problem){ .d = W->d, .n = W->n, .W = W, .dt = 1, .scale_v = 1, .scale_r = 1 };
    bool full = W->common > 0;
    for (int64_t c = 0; c < W->n; c++) full = full || !like_balls(W->diag + 9 * c);
    p->kind = full ? kind_BLOCKS : kind_DIAGONALS;
    p->plan = plan_of_blocks(o->order, W);
    bool room = p->plan && lay_plan(p, p->plan) && lay_bundles(p);
    if (!room || delassus_sort(&p->sorted, W, p->slots, p->contact, failure)) {
        problem_free(p);
        return failure_set(failure, EX_SOFTWARE, "no memory for the contact problem");
    }
    delassus_begin(W);
    double trace = 0, speeds = 0;
    for (int64_t i = 0; i < p->slots; i++) {
        int64_t c = p->contact[i];
        struct bundle *r = slot_bundle(p, i);
        int k = slot_lane(i);
        double D[9], seen[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }; // W_cc, and what the sweep solves
        r->a[k] = (int32_t)c;
        if (c >= 0)
            delassus_own(W, c, 1, D), delassus_own(W, c, bundle_contacts(p, i / BUNDLE), seen);
        for (int j = 0; j < 9; j++) p->block[i / BUNDLE][j][k] = seen[j / 3 + 3 * (j % 3)];
        if (c < 0) continue;
        const double *q = W->q + W->d * c;
        double lambda = local_lambda_max(D), step = local_lambda_max(seen);
        r->mu[k] = W->mu[c];
        for (int j = 0; j < 2; j++) {
            p->w[i / BUNDLE][j][k] = full ? lambda : D[4 * j];
            r->iw[j][k] = 1 / p->w[i / BUNDLE][j][k];
        }
        p->rho[i / BUNDLE][k] = lambda <= 0                ? 1
                                : o->alpha > 0 && D[0] > 0 ? o->alpha / seen[0]
                                                           : o->rho_factor / step;
        double q2 = 0;
        for (int j = 0; j < W->d; j++) {
            r->r[j][k] = W->r[W->d * c + j];
            p->norm_q += q[j] * q[j], q2 += q[j] * q[j];
            trace += D[4 * j];
        }
        speeds += sqrt(q2), p->most_q = fmax(p->most_q, sqrt(q2));
    }
    // there is no g and no m: the unit of velocity is the root mean square of q, that of mass 1
    // over the mean of W_ii
    p->norm_q = sqrt(p->norm_q);
    if (p->norm_q > 0) p->scale_v = p->norm_q / sqrt((double)(W->d * W->n));
    p->mean_q = speeds / (double)(p->n ? p->n : 1);
    problem_set_unit(p);
    p->scale_r = trace > 0 ? p->scale_v * (double)(W->d * W->n) / trace : p->scale_v;
    return 0;
}
