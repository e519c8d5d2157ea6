/* solve/plan.c: bundles and seats [solve/plan.h]. */
#include "solve/plan.h"

#include "base/team.h"
#include "solve/bundle.h"

#include <stdlib.h>

enum {
    SLOTS_PER_THREAD =
        4096 /* the fewest contacts, bodies or slots that are worth a thread: 100 us of work */
};

/* Makes bundles of the schedule's groups; each group begins a new one. False when memory is short. */
static bool bundle_groups(struct plan *l, const struct schedule *by)
{
    l->group = malloc((size_t)(by->groups + 1) * sizeof *l->group);
    if (!l->group) return false;
    for (int64_t g = 0; g < by->groups; g++) {
        l->group[g] = l->bundles;
        l->bundles += (by->group[g + 1] - by->group[g] + BUNDLE - 1) / BUNDLE;
    }
    l->group[by->groups] = l->bundles;
    l->slots = l->bundles * BUNDLE;
    if (!(l->contact = malloc((size_t)(l->slots + 1) * sizeof *l->contact))) return false;
    for (int64_t g = 0; g < by->groups; g++) {
        int64_t first = by->group[g], n = by->group[g + 1] - first;
        int64_t at = l->group[g] * BUNDLE, end = l->group[g + 1] * BUNDLE;
        for (int64_t i = 0; i < n; i++) l->contact[at++] = (int32_t)by->sequence[first + i];
        for (; at < end; at++) l->contact[at] = -1;
    }
    return true;
}

/* What threads do of a plan, with the contacts and the packing that it is made of */
struct plan_making {
    struct plan *l;
    const struct contacts *s;
    const struct packing *p;
    int64_t *copies; /* [bundles + 1] of bodies that do not move, in the bundles before */
    _Atomic bool differs;
};

static void remember_pairs(void *arg, int64_t first, int64_t end)
{
    struct plan_making *m = arg;
    for (int64_t i = first; i < end; i++)
        m->l->pair[i][0] = m->s->c[i].a, m->l->pair[i][1] = m->s->c[i].b;
}

static void remember_moving(void *arg, int64_t first, int64_t end)
{
    struct plan_making *m = arg;
    for (int64_t i = first; i < end; i++) m->l->moves[i] = m->p->mass[i] > 0;
}

static bool plan_moves(const struct plan *l, int32_t body)
{
    return body >= 0 && l->moves[body];
}

static void count_copies(void *arg, int64_t first, int64_t end)
{
    struct plan_making *m = arg;
    const struct plan *l = m->l;
    for (int64_t i = BUNDLE * first; i < BUNDLE * end; i++) {
        if (l->contact[i] < 0) continue;
        const int32_t *body = l->pair[l->contact[i]];
        m->copies[i / BUNDLE + 1] += !plan_moves(l, body[0]) + !plan_moves(l, body[1]);
    }
}

/* False when memory is short */
static bool find_seats(struct plan *l)
{
    int32_t next = 0;
    if (!(l->seat = malloc((size_t)(l->bodies + 1) * sizeof *l->seat))) return false;
    for (int64_t i = 0; i < l->bodies; i++) l->seat[i] = -1;
    for (int64_t i = 0; l->order >= ORDER_COLOUR && i < l->slots; i++) {
        if (l->contact[i] < 0) continue;
        const int32_t *body = l->pair[l->contact[i]];
        for (int k = 0; k < 2; k++)
            if (body[k] >= 0 && l->seat[body[k]] < 0) l->seat[body[k]] = next++;
    }
    for (int64_t i = 0; i < l->bodies; i++)
        if (l->seat[i] < 0) l->seat[i] = next++;
    return true;
}

static void plan_seat_some(void *arg, int64_t first, int64_t end)
{
    struct plan_making *m = arg;
    const struct plan *l = m->l;
    int32_t nobody = (int32_t)l->bodies;
    int64_t next = l->bodies + 2 + m->copies[first];
    int64_t other = l->schedule.rest ? BUNDLE * l->group[l->schedule.inside] : l->slots;
    for (int64_t i = BUNDLE * first; i < BUNDLE * end; i++) {
        int32_t *at = l->seats[i];
        at[0] = at[1] = nobody + (i >= other);
        if (l->contact[i] < 0) continue;
        const int32_t *body = l->pair[l->contact[i]];
        for (int k = 0; k < 2; k++)
            at[k] = plan_moves(l, body[k]) ? l->seat[body[k]] : (int32_t)next++;
    }
}

