/* problem/brake.c: two sets of numbers for a slot [problem/braking.h]. */
#include "problem/braking.h"

#include "problem/problem.h"

#include <stdlib.h>

enum {
    OF_BUNDLE = 7,
    OF_LEVERS = 9,
    OF_BEYOND = 6,
    OF_TURN = 4 * 9 + ROLLING * ROLLING + 1,
    OF_SLOT = OF_BUNDLE + OF_LEVERS + OF_BEYOND + OF_TURN
};

/* at[]: where the numbers are that lighter bodies change; returns how many. */
static int numbers(const struct problem *p, int64_t slot, double *at[OF_SLOT])
{
    struct bundle *c = slot_bundle(p, slot);
    int64_t bundle = slot / BUNDLE;
    int k = slot_lane(slot), n = 0;
    for (int j = 0; j < 2; j++) at[n++] = &p->w[bundle][j][k], at[n++] = &c->iw[j][k];
    for (int j = 0; j < 2 && p->near; j++) at[n++] = &bundle_beside(p, c)->w[j][k];
    at[n++] = &p->rho[bundle][k];
    for (int j = 0; j < 9 && p->lever; j++) at[n++] = &p->block[bundle][j][k];
    if (!p->beyond) return n;
    struct beyond *x = &p->beyond[bundle];
    at[n++] = &x->s[0][k], at[n++] = &x->s[1][k];
    at[n++] = &x->k[k], at[n++] = &x->wr[k], at[n++] = &x->length[k], at[n++] = &x->rho[k];
    struct beyond_levers *y = slot_turn(p, slot);
    if (!y) return n;
    for (int j = 0; j < 9; j++) {
        at[n++] = &y->S[j][k], at[n++] = &y->V[j][k];
        at[n++] = &y->Ra[j][k], at[n++] = &y->Rb[j][k];
    }
    for (int j = 0; j < ROLLING * ROLLING; j++) at[n++] = &y->W[j][k];
    at[n++] = &y->lambda[k];
    return n;
}

int brake_make(struct problem *p, const struct filling *f, const double *slower)
{
    struct brake *b = p->brake = calloc(1, sizeof *b);
    double *at[OF_SLOT];
    int64_t n = 0;
    for (int64_t i = 0; i < p->slots; i++) n += p->contact[i] >= 0 && slower[p->contact[i]] > 1;
    if (!b) return -1;
    b->slot = malloc((size_t)(n + 1) * sizeof *b->slot);
    b->width = p->slots ? numbers(p, 0, at) : 0;
    b->other = malloc((size_t)(n + 1) * (size_t)(b->width + 1) * sizeof *b->other);
    if (!b->slot || !b->other) return -1;
    for (int64_t i = 0; i < p->slots; i++) {
        if (p->contact[i] < 0 || !(slower[p->contact[i]] > 1)) continue;
        numbers(p, i, at);
        for (int j = 0; j < b->width; j++) b->other[b->n * b->width + j] = *at[j];
        fill_slot(f, i, slower[p->contact[i]]);
        b->slot[b->n++] = i;
    }
    b->held = true;
    return 0;
}

void brake_hold(struct problem *p, bool hold)
{
    struct brake *b = p->brake;
    if (!b || b->held == hold) return;
    for (int64_t i = 0; i < b->n; i++) {
        double *at[OF_SLOT];
        numbers(p, b->slot[i], at);
        for (int j = 0; j < b->width; j++) {
            double *other = &b->other[i * b->width + j], x = *other;
            *other = *at[j], *at[j] = x;
        }
    }
    b->held = hold;
}

void brake_free(struct brake *b)
{
    if (b) free(b->slot), free(b->other);
    free(b);
}
