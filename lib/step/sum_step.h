/* step/sum_step.h: adds what bodies do to walls in a step to the packing's sums [state/wall_load.h]. */
#pragma once

#include "step/impulse.h"

/* In the step that begins where the packing is, by the reactions of its contacts, whose sums are given, too. Nothing
   where no sums are kept. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int sum_step(struct packing *p, const struct contacts *s, const struct impulses *sum,
             struct failure *failure);
/* Makes p->sums.faces, if it is not there. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int sum_step_faces(struct packing *p, struct failure *failure);