/* The plan's parts, by a schedule whose sequence and groups are not kept; false when memory is short */
static bool plan_make(struct plan_making *m, const struct schedule *by)
{
    struct plan *l = m->l;
    int threads = team_size();
    l->schedule.groups = by->groups;
    l->schedule.beyond = by->beyond, l->schedule.inside = by->inside;
    l->schedule.rim = by->rim, l->schedule.rest = by->rest;
    l->pair = malloc((size_t)(l->n + 1) * sizeof *l->pair);
    l->moves = malloc((size_t)(l->bodies + 1) * sizeof *l->moves);
    if (!l->pair || !l->moves || !bundle_groups(l, by)) return false;
    team_share(threads, l->n, SLOTS_PER_THREAD, remember_pairs, m);
    team_share(threads, l->bodies, SLOTS_PER_THREAD, remember_moving, m);
    l->seats = malloc((size_t)(l->slots + 1) * sizeof *l->seats);
    m->copies = calloc((size_t)l->bundles + 1, sizeof *m->copies);
    if (!l->seats || !m->copies || !find_seats(l)) return false;
    team_share(threads, l->bundles, SLOTS_PER_THREAD / BUNDLE, count_copies, m);
    for (int64_t k = 0; k < l->bundles; k++) m->copies[k + 1] += m->copies[k];
    l->copies = m->copies[l->bundles];
    team_share(threads, l->bundles, SLOTS_PER_THREAD / BUNDLE, plan_seat_some, m);
    return true;
}

struct plan *plan_of_contacts(enum order order, const struct contacts *s, const struct packing *p,
                              const struct schedule *given)
{
    struct schedule by = { 0 };
    struct plan *l = malloc(sizeof *l);
    if (!l || (!given && schedule_bodies(&by, order, s, p))) return free(l), NULL;
    *l = (struct plan){ .order = order, .n = s->n, .bodies = p->n };
    struct plan_making m = { .l = l, .s = s, .p = p };
    bool made = plan_make(&m, given ? given : &by);
    l->schedule.key = by.key, l->schedule.zone = by.zone;
    by.key = NULL, by.zone = NULL;
    schedule_free(&by), free(m.copies);
    if (made) return l;
    return plan_free(l), NULL;
}

/* Every bundle becomes a group: contacts that have something in common are solved eight at a time. */
static bool part_bundles(struct plan *l)
{
    int64_t *group = realloc(l->group, (size_t)(l->bundles + 1) * sizeof *group);
    if (!group) return false;
    for (int64_t g = 0; g <= l->bundles; g++) group[g] = g;
    l->group = group, l->schedule.groups = l->bundles;
    return true;
}

struct plan *plan_of_blocks(enum order order, const struct delassus *W)
{
    struct schedule by;
    struct plan *l = malloc(sizeof *l);
    if (!l || schedule_blocks(&by, order, W)) return free(l), NULL;
    *l = (struct plan){ .order = order, .n = W->n, .schedule = { .groups = by.groups } };
    bool made = bundle_groups(l, &by) && (!W->common || part_bundles(l));
    schedule_free(&by);
    if (made) return l;
    return plan_free(l), NULL;
}

static void compare_pairs(void *arg, int64_t first, int64_t end)
{
    struct plan_making *m = arg;
    bool differs = false;
    for (int64_t i = first; i < end && !differs; i++)
        differs = m->l->pair[i][0] != m->s->c[i].a || m->l->pair[i][1] != m->s->c[i].b;
    if (differs) m->differs = true;
}

static void compare_moving(void *arg, int64_t first, int64_t end)
{
    struct plan_making *m = arg;
    bool differs = false;
    for (int64_t i = first; i < end; i++) differs |= m->l->moves[i] != (m->p->mass[i] > 0);
    if (differs) m->differs = true;
}

bool plan_holds(const struct plan *l, enum order order, const struct contacts *s,
                const struct packing *p)
{
    if (l->order != order || l->n != s->n || l->bodies != p->n) return false;
    struct plan_making m = { .l = (struct plan *)l, .s = s, .p = p };
    team_share(team_size(), l->n, SLOTS_PER_THREAD, compare_pairs, &m);
    if (m.differs) return false;
    team_share(team_size(), l->bodies, SLOTS_PER_THREAD, compare_moving, &m);
    return !m.differs && schedule_holds(&l->schedule, s, p);
}

void plan_free(struct plan *l)
{
    if (!l) return;
    schedule_free(&l->schedule);
    free(l->group), free(l->contact), free(l->seat), free(l->seats), free(l->pair), free(l->moves);
    free(l);
}
