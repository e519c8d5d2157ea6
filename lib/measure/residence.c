/* measure/residence.c: how long bodies are in the region, and those that have left it [Danckwerts 1953]. */
#include "measure/follow.h"
#include "measure/measures.h"

#include <math.h>

static const struct quantity quantities[] = {
    { "since", "s", 1, "time since the previous frame" },
    { "bodies", "1", 1, "number of movable bodies with their centre in the region" },
    { "entered", "1", 1, "number of those that entered since the previous frame" },
    { "left", "1", 1, "number of bodies that left the region or were removed" },
    { "age", "s", 1, "mean time in the region of the bodies in it, at most since the first frame" },
    { "stay", "s", 1,
      "mean time in the region of the bodies that left and whose entry was observed" },
    { 0 },
};

/* Was it in the region, and is not now? */
static bool gone(const struct frame_memory *now, const struct frame_memory_body *then)
{
    const struct frame_memory_body *b = frame_memory_find(now, then->id);
    return follow_in(then) && !(b && follow_in(b));
}

static double left_at(const struct snapshot *s, const struct frame_memory *now, int32_t id)
{
    return frame_memory_find(now, id) ? s->p->t : follow_removed(s, id);
}

static int residence_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    struct frame_memory now;
    double bodies = 0, entered = 0, left = 0, age = 0, stay = 0, whole = 0;
    double *at = table_row(t, failure);
    if (!at || follow(&now, s, false, failure)) return failure->status;
    for (int64_t k = 0; k < now.n; k++) {
        const struct frame_memory_body *b = &now.body[k],
                                       *then = frame_memory_find(s->before, b->id);
        if (!follow_in(b)) continue;
        bodies++, age += s->p->t - b->entered, entered += !then || !follow_in(then);
    }
    for (int64_t k = 0; k < s->before->n; k++) {
        const struct frame_memory_body *b = &s->before->body[k];
        if (!gone(&now, b)) continue;
        left++;
        if (b->whole) whole++, stay += left_at(s, &now, b->id) - b->entered;
    }
    put(&at, s->p->t - s->before->t), put(&at, bodies), put(&at, entered), put(&at, left);
    if (!(bodies > 0)) table_null(t, "no body that moves is in the region");
    if (!(whole > 0))
        table_null(t, "no body whose entry was observed has left since the previous frame");
    put(&at, bodies > 0 ? age / bodies : NAN), put(&at, whole > 0 ? stay / whole : NAN);
    frame_memory_free(&now);
    return 0;
}

const struct measure measure_residence = {
    .name = "residence",
    .help = "residence times of bodies in the region",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_BODIES,
    .needs = NEEDS_BEFORE,
    .rows = residence_rows,
};

/* ---- each of those that left ---- */

static const struct quantity each[] = {
    { "id", "1", 1, "id of the body" },
    { "entered", "s", 1, "time of entry, or of the first frame" },
    { "left", "s", 1, "time of departure" },
    { "stay", "s", 1, "left minus entered" },
    { "whole", "1", 1,
      "1: its entry was observed; 0: it was inside in the first frame, its stay is longer" },
    { "removed", "1", 1, "1: it was removed from the document" },
    { 0 },
};

static int departures_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    struct frame_memory now;
    if (follow(&now, s, false, failure)) return failure->status;
    for (int64_t k = 0; k < s->before->n; k++) {
        const struct frame_memory_body *b = &s->before->body[k];
        if (!gone(&now, b)) continue;
        const double left = left_at(s, &now, b->id);
        double *at = table_row(t, failure);
        if (!at) break;
        put(&at, b->id), put(&at, b->entered), put(&at, left), put(&at, left - b->entered);
        put(&at, b->whole), put(&at, !frame_memory_find(&now, b->id));
    }
    frame_memory_free(&now);
    return failure->status;
}

const struct measure measure_departures = {
    .name = "departures",
    .help = "each body that has left the region since the previous frame",
    .quantity = each,
    .keeps_to = KEEPS_TO_BODIES,
    .list = true,
    .needs = NEEDS_BEFORE,
    .rows = departures_rows,
};
