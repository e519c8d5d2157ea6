/* step/small_bonds.c: what lasts of pairs through an interval of small steps [step/small_bonds.h]. */
#include "step/small_bonds.h"

#include "contact/contact_law.h"
#include "step/small_anchor.h"
#include "step/small_springs.h"
#include "step/small_wall.h"

#include <stdlib.h>

/* What a slot has */
static void hold_of(const struct small *s, int64_t slot, double x[HOLD_COUNT])
{
    for (int j = 0; j < HOLD_COUNT; j++) x[j] = s->hold[slot / BUNDLE].x[j][slot % BUNDLE];
}

/* m: the gap of a slot, and the normal */
static double slot_gap(const struct small *s, int64_t slot, vec3 *n)
{
    const struct small_bundle *c = &s->bundle[slot / BUNDLE];
    const int64_t a = body_index(c->a[slot % BUNDLE]), b = body_index(c->b[slot % BUNDLE]);
    const vec3 d = small_branch(s, slot);
    const double length = v3_norm(d);
    *n = small_normal(d);
    return length - s->place[a].r - s->place[b].r;
}

/* ---- from the packing ---- */

/* A touch that has a bridge, perhaps one that is new */
static void wet_touch(const struct small_run *r, struct small_touch *t, bool new)
{
    t->hold[HOLD_WET] = 1;
    if (new &&small_look_at_touch(r, t, r->l->margin))
        t->hold[HOLD_JOINED] = small_hold_bridge(t->hold, t->arm - r->l->s.place[t->body].r);
}

static void wet_slot(struct small *s, int64_t slot, bool new)
{
    double x[HOLD_COUNT], *joined = &s->hold[slot / BUNDLE].x[HOLD_JOINED][slot % BUNDLE];
    vec3 n;
    hold_of(s, slot, x);
    s->hold[slot / BUNDLE].x[HOLD_WET][slot % BUNDLE] = 1;
    if (new) *joined = small_hold_bridge(x, slot_gap(s, slot, &n));
    small_list_wake(s, slot);
}

static void wet_meeting(struct small_meeting *m, bool new, double gap)
{
    if (new && !(m->hold[HOLD_WET] > 0)) m->hold[HOLD_JOINED] = small_hold_bridge(m->hold, gap);
    m->hold[HOLD_WET] = 1;
}

static void recall_bridges(struct small_run *r)
{
    const struct bonds *bonds = &r->p->bonds;
    struct small_list *l = r->l;
    int64_t at = 0;
    bool found;
    for (int64_t i = 0; i < bonds->n; i++) {
        const struct bond *b = &bonds->bond[i];
        if (!b->wet) continue;
        struct small_meeting *m = small_meetings_find(&l->meetings, bond_key(b));
        if (m) {
            wet_meeting(m, b->wet == BOND_WETTED, b->gap);
            continue;
        }
        if (b->a < 0) {
            struct small_touch *t = small_list_find_touch(l, b->b, -1 - b->a);
            if (t) wet_touch(r, t, b->wet == BOND_WETTED);
            continue;
        }
        at = small_list_pair(l, at, bond_key(b), &found);
        if (found) wet_slot(&l->s, l->slot[at], b->wet == BOND_WETTED);
    }
}

static void set_pull(struct small_holds *to, int k, double pull, vec3 n)
{
    to->x[HOLD_PULL][k] = pull;
    to->x[HOLD_X][k] = n.x, to->x[HOLD_Y][k] = n.y, to->x[HOLD_Z][k] = n.z;
}

void small_bonds_recall(struct small_run *r, bool warm)
{
    struct small_list *l = r->l;
    struct small *s = &l->s;
    if (!s->hold) return;
    recall_bridges(r);
    for (int64_t i = 0; warm && i < l->pairs.n; i++) {
        const int64_t slot = l->slot[i];
        double x[HOLD_COUNT];
        vec3 n;
        hold_of(s, slot, x);
        const double pull = r->h * small_hold_force(x, slot_gap(s, slot, &n));
        set_pull(&s->hold[slot / BUNDLE], (int)(slot % BUNDLE), pull, n);
        if (pull > 0) small_list_wake(s, slot);
    }
    for (int64_t i = 0; warm && i < l->touches; i++) {
        struct small_touch *t = &l->touch[i];
        if (!small_look_at_touch(r, t, l->margin)) continue;
        t->hold[HOLD_PULL] = r->h * small_hold_force(t->hold, t->arm - s->place[t->body].r);
        small_array(&t->hold[HOLD_X], t->n);
    }
}

/* ---- what it stores ---- */

/* m: by which a pair opens, b against a, between the position of the bodies and that where contacts act, which the list has */
static double opens_ahead(const struct small_run *r, int64_t slot, vec3 n)
{
    const struct small *s = &r->l->s;
    const struct small_bundle *c = &s->bundle[slot / BUNDLE];
    const struct body *a = &s->body[body_index(c->a[slot % BUNDLE])];
    const struct body *b = &s->body[body_index(c->b[slot % BUNDLE])];
    vec3 v = v3_sub(small_vec(b->v), small_vec(a->v));
    if (s->moves) v = v3_add(v, small_image_velocity(s, slot));
    return r->ahead * v3_dot(n, v);
}

/* m: the gap of a touch where the bodies are; false: it is not near. */
static bool touch_gap(const struct small_run *r, struct small_touch *t, double *gap)
{
    const struct small *s = &r->l->s;
    if (!small_look_at_touch(r, t, r->l->margin)) return false;
    const vec3 v = v3_sub(small_vec(s->body[t->body].v), t->v);
    *gap = t->arm - s->place[t->body].r - r->ahead * v3_dot(t->n, v);
    return true;
}

