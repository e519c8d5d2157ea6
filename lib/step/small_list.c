/* step/small_list.c: the arrays of a list, and what finds a pair or a touch in it [step/small_list.h]. */
#include "step/small_list.h"

#include <stdlib.h>
#include <string.h>

void small_list_empty(struct small_list *l)
{
    struct small *s = &l->s;
    free(s->bundle), free(s->turn), free(s->shift), free(s->hold), free(s->stick), free(s->spring),
        free(s->live), free(s->late), free(s->until), free(s->group);
    small_marks_free(s);
    free(l->slot), free(l->early), free(l->image), free(l->touch), free(l->pairs.pair);
    small_meetings_free(&l->meetings);
}

void small_list_forget(struct small_list *l)
{
    struct small *s = &l->s;
    s->bundle = NULL, s->turn = NULL, s->shift = NULL, s->hold = NULL, s->stick = NULL,
    s->spring = NULL, s->live = s->late = NULL, s->until = NULL, s->group = NULL;
    s->bundles = s->groups = s->serial = 0;
    s->mark = NULL, s->meets = s->first = NULL;
    l->slot = l->early = l->image = NULL, l->images = 0, l->touch = NULL, l->touches = l->room = 0;
    l->pairs = (struct pairs){ 0 }, l->meetings = (struct small_meetings){ 0 };
}

void small_list_free(struct small_list *l)
{
    small_list_empty(l);
    free(l->s.place), free(l->s.body), free(l->s.before), free(l->s.hot), free(l->s.change);
    free(l->listed), free(l->drift), free(l->stiffness);
    *l = (struct small_list){ 0 };
}

/* ---- pairs ---- */

vec3 small_slot_force(const struct small *s, int64_t slot)
{
    const int k = (int)(slot % BUNDLE);
    const struct small_bundle *c = &s->bundle[slot / BUNDLE];
    const vec3 f = v3(c->f[0][k], c->f[1][k], c->f[2][k]);
    if (!s->hold) return f;
    const vec3 d = small_branch(s, slot);
    return v3_axpy(f, -s->hold[slot / BUNDLE].x[HOLD_PULL][k] / v3_norm(d), d);
}

void small_list_wake(struct small *s, int64_t slot)
{
    memset(&s->live[slot / BUNDLE * BUNDLE], 1, BUNDLE);
}

struct contact_key small_pair_key(const struct pair *q)
{
    return (struct contact_key){ q->a, q->b, 0, { q->shift[0], q->shift[1], q->shift[2] } };
}

/* small_list_pair() among the first `end` pairs */
int64_t small_list_pair_before(const struct small_list *l, int64_t from, int64_t end,
                               struct contact_key key, bool *found)
{
    int order = -1;
    while (from < end && (order = contact_key_order(small_pair_key(&l->pairs.pair[from]), key)) < 0)
        from++;
    *found = order == 0;
    return from;
}

int64_t small_list_pair(const struct small_list *l, int64_t from, struct contact_key key,
                        bool *found)
{
    return small_list_pair_before(l, from, l->pairs.n, key, found);
}

/* ---- walls ---- */

double small_wall_distance(const struct packing *p, const struct pose *pose, int32_t w, vec3 x,
                           double r, vec3 *n)
{
    const struct wall *wall = &p->wall[w];
    struct touch t;
    vec3 c = v3_sub(quat_turn_back(pose->q, v3_sub(x, pose->shift)), wall->x);
    if (wall->shape == WALL_PLANE) {
        t.n = wall->n, t.distance = v3_dot(c, wall->n);
    } else if (!wall_nearest(wall, p->dim, c, r, &t)) {
        return INFINITY;
    }
    *n = quat_turn(pose->q, t.n);
    return t.distance;
}

int64_t small_list_touch(const struct small_list *l, int64_t body, int32_t wall)
{
    int64_t lo = 0, hi = l->touches;
    while (lo < hi) {
        const int64_t mid = lo + (hi - lo) / 2;
        const struct small_touch *t = &l->touch[mid];
        if (t->body < body || (t->body == body && t->wall < wall))
            lo = mid + 1;
        else
            hi = mid;
    }
    return lo;
}

struct small_touch *small_list_find_touch(const struct small_list *l, int32_t body, int32_t wall)
{
    const int64_t k = small_list_touch(l, body, wall);
    return k < l->touches && l->touch[k].body == body && l->touch[k].wall == wall ? &l->touch[k]
                                                                                  : NULL;
}

/* In the order of contacts: walls first, the last one of them first */
static int touch_key_order(const void *x, const void *y)
{
    const struct small_touch *s = *(const struct small_touch *const *)x;
    const struct small_touch *t = *(const struct small_touch *const *)y;
    if (s->wall != t->wall) return s->wall > t->wall ? -1 : 1;
    return s->body < t->body ? -1 : s->body > t->body;
}

struct small_touch **small_list_touches(const struct small_list *l)
{
    struct small_touch **by = malloc(((size_t)l->touches + 1) * sizeof(struct small_touch *));
    for (int64_t i = 0; by && i < l->touches; i++) by[i] = &l->touch[i];
    if (by) qsort(by, (size_t)l->touches, sizeof(struct small_touch *), touch_key_order);
    return by;
}
