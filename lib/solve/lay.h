/*
 * solve/lay.h: the memory of a packing's problem, as its plan says. lay.c lays it, for problem.c.
 */
#pragma once

#include "solve/plan.h"
#include "state/contact.h"

struct problem;

/*
 * Zeroed memory of n things, aligned to cache lines, in huge pages where it is large: bodies read in any order
 * then do not wait for page tables. NULL only when memory is short, also for n = 0.
 */
void *lay_lines(int64_t n, size_t size);

/* What p borrows of the plan; then the arrays of p->kind, once it is chosen. False when memory is short. */
bool lay_plan(struct problem *p, const struct plan *l);
bool lay_bundles(struct problem *p);

/* Tells the slots their bodies, and makes the copies of those that do not move. p->seat and the packing's in
   p->body are set. */
void lay_seats(struct problem *p, const struct plan *l, const struct contacts *s);
