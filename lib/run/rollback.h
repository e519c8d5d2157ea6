/*
 * run/rollback.h: what a packing was before a step, should the step fail. Its arrays of bodies stay where they are, unless
 * bodies come and go.
 */
#pragma once

#include "run/control.h"

/* All zero to begin with */
struct rollback {
    int64_t n, room;            /* bodies; reactions there is memory for */
    void *column[BODY_COLUMNS]; /* [n] of those that move and that the packing has, else NULL */
    struct wall *wall;
    int32_t walls;
    struct recall *recall; /* [room] */
    struct packing was;    /* its numbers; or, whole, a copy */
    bool whole;
    struct control acts; /* where bodies come and go: a copy, too */
};

void rollback_free(struct rollback *undo);
/* Remembers. Returns 0 or EX_SOFTWARE, where the packing may not be stepped. */
int rollback_take(struct rollback *undo, const struct packing *p, const struct control *acts,
                  struct failure *failure);
/* p and acts are what they were. */
void rollback_back(struct rollback *undo, struct packing *p, struct control *acts);
