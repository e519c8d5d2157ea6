/* step/small_meet.c: meetings, by their keys and in groups [step/small_meet.h]. */
#include "step/small_meet.h"

#include "base/array.h"
#include "contact/contact_law.h"
#include "step/small_tie.h"

#include <stdlib.h>
#include <string.h>

enum { COLOURS = 64 };

static void small_meetings_free_order(struct small_meetings *m)
{
    free(m->group), free(m->order), free(m->held_first), free(m->held);
    m->group = m->order = m->held_first = m->held = NULL;
}

void small_meetings_free(struct small_meetings *m)
{
    for (int64_t i = 0; i < m->n; i++) free(m->of[i].point);
    small_meetings_free_order(m);
    free(m->of);
    *m = (struct small_meetings){ 0 };
}

bool small_meetings_add(struct small_meetings *m, const struct packing *p, struct contact_key key)
{
    if (!array_grow(&m->of, &m->room, m->n + 1, sizeof *m->of)) return false;
    struct small_meeting *new = &m->of[m->n++];
    *new = (struct small_meeting){ .key = key };
    contact_laws_rolling(p, key.a, key.b, &new->most[1], &new->most[0]);
    if (small_tie_holds(p)) small_tie_set(new->hold, p, key.a, key.b, p->dt);
    return true;
}

static int by_key(const void *x, const void *y)
{
    const struct small_meeting *s = x, *t = y;
    return contact_key_order(s->key, t->key);
}

/* ---- groups ---- */

static bool meeting_moves(const struct packing *p, int32_t i)
{
    return i >= 0 && p->mass[i] > 0;
}

/* The colour of each meeting; COLOURS: none is left */
static bool colour_meetings(const struct small_meetings *m, const struct packing *p, uint8_t *of,
                            int64_t count[COLOURS + 1])
{
    uint64_t *used = calloc((size_t)p->n + 1, sizeof *used);
    for (int64_t i = 0; used && i < m->n; i++) {
        const int32_t a = m->of[i].key.a, b = m->of[i].key.b;
        const bool moves[2] = { meeting_moves(p, a), meeting_moves(p, b) };
        const uint64_t free = ~((moves[0] ? used[a] : 0) | (moves[1] ? used[b] : 0));
        const int k = free ? __builtin_ctzll(free) : COLOURS;
        of[i] = (uint8_t)k, count[k]++;
        if (free && moves[0]) used[a] |= 1ULL << k;
        if (free && moves[1]) used[b] |= 1ULL << k;
    }
    free(used);
    return used != NULL;
}

static bool group_meetings(struct small_meetings *m, const struct packing *p)
{
    int64_t count[COLOURS + 1] = { 0 }, next[COLOURS + 1], at = 0;
    uint8_t *of = malloc((size_t)m->n + 1);
    m->order = malloc((size_t)(m->n + 1) * sizeof *m->order);
    bool room = of && m->order && colour_meetings(m, p, of, count);
    m->group = malloc((size_t)(COLOURS + count[COLOURS] + 1) * sizeof *m->group);
    m->groups = 0;
    for (int k = 0; room && m->group && k < COLOURS; k++) {
        next[k] = at;
        if (count[k]) m->group[m->groups++] = at;
        at += count[k];
    }
    next[COLOURS] = at, m->serial = m->groups;
    for (int64_t i = 0; room && m->group && i < count[COLOURS]; i++) m->group[m->groups++] = at + i;
    if (m->group) m->group[m->groups] = m->n;
    for (int64_t i = 0; room && m->group && i < m->n; i++) m->order[next[of[i]]++] = i;
    free(of);
    return room && m->group;
}

/* The body that moves of a meeting with what does not; -1: both may move */
static int32_t held_body(const struct packing *p, const struct small_meeting *m)
{
    const bool a = meeting_moves(p, m->key.a), b = meeting_moves(p, m->key.b);
    return a == b ? -1 : a ? m->key.a : m->key.b;
}

static bool list_held(struct small_meetings *m, const struct packing *p)
{
    m->held_first = calloc((size_t)p->n + 2, sizeof *m->held_first);
    m->held = malloc((size_t)(m->n + 1) * sizeof *m->held);
    if (!m->held_first || !m->held) return false;
    for (int64_t i = 0; i < m->n; i++) {
        const int32_t b = held_body(p, &m->of[i]);
        if (b >= 0) m->held_first[b + 2]++;
    }
    for (int64_t i = 0; i < p->n; i++) m->held_first[i + 2] += m->held_first[i + 1];
    for (int64_t i = 0; i < m->n;
         i++) { // held_first[b+1] moves from where b begins to where it ends
        const int32_t b = held_body(p, &m->of[i]);
        if (b >= 0) m->held[m->held_first[b + 1]++] = i;
    }
    return true;
}

