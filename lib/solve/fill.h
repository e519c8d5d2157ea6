/*
 * solve/fill.h: the slots of a packing's problem, all but their reactions: local bases, arms,
 * W~_cc and rho, and what the law sees besides u. fill.c fills them, for problem.c.
 */
#pragma once

#include "state/contact.h"
#include "state/packing.h"

struct problem;
struct filling;

/* A slot to be filled */
struct slot_filling {
    const struct filling *of;
    int64_t i;
    const struct contact *c;
    const struct contact_law *law; /* NULL: none */
    double slower; /* W~_cc is so many times what it is, at least 1 [solve/mass_splitting.h] */
};

/* The cell's edges where the contacts act (m), and their rates before and after the step (m/s) */
struct lattice {
    vec3 edge[3], before[3], after[3];
};
struct lattice lattice_of(const struct packing *pack);

/* Whose slots are filled, and from what */
struct filling {
    struct problem *p;
    const struct contacts *s;
    const struct lattice *cell;
    double alpha, rho_factor;
    const quat *half; /* [n] orientations in which contacts act; NULL: only balls */
};

/* Fills a slot, which knows its bodies: these still have their velocities before the step. slower: W~_cc is so
   many times what it is, at least 1 [solve/mass_splitting.h]. */
void fill_slot(const struct filling *f, int64_t slot, double slower);
/* Bundles first .. end-1 of a struct filling, as a part of a team's work */
void fill_bundles(void *filling, int64_t first, int64_t end);
