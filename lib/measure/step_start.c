#include "measure/step_start.h"

#include "step/move.h"

int step_start_init(struct step_start *m, const struct snapshot *s, struct failure *failure)
{
    *m = (struct step_start){ .p = s->p };
    if (s->moved) {
        m->p = &m->back;
        if (packing_copy(&m->back, s->p, failure) || move_back(&m->back, s->s, failure)) return failure->status;
    }
    return impulses_init(&m->sum, m->p, s->s, false, failure);
}

void step_start_free(struct step_start *m)
{
    impulses_free(&m->sum);
    packing_free(&m->back);
}
