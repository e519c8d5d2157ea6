/* measure/lifetimes.c: how long pairs touch [Silbert et al. 2007]. */
#include "measure/follow.h"
#include "measure/measures.h"

#include <math.h>

static const struct quantity quantities[] = {
    { "since", "s", 1, "time since the previous frame" },
    { "pairs", "1", 1, "number of pairs of bodies, or of a wall and a body, in contact" },
    { "made", "1", 1, "number of those that formed since the previous frame" },
    { "ended", "1", 1, "number of pairs in contact then and not now" },
    { "age", "s", 1, "mean time in contact of these pairs, at most since the first frame" },
    { "life", "s", 1,
      "mean time in contact of the pairs that ended and whose beginning was observed" },
    { 0 },
};

static int lifetimes_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    struct frame_memory now;
    double made = 0, ended = 0, age = 0, life = 0, whole = 0, *at = table_row(t, failure);
    if (!at || follow(&now, s, true, failure)) return failure->status;
    for (int64_t k = 0; k < now.pairs; k++)
        made += !frame_memory_pair_find(s->before, &now.pair[k]),
            age += s->p->t - now.pair[k].began;
    for (int64_t k = 0; k < s->before->pairs; k++) {
        const struct frame_memory_pair *c = &s->before->pair[k];
        if (frame_memory_pair_find(&now, c)) continue;
        ended++;
        if (c->whole) whole++, life += s->p->t - c->began;
    }
    const double n = (double)now.pairs;
    put(&at, s->p->t - s->before->t), put(&at, n), put(&at, made), put(&at, ended);
    if (!(n > 0)) table_null(t, "nothing touches");
    if (!(whole > 0))
        table_null(t, "no contact whose beginning was observed has ended since the previous frame");
    put(&at, n > 0 ? age / n : NAN), put(&at, whole > 0 ? life / whole : NAN);
    frame_memory_free(&now);
    return 0;
}

const struct measure measure_lifetimes = {
    .name = "lifetimes",
    .help = "durations of contacts",
    .quantity = quantities,
    .needs = NEEDS_CONTACTS_BEFORE,
    .rows = lifetimes_rows,
};

/* ---- each of those that ended ---- */

static const struct quantity each[] = {
    { "a", "1", 1, "id of a body, or -1-w for wall w" },
    { "b", "1", 1, "id of the other body" },
    { "began", "s", 1, "time of the first frame in contact" },
    { "ended", "s", 1, "time of the first frame not in contact" },
    { "life", "s", 1, "ended minus began" },
    { "whole", "1", 1,
      "1: its beginning was observed; 0: in contact in the first frame, its life is longer" },
    { 0 },
};

static int separations_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    struct frame_memory now;
    if (follow(&now, s, true, failure)) return failure->status;
    for (int64_t k = 0; k < s->before->pairs; k++) {
        const struct frame_memory_pair *c = &s->before->pair[k];
        if (frame_memory_pair_find(&now, c)) continue;
        double *at = table_row(t, failure);
        if (!at) break;
        put(&at, c->a), put(&at, c->b), put(&at, c->began), put(&at, s->p->t);
        put(&at, s->p->t - c->began), put(&at, c->whole);
    }
    frame_memory_free(&now);
    return failure->status;
}

const struct measure measure_separations = {
    .name = "separations",
    .help = "each contact that has ended since the previous frame",
    .quantity = each,
    .list = true,
    .needs = NEEDS_CONTACTS_BEFORE,
    .rows = separations_rows,
};