/* ---- what they have ---- */

struct small_meeting *small_meetings_find(const struct small_meetings *m, struct contact_key key)
{
    int64_t lo = 0, hi = m->n;
    key.feature = 0;
    while (lo < hi) {
        const int64_t mid = lo + (hi - lo) / 2;
        if (contact_key_order(m->of[mid].key, key) < 0)
            lo = mid + 1;
        else
            hi = mid;
    }
    return lo < m->n && !contact_key_order(m->of[lo].key, key) ? &m->of[lo] : NULL;
}

static bool meeting_has_pushed(const struct small_meeting *m)
{
    for (int64_t i = 0; i < m->points; i++)
        for (int k = 0; k < 3; k++)
            if (m->point[i].f[k] != 0 || m->point[i].sum[k] != 0 || m->point[i].feature < 0)
                return true;
    return false;
}

/* Meetings whose bodies a bond holds, however far they are; in the order of keys */
static bool add_bonded(struct small_meetings *more, const struct packing *p,
                       const struct small_meetings *m)
{
    bool room = true;
    for (int64_t i = 0; room && i < p->bonds.n; i++) {
        const struct bond *b = &p->bonds.bond[i];
        struct contact_key key = bond_key(b);
        key.feature = 0;
        if (!bond_anchored(b) || !(b->beta > 0) || !packing_may_meet(p, b->a, b->b)) continue;
        if (small_meetings_find(m, key)) continue;
        if (more->n && !contact_key_order(more->of[more->n - 1].key, key)) continue;
        room = small_meetings_add(more, p, key);
    }
    return room;
}

/* In the order of keys; those that have pushed in this interval stay. */
static bool sort_meetings(struct small_meetings *m, const struct packing *p,
                          const struct small_meetings *from)
{
    struct small_meetings more = { 0 };
    bool room = true;
    if (m->n) qsort(m->of, (size_t)m->n, sizeof *m->of, by_key);
    room = add_bonded(&more, p, m);
    for (int64_t i = 0; room && i < more.n; i++) room = small_meetings_add(m, p, more.of[i].key);
    if (more.n && m->n) qsort(m->of, (size_t)m->n, sizeof *m->of, by_key);
    more.n = 0;
    for (int64_t i = 0; room && i < from->n; i++)
        if (meeting_has_pushed(&from->of[i]) && !small_meetings_find(m, from->of[i].key))
            room = small_meetings_add(&more, p, from->of[i].key);
    for (int64_t i = 0; room && i < more.n; i++) room = small_meetings_add(m, p, more.of[i].key);
    if (more.n && m->n) qsort(m->of, (size_t)m->n, sizeof *m->of, by_key);
    free(more.of);
    return room;
}

bool small_meetings_lay(struct small_meetings *m, const struct packing *p,
                        const struct small_meetings *from)
{
    return sort_meetings(m, p, from) && group_meetings(m, p) && list_held(m, p);
}

void small_meetings_carry(struct small_meetings *to, struct small_meetings *from)
{
    for (int64_t i = 0; i < from->n; i++) {
        struct small_meeting *was = &from->of[i], *is = small_meetings_find(to, was->key);
        if (!is) continue;
        *is = *was;
        was->point = NULL, was->points = 0, was->work = 0;
    }
}

bool small_meeting_recall(struct small_meeting *m, const struct recall *r, double part)
{
    if (!array_grow(&m->point, &m->room, m->points + 1, sizeof *m->point)) return false;
    struct small_point *t = &m->point[m->points++];
    *t = (struct small_point){ .feature = r->feature, .starts = true };
    const vec3 f = v3_scale(part, r->r), moment = v3_scale(part, r->m);
    t->f[0] = f.x, t->f[1] = f.y, t->f[2] = f.z;
    t->m[0] = moment.x, t->m[1] = moment.y, t->m[2] = moment.z;
    return true;
}

int64_t small_meetings_points(const struct small_meetings *m)
{
    int64_t n = 0;
    for (int64_t i = 0; i < m->n; i++) n += m->of[i].points;
    return n;
}

vec3 small_meeting_impulse(const struct small_meeting *m, const struct body *body)
{
    const bool a = m->key.a >= 0 && body[m->key.a].im > 0, b = body[m->key.b].im > 0;
    vec3 sum = v3(0, 0, 0);
    if (a == b) return sum;
    for (int64_t i = 0; i < m->points; i++) {
        const struct small_point *t = &m->point[i];
        sum = v3_add(sum, v3(t->sum[0] + t->f[0], t->sum[1] + t->f[1], t->sum[2] + t->f[2]));
    }
    return v3_scale(b ? 1 : -1, sum);
}
