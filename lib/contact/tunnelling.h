/*
 * contact/tunnelling.h: bodies that move in a step by more than they are thick. Where contacts are sought such a body may be on
 * one side of a sheet, or of another body, at one step and on the other at the next, without a contact.
 *
 * Nobody looks for what they pass. They are counted, and a step that has some fails its account. A pair of which both go by less than
 * they are thick does not change its order, and a centre that goes by less, relative to a wall, does not get behind it from outside.
 */
#pragma once

#include "state/packing.h"

/* m: of a ball inside the body, around its centre; of a clump the smallest ball */
double tunnelling_thickness(const struct packing *p, int64_t i);
/* Is there what bodies may pass: a wall that is no plane, or another body? */
bool tunnelling_watches(const struct packing *p);
/* How many of the bodies for which of[p->n] is true (NULL: all) move in a step by more than they are thick, relative to walls; *id: the
   least number of them */
int64_t tunnelling_count(const struct packing *p, const bool *of, int32_t *id);
