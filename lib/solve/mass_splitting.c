/* solve/mass_splitting.c: two sets of numbers for a slot [solve/mass_splitting.h]. */
#include "solve/mass_splitting.h"

#include "solve/problem.h"

#include <stdlib.h>
#include <string.h>

/* Rows of doubles, a lane's each, in an element of an array */
static int rows(const struct problem *p, int which)
{
    size_t row = BUNDLE * sizeof(double);
    return p->kind.arrays >> which & 1 ? (int)(problem_array(p, (enum array)which).size / row) : 0;
}

/* All numbers of a slot, whatever they are; returns how many. at[]: where they are, or NULL */
static int mass_splitting_numbers(const struct problem *p, int64_t slot, double **at)
{
    int n = 0;
    for (int k = 0; k < ARRAYS; k++) {
        const struct array_of a =
            rows(p, k) ? problem_array(p, (enum array)k) : (struct array_of){ 0 };
        void *element = at && a.x ? (char *)a.x + slot / BUNDLE * (int64_t)a.size : NULL;
        double *x = element;
        for (int j = 0; j < rows(p, k); j++, n++)
            if (at) at[n] = &x[j * BUNDLE + slot_lane(slot)];
    }
    return n;
}

/* A brake of n slots, in one piece: what is found of it is freed with the problem. */
static struct mass_splitting *mass_splitting_new(int64_t n, int all)
{
    size_t slots = (size_t)n * sizeof(int64_t), numbers = (size_t)n * (size_t)all * sizeof(double),
           places = (size_t)all * sizeof(double *), which = (size_t)all * sizeof(int);
    struct mass_splitting *b = calloc(1, sizeof *b + slots + numbers + places + which);
    if (!b) return NULL;
    void *at = b + 1;
    b->slot = at, at = (char *)at + slots;
    b->other = at, at = (char *)at + numbers;
    b->at = at, at = (char *)at + places;
    b->number = at;
    b->all = all;
    return b;
}

/* Numbers are compared by their bits: a row may be of integers. */
static uint64_t bits(double x)
{
    uint64_t n;
    memcpy(&n, &x, sizeof n);
    return n;
}

/* other[n][all], the numbers of the slots before they are held, becomes other[n][width], of those that have
   changed in any slot. */
static void keep_changed(const struct problem *p, struct mass_splitting *b)
{
    for (int j = 0; j < b->all; j++) b->number[j] = 0;
    for (int64_t i = 0; i < b->n; i++) {
        mass_splitting_numbers(p, b->slot[i], b->at);
        for (int j = 0; j < b->all; j++)
            if (bits(*b->at[j]) != bits(b->other[i * b->all + j])) b->number[j] = 1;
    }
    for (int j = 0; j < b->all; j++)
        if (b->number[j]) b->number[b->width++] = j;
    for (int64_t i = 0; i < b->n; i++)
        for (int j = 0; j < b->width; j++)
            b->other[i * b->width + j] = b->other[i * b->all + b->number[j]];
}

int mass_splitting_make(struct problem *p, const struct filling *f, const double *slower)
{
    int64_t n = 0;
    for (int64_t i = 0; i < p->slots; i++) n += p->contact[i] >= 0 && slower[p->contact[i]] > 1;
    struct mass_splitting *b = p->brake = mass_splitting_new(n, mass_splitting_numbers(p, 0, NULL));
    if (!b) return -1;
    for (int64_t i = 0; i < p->slots; i++) {
        if (p->contact[i] < 0 || !(slower[p->contact[i]] > 1)) continue;
        mass_splitting_numbers(p, i, b->at);
        for (int j = 0; j < b->all; j++) b->other[b->n * b->all + j] = *b->at[j];
        fill_slot(f, i, slower[p->contact[i]]);
        b->slot[b->n++] = i;
    }
    b->held = true;
    keep_changed(p, b);
    return 0;
}

void mass_splitting_hold(struct problem *p, bool hold)
{
    struct mass_splitting *b = p->brake;
    if (!b || b->held == hold) return;
    for (int64_t i = 0; i < b->n; i++) {
        mass_splitting_numbers(p, b->slot[i], b->at);
        for (int j = 0; j < b->width; j++) {
            double *here = b->at[b->number[j]], *other = &b->other[i * b->width + j], x = *other;
            *other = *here, *here = x;
        }
    }
    b->held = hold;
}