struct small_bonds small_bonds_account(struct small_run *r)
{
    struct small_list *l = r->l;
    struct small_bonds sum = { .joined = 0 };
    if (!l->s.hold) return sum;
    for (int64_t i = 0; i < l->touches; i++) {
        struct small_touch *t = &l->touch[i];
        double gap;
        sum.joined += t->hold[HOLD_JOINED];
        if (touch_gap(r, t, &gap)) sum.stored += small_hold_energy(t->hold, gap);
    }
    for (int64_t i = 0; i < l->pairs.n; i++) {
        double x[HOLD_COUNT];
        vec3 n;
        hold_of(&l->s, l->slot[i], x);
        sum.joined += x[HOLD_JOINED];
        const double gap = slot_gap(&l->s, l->slot[i], &n);
        sum.stored += small_hold_energy(x, gap - opens_ahead(r, l->slot[i], n));
    }
    for (int64_t i = 0; i < l->meetings.n; i++) {
        const struct small_meeting *m = &l->meetings.of[i];
        sum.joined += m->hold[HOLD_JOINED], sum.stored += small_attract_energy(m);
    }
    return sum;
}

/* ---- and back ---- */

/* A bond without anything that lasts */
static struct bond bond_of(struct contact_key key)
{
    struct bond b = { .a = key.a, .b = key.b, .feature = key.feature };
    for (int k = 0; k < 3; k++) b.shift[k] = key.shift[k];
    return b;
}

/* Keeps it where its springs last, or with the bridge of its pair, where there is one; false when memory is short. */
static bool keep_bond(struct bonds *kept, struct bond *b, bool lasts, const double x[HOLD_COUNT],
                      double gap, vec3 n)
{
    if (x[HOLD_WET] > 0 && gap < x[HOLD_REACH]) b->wet = BOND_WET, b->gap = gap, b->n = n;
    return (!b->wet && !lasts) || bonds_add(kept, b) != NULL;
}

static bool keep_touch(struct small_run *r, struct bonds *kept, struct small_touch *t)
{
    struct bond b = bond_of((struct contact_key){ .a = -1 - t->wall, .b = t->body });
    if (!small_look_at_touch(r, t, r->l->margin)) return true;
    const bool lasts = small_springs_keep_touch(r, t, &b);
    return keep_bond(kept, &b, lasts, t->hold, t->arm - r->l->s.place[t->body].r, t->n);
}

static bool keep_pair(const struct small_run *r, struct bonds *kept, int64_t i)
{
    const struct small_list *l = r->l;
    struct bond b = bond_of(small_pair_key(&l->pairs.pair[i]));
    double x[HOLD_COUNT] = { 0 };
    vec3 n;
    const double gap = slot_gap(&l->s, l->slot[i], &n);
    if (l->s.hold) hold_of(&l->s, l->slot[i], x);
    const bool lasts = small_springs_keep_slot(r, l->slot[i], &b);
    return keep_bond(kept, &b, lasts, x, gap, n);
}

static bool keep_points(const struct small_run *r, struct bonds *kept,
                        const struct small_meeting *m)
{
    bool room = true;
    for (int64_t k = 0; room && k < m->points; k++) {
        const struct small_point *t = &m->point[k];
        struct contact_key key = m->key;
        key.feature = t->from ? t->from - 1 : t->feature;
        struct bond b = bond_of(key);
        const bool bonded = r->bonds && small_point_bonded(t);
        if (!bonded && (!t->there || t->seam)) continue;
        const bool lasts =
            bonded ? small_anchor_keep(r, m, t, &b) : small_springs_keep_point(r, m, t, &b);
        if (bonded && !lasts) continue;
        room = keep_bond(kept, &b, lasts, m->hold, t->gap, t->n);
    }
    return room;
}

int small_bonds_keep(struct small_run *r, struct failure *failure)
{
    struct small_list *l = r->l;
    struct bonds kept = { 0 };
    if (!l->s.hold && !l->stiffness) return 0;
    struct small_touch **by = small_list_touches(l);
    bool room = by != NULL;
    for (int64_t i = 0; room && i < l->touches; i++) room = keep_touch(r, &kept, by[i]);
    for (int64_t i = 0; room && i < l->pairs.n; i++) room = keep_pair(r, &kept, i);
    for (int64_t i = 0; room && i < l->meetings.n; i++)
        room = keep_points(r, &kept, &l->meetings.of[i]);
    if (room && l->meetings.n) bonds_sort(&kept);
    free(by);
    if (!room) {
        bonds_free(&kept);
        return failure_set(failure, EX_SOFTWARE, "no memory for the bonds");
    }
    bonds_free(&r->p->bonds);
    r->p->bonds = kept;
    return 0;
}

int small_bonds_laws(struct contacts *s, const struct packing *p, struct failure *failure)
{
    int64_t from = 0;
    if (!p->law) return 0;
    if (contacts_alloc_laws(s)) return failure_set(failure, EX_SOFTWARE, "no memory for the ties");
    for (int64_t i = 0; i < s->n; i++) {
        const struct contact *c = &s->c[i];
        double x[HOLD_COUNT];
        contact_laws_rolling(p, c->a, c->b, &s->law[i].mu_r, &s->law[i].mu_p);
        const struct bond *bond = bonds_find(&p->bonds, c, &from);
        if (small_tie_holds(p)) {
            small_tie_set(x, p, c->a, c->b, 0);
            if (bond && bond->wet) x[HOLD_WET] = 1, s->law[i].state = CONTACT_LAW_WET;
            s->law[i].pull = small_hold_force(x, c->gap), s->law[i].jump[0] = fmax(0, c->gap);
        }
        small_springs_law(&s->law[i], p, c, bond);
    }
    return 0;
}
