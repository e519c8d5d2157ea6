/*
 * solve/plan.h: where the contacts and the bodies of a problem lie in memory: contacts in the lanes of
 * bundles, group after group; bodies in seats, by colours in the order in which the sweep first meets them.
 *
 * It follows from which bodies touch, and where there are many contacts from where these are. While a pile
 * rests nothing of that changes, and the plan of the last step is that of this one.
 */
#pragma once

#include "solve/schedule.h"

struct plan {
    struct schedule schedule; /* without sequence and groups: contact and group have them */
    int64_t bundles, slots;   /* slots: 8 a bundle, some without a contact */
    int64_t *group; /* [schedule.groups + 1] bundles group[g] .. group[g+1]-1 may be done at once */
    int32_t *contact; /* [slots] slot i is contact[i]; -1: none */
    /* Of a packing */
    int32_t *seat; /* [bodies] body i is body[seat[i]]; in orders before colour as in the packing */
    /* [slots] where in body[] the two bodies of a contact are. A body that moves is in its seat. Each contact has its
       own copy of a body that does not move. The copies come after body[bodies] and body[bodies + 1], which stand for
       "no body" in the two halves of a sweep. */
    int32_t (*seats)[2];
    int64_t copies; /* number of these copies */
    /* What it was made of in addition to what the schedule has */
    enum order order;
    int64_t n, bodies;  /* contacts, bodies */
    int32_t (*pair)[2]; /* [n] a, b of the contacts */
    bool *moves;        /* [bodies] */
};

/* Of a packing's contacts, by the schedule given or, where that is NULL, schedule_bodies(); of a problem given
   by W. NULL when memory is short. */
struct plan *plan_of_contacts(enum order order, const struct contacts *s, const struct packing *p,
                              const struct schedule *given);
struct plan *plan_of_blocks(enum order order, const struct delassus *W);

/* Whether plan_of_contacts() without a schedule would give l again */
bool plan_holds(const struct plan *l, enum order order, const struct contacts *s,
                const struct packing *p);

void plan_free(struct plan *l); /* may be NULL */
