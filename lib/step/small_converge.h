/*
 * step/small_converge.h: how far the reactions of a small step are from those that its law gives when sweeps have converged.
 *
 * The sweeps go on, over all contacts, until no body changes by more than a part of 1e-9 of the fastest speed; then all that
 * they have changed is what it was, so that the motion does not depend on who looks.
 */
#pragma once

#include "step/small_run.h"

/* What sweeps change, as it was before; the arrays of struct small and its list in their order */
struct small_copy {
    struct body *body;
    struct small_bundle *bundle;
    struct small_turn *turn;
    uint8_t *live, *late;
    int32_t *hot;
    double *change;
    struct small_touch *touch;
    struct small_point **point; /* [meetings] */
    double *load;               /* [freedoms] m/s */
    int32_t sweep, swept;
    bool far;
};

/* False when memory is short; to be freed either way. */
bool small_copy_init(struct small_copy *c, const struct small_run *r);
void small_copy_free(struct small_copy *c, const struct small_run *r);
/* All bodies are to be swept again. */
void small_copy_wake(struct small_run *r);
/* m/s: the largest change of a body's velocity since it was kept in was[bodies], which gets what it is now; of its rotation at its
   radius */
double small_copy_change(const struct small_run *r, struct body *was);
/* |f - f_c| over |f_c| of all contacts: reactions of the copy, and those that there are now */
double small_copy_distance(const struct small_copy *c, const struct small_run *r);
/* What was copied is back. */
void small_copy_give(const struct small_copy *c, struct small_run *r);
