/* step/small_attract.c: attraction at the points of meetings [step/small_meet.h]. */
#include "step/small_run.h"

#include "base/array.h"
#include "state/attraction.h"
#include "step/small_point.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double small_attract_reach(const struct small_meeting *m)
{
    const double range = m->hold[HOLD_COHESION] > 0 ? m->hold[HOLD_RANGE] : 0;
    return m->hold[HOLD_BRIDGE] > 0 ? fmax(range, m->hold[HOLD_REACH]) : range;
}

double small_attract_gap(const struct small_meeting *m)
{
    double gap = INFINITY;
    for (int64_t i = 0; i < m->points; i++)
        if (m->point[i].there && !m->point[i].seam) gap = fmin(gap, m->point[i].gap);
    return gap;
}

double small_attract_energy(const struct small_meeting *m)
{
    const double gap = small_attract_gap(m);
    return gap < INFINITY ? small_hold_energy(m->hold, gap) : 0;
}

void small_attract_free(struct small_run *r)
{
    struct small_shares *y = &r->shapes.shares;
    contacts_free(&y->places), free(y->point), free(y->of);
    *y = (struct small_shares){ 0 };
}

/* The bridge of the meeting is made where bodies touch or have pushed, and ruptures. */
static void wet_meeting(struct small_meeting *m)
{
    const double gap = small_attract_gap(m);
    bool touches = gap <= m->hold[HOLD_TOUCH];
    for (int64_t i = 0; i < m->points; i++)
        touches |= v3_dot(small_vec(m->point[i].f), m->point[i].n) > 0;
    const bool was = m->hold[HOLD_WET] > 0, wets = m->hold[HOLD_BRIDGE] > 0;
    const bool is = (was || (wets && touches)) && gap < m->hold[HOLD_REACH];
    if (is && !was) m->hold[HOLD_JOINED] += small_hold_bridge(m->hold, gap);
    m->hold[HOLD_WET] = is;
}

/* The places where bodies are held, as contacts; false when memory is short. */
static bool gather_places(struct small_run *r)
{
    struct small_shares *y = &r->shapes.shares;
    struct contacts *s = &y->places;
    s->n = 0;
    for (int64_t i = 0; i < r->l->meetings.n; i++) {
        struct small_meeting *m = &r->l->meetings.of[i];
        if (r->begins) r->stored += small_attract_energy(m);
        if (m->points) wet_meeting(m);
        for (int64_t k = 0; k < m->points; k++) {
            struct small_point *t = &m->point[k];
            const double pull = r->h * small_hold_force(m->hold, t->gap);
            t->pulls = 0;
            if (!t->there || t->seam || !(pull > 0)) continue;
            struct contact *c = contacts_add(s, m->key.a, m->key.b);
            if (!c || !array_grow(&y->point, &y->point_room, s->n, sizeof(struct small_point *)) ||
                !array_grow(&y->of, &y->of_room, s->n, sizeof *y->of))
                return false;
            memcpy(c->shift, m->key.shift, sizeof c->shift);
            c->feature = t->feature, c->gap = t->gap, c->x = t->x, c->n = t->n, c->t1 = t->t1;
            y->point[s->n - 1] = t, t->pulls = pull;
            y->of[s->n - 1] = (struct attraction){ .tied = true };
        }
    }
    return true;
}

void small_attract(struct small_run *r)
{
    struct small_shares *y = &r->shapes.shares;
    struct failure failure = { 0 };
    const struct packing here = small_points_packing(r);
    if (!gather_places(r) || (y->places.n && attraction_share(y->of, &y->places, &here, &failure)))
        r->lost = r->stop = true;
    for (int64_t i = 0; i < y->places.n; i++) y->point[i]->pulls /= y->of[i].among;
}
