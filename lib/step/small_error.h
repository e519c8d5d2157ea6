/*
 * step/small_error.h: how far the reactions of small steps are from the law. What is missing at a contact is the change that
 * its law would make of its reaction alone, after the sweeps of a small step; that of a body, the sum over its contacts and over
 * the small steps of an interval, over the load that the body carries then: the sum of the reactions, its weight at least.
 */
#pragma once

#include "state/report.h"
#include "step/small_run.h"

/* An interval that is judged begins. Returns 0 or EX_SOFTWARE. */
int small_error_init(struct small_run *r, struct failure *failure);
/* By all threads, where r is judged: adds the small step in hand, after its sweeps. */
void small_error_step(struct small_run *r, int me, int threads);
/* By all threads, between sweeps: is more than r->bound of the load of all bodies missing? */
bool small_error_exceeds(struct small_run *r, int me, int threads);
/* Writes what is missing into the report. */
void small_error_give(const struct small_run *r, struct report *rep);
/* Does a pair, or a body and a wall, approach that overlaps by more than three times what is permitted (radii)? Where masses are
   very different more sweeps would have stopped it. */
bool small_error_crushes(const struct small_run *r, const struct contacts *s, double permitted);
/*
 * Writes the velocity of approach of contacts that overlap, s, at the end of the interval. The interval has no solution, and has
 * not converged, where a contact is deeper than CRUSHED times the permitted overlap (radii) and still approaches, faster than
 * overlaps are pushed apart: the compliance gives way to a load that grows without end.
 */
void small_error_approach(const struct small_run *r, const struct contacts *s, double permitted,
                          struct report *rep);
void small_error_free(struct small_run *r);
