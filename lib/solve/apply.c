/* solve/apply.c: W r by the bodies or by the blocks of W [solve/apply.h]. */
#include "solve/apply.h"

#include "base/team.h"
#include "solve/backend.h"
#include "solve/device.h"

#include <stdlib.h>
#include <string.h>

void apply_free(struct apply *a)
{
    free(a->body), free(a->factor), free(a->out), free(a->zero);
    *a = (struct apply){ 0 };
}

int apply_init(struct apply *a, const struct problem *p)
{
    size_t size = (size_t)(p->n * p->d) + 4; // delassus_gather() may read a little beyond
    *a = (struct apply){ 0 };
    if (p->W) {
        a->factor = calloc(size, sizeof *a->factor);
        a->out = calloc(size, sizeof *a->out), a->zero = calloc(size, sizeof *a->zero);
    } else {
        a->body = aligned_alloc(64, (size_t)p->bodies * sizeof *a->body);
        if (a->body) memcpy(a->body, p->body, (size_t)p->bodies * sizeof *a->body);
    }
    if (p->W ? a->factor && a->out && a->zero : a->body != NULL) return 0;
    apply_free(a);
    return -1;
}

static void apply_blocks(const struct problem *p, struct apply *a, const double *x, double *y)
{
    int d = p->d;
    for (int64_t i = 0; i < p->slots; i++)
        for (int k = 0; k < d && p->contact[i] >= 0; k++)
            a->factor[d * p->contact[i] + k] = x[3 * i + k];
    delassus_apply(p->W, a->factor, a->zero, a->out);
    for (int64_t i = 0; i < p->slots; i++)
        for (int k = 0; k < 3 && p->contact[i] >= 0; k++)
            y[3 * i + k] = k < d ? a->out[d * p->contact[i] + k] : 0;
}

static void apply_bodies(const struct problem *p, struct apply *a, const double *x, double *y)
{
    for (int64_t i = 0; i < p->bodies; i++)
        memset(a->body[i].v, 0, sizeof a->body[i].v), memset(a->body[i].w, 0, sizeof a->body[i].w);
    for (int64_t i = 0; i < p->slots; i++)
        if (p->contact[i] >= 0) problem_push(p, a->body, i / BUNDLE, slot_lane(i), x + 3 * i);
    for (int64_t i = 0; i < p->slots; i++) {
        const struct rebound *e = slot_rebound(p, i);
        if (p->contact[i] < 0) continue;
        problem_velocity(p, a->body, i / BUNDLE, NULL, slot_lane(i), y + 3 * i);
        for (int k = 0; e && k < 3; k++) y[3 * i + k] *= e->s[k > 0][slot_lane(i)];
        for (int k = 0; p->kind.soft && k < 3; k++)
            y[3 * i + k] += e->soft[k > 0][slot_lane(i)] * x[3 * i + k];
    }
}

void problem_apply(const struct problem *p, struct apply *a, const double *x, double *y)
{
    (p->W ? apply_blocks : apply_bodies)(p, a, x, y);
}

static void apply_push(void *problem, int me, int threads)
{
    backend_widest()->sweep->push(problem, me, threads);
}

void problem_renew(struct problem *p, int threads)
{
    if (!p->body) return;
    if (p->device) {
        device_renew(p);
        return;
    }
    problem_set_free_motion(p);
    team_do(threads, apply_push, p);
}

void problem_react(struct problem *p, const double *r, int threads)
{
    device_home(p, true);
    for (int64_t i = 0; i < p->slots; i++) {
        int64_t c = p->contact[i];
        // where no contact is, r is 0 again: an iterate that was no number has left that there as well
        for (int k = 0; k < 3; k++)
            slot_bundle(p, i)->r[k][slot_lane(i)] = c < 0 ? 0 : r[3 * i + k];
        for (int k = 0; k < p->d && p->W && c >= 0; k++) p->W->r[p->d * c + k] = r[3 * i + k];
    }
    if (p->W) delassus_begin(p->W);
    problem_renew(p, threads);
}
