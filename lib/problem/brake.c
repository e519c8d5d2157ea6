/* problem/brake.c: two sets of numbers for a slot [problem/brake.h]. */
#include "problem/brake.h"

#include "problem/lay.h"
#include "problem/problem.h"

#include <stdlib.h>
#include <string.h>

/* Rows of doubles, a lane's each, in an element of an array */
static int rows(const struct problem *p, int which)
{
    size_t row = BUNDLE * sizeof(double);
    return p->kind.arrays >> which & 1 ? (int)(lay_array(p, (enum array)which).size / row) : 0;
}

/* All numbers of a slot, whatever they are; returns how many. at[]: where they are, or NULL */
static int numbers(const struct problem *p, int64_t slot, double **at)
{
    int n = 0;
    for (int k = 0; k < ARRAYS; k++) {
        const struct array_of a = rows(p, k) ? lay_array(p, (enum array)k) : (struct array_of){ 0 };
        double *x = at && a.x ? (double *)((char *)a.x + slot / BUNDLE * (int64_t)a.size) : NULL;
        for (int j = 0; j < rows(p, k); j++, n++)
            if (at) at[n] = &x[j * BUNDLE + slot_lane(slot)];
    }
    return n;
}

/* Where the numbers are that lighter bodies change */
static void changed(const struct problem *p, const struct brake *b, int64_t slot, double **all,
                    double **at)
{
    numbers(p, slot, all);
    for (int j = 0; j < b->width; j++) at[j] = all[b->number[j]];
}

/* The numbers of the slots before they are held: other[n][all] becomes other[n][width], of those that have changed
   in any slot. */
static int keep_changed(const struct problem *p, struct brake *b, int all, double **at)
{
    bool *differs = calloc((size_t)all + 1, sizeof *differs);
    b->number = malloc((size_t)(all + 1) * sizeof *b->number);
    if (!differs || !b->number) return free(differs), -1;
    for (int64_t i = 0; i < b->n; i++) {
        numbers(p, b->slot[i], at);
        for (int j = 0; j < all; j++)
            if (memcmp(at[j], &b->other[i * all + j], sizeof *at[j])) differs[j] = true;
    }
    for (int j = 0; j < all; j++)
        if (differs[j]) b->number[b->width++] = j;
    for (int64_t i = 0; i < b->n; i++)
        for (int j = 0; j < b->width; j++)
            b->other[i * b->width + j] = b->other[i * all + b->number[j]];
    free(differs);
    return 0;
}

int brake_make(struct problem *p, const struct filling *f, const double *slower)
{
    struct brake *b = p->brake = calloc(1, sizeof *b);
    const int all = numbers(p, 0, NULL);
    int64_t n = 0;
    for (int64_t i = 0; i < p->slots; i++) n += p->contact[i] >= 0 && slower[p->contact[i]] > 1;
    if (!b) return -1;
    b->slot = malloc((size_t)(n + 1) * sizeof *b->slot);
    b->other = malloc((size_t)(n + 1) * (size_t)all * sizeof *b->other);
    b->at = malloc(2 * (size_t)all * sizeof *b->at);
    if (!b->slot || !b->other || !b->at) return -1;
    for (int64_t i = 0; i < p->slots; i++) {
        if (p->contact[i] < 0 || !(slower[p->contact[i]] > 1)) continue;
        numbers(p, i, b->at);
        for (int j = 0; j < all; j++) b->other[b->n * all + j] = *b->at[j];
        fill_slot(f, i, slower[p->contact[i]]);
        b->slot[b->n++] = i;
    }
    b->held = true, b->all = all;
    return keep_changed(p, b, all, b->at);
}

void brake_hold(struct problem *p, bool hold)
{
    struct brake *b = p->brake;
    if (!b || b->held == hold) return;
    for (int64_t i = 0; i < b->n; i++) {
        double **at = b->at + b->all;
        changed(p, b, b->slot[i], b->at, at);
        for (int j = 0; j < b->width; j++) {
            double *other = &b->other[i * b->width + j], x = *other;
            *other = *at[j], *at[j] = x;
        }
    }
    b->held = hold;
}

void brake_free(struct brake *b)
{
    if (b) free(b->slot), free(b->other), free(b->number), free(b->at);
    free(b);
}
