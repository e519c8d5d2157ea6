#include "measure/step_start.h"

#include "motion/move.h"

int step_start_init(struct step_start *m, const struct snapshot *s, struct why *why)
{
    *m = (struct step_start){ .p = s->p };
    if (s->moved) {
        m->p = &m->back;
        if (packing_copy(&m->back, s->p, why) || move_back(&m->back, s->s, why)) return why->status;
    }
    return impulses_init(&m->sum, m->p, s->s, false, why);
}

void step_start_free(struct step_start *m)
{
    impulses_free(&m->sum);
    packing_free(&m->back);
}
