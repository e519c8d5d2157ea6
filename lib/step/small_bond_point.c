/* step/small_bond_point.c: bonds at the points of meetings [step/small_anchor.h]. */
#include "step/small_anchor.h"

#include "base/array.h"
#include "contact/bond_anchor.h"
#include "contact/contact_law.h"
#include "state/attraction.h"
#include "state/kinematics.h"
#include "step/small_point.h"
#include "step/small_stiff.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct pair_law *law_of(const struct small_run *r, const struct small_meeting *m)
{
    return &r->p->law[packing_pair(r->p, m->key.a, m->key.b)];
}

/* Of a point of the meeting, as the contact that it is */
static struct contact contact_at(const struct small_meeting *m, const struct small_point *t)
{
    struct contact c = { .a = m->key.a, .b = m->key.b, .feature = t->feature };
    memcpy(c.shift, m->key.shift, sizeof c.shift);
    c.x = t->x, c.n = t->n, c.t1 = t->t1, c.gap = t->gap;
    return c;
}

/* Do documents have places of its bonds? */
static bool has_places(const struct small_run *r, const struct small_meeting *m)
{
    const struct contact c = { .a = m->key.a, .b = m->key.b };
    return contact_shaped(r->p, &c);
}

/* m: the gap at which its bodies touch */
static double touch_of(const struct small_run *r, const struct small_meeting *m)
{
    const struct contact c = { .a = m->key.a, .b = m->key.b };
    return contact_laws_touch(r->p, &c);
}

/* A point that the narrow phase has found where no bond is, whose bodies touch or have pushed there */
static bool touches_at(const struct small_point *t, double touch)
{
    if (small_point_bonded(t) || !t->there || t->seam || t->beside) return false;
    return t->gap <= touch || v3_dot(small_vec(t->f), t->n) > 0;
}

void small_anchor_stiff(const struct small_run *r, const struct small_meeting *m,
                        struct small_point *t, double wn, double wt)
{
    const int32_t a = m->key.a, b = m->key.b;
    small_stiff_set(t->spring, r->l->stiffness, r->p, a, b, wn, wt);
    small_stiff_bond(t->spring, r->p, a, b, small_point_bonded(t) ? t->area : 0);
    t->spring[SPRING_FRESH] = 0;
    for (int k = SPRING_KN; k <= SPRING_YIELD && small_point_bonded(t); k++) t->spring[k] = 0;
}

/* ---- where they are ---- */

static void poses_of(const struct small_run *r, const struct small_meeting *m, struct pose of[2])
{
    const int32_t a = m->key.a, b = m->key.b;
    of[0] = a < 0 ? r->wall[-1 - a].pose : (struct pose){ r->shapes.q[a], r->x[a] };
    of[1] = (struct pose){ r->shapes.q[b], r->x[b] };
    if (r->shapes.at.edge)
        of[1].shift = v3_add(of[1].shift, cell_shift(r->cell.edge, m->key.shift));
}

/* Has another bond of the meeting this feature in documents? */
static bool is_named(const struct small_meeting *m, const struct small_point *t, int32_t feature)
{
    bool named = false;
    for (int64_t i = 0; i < m->points && !named; i++)
        named = small_point_bonded(&m->point[i]) && &m->point[i] != t &&
                m->point[i].spring[SPRING_HELD] > 0 && m->point[i].from == feature + 1;
    return named;
}

/* The point that the narrow phase has found where the bond of a ball with a surface is now; NULL */
static struct small_point *point_below(const struct small_meeting *m, const struct small_point *t)
{
    struct small_point *best = NULL;
    double least = INFINITY;
    for (int64_t i = 0; i < m->points; i++) {
        struct small_point *is = &m->point[i];
        if (small_point_bonded(is) || !is->there || is_named(m, t, is->feature)) continue;
        if (is->feature == t->from - 1) return is;
        const double way = t->area > 0 ? v3_norm(v3_sub(is->x, t->x)) : INFINITY;
        if (way < least) least = way, best = is;
    }
    return best;
}

/* The reaction of `from`, and all that it has pushed, are those of the bond. */
static void take_past(struct small_point *t, struct small_point *from)
{
    for (int k = 0; k < 3; k++) {
        t->f[k] += from->f[k], t->sum[k] += from->sum[k];
        t->m[k] += from->m[k], t->turned[k] += from->turned[k];
        from->f[k] = from->sum[k] = from->m[k] = from->turned[k] = 0;
    }
    t->starts = from->starts;
}

bool small_anchor_place(const struct small_run *r, const struct small_meeting *m,
                        struct small_point *t, struct contact *c)
{
    struct bond b = { .a = m->key.a, .b = m->key.b, .feature = t->feature };
    struct pose of[2];
    if (b.a < 0 && !r->wall[-1 - b.a].there) return false;
    if (!has_places(r, m)) {
        struct small_point *is = point_below(m, t);
        if (!is) return false;
        *c = contact_at(m, is), c->feature = t->feature, c->mu = is->mu;
        t->from = is->feature + 1;
        if (!(t->area > 0)) take_past(t, is);
        return true;
    }
    memcpy(b.shift, m->key.shift, sizeof b.shift);
    b.at_a = t->at[0], b.at_b = t->at[1], b.axis = t->axis;
    poses_of(r, m, of);
    *c = bond_anchor_contact(r->p, &b, of, r->cell.edge);
    return true;
}

double small_anchor_reach(const struct small_run *r, const struct small_meeting *m)
{
    double reach = 0;
    for (int64_t i = 0; i < m->points; i++)
        if (small_point_holds(&m->point[i]) && !has_places(r, m))
            reach = fmax(reach, m->point[i].gap);
    return reach;
}

/* ---- what the last step has made of them ---- */

/* Shear and damage of a bond, by the velocities of[] with which bodies move */
static void stretch(const struct small_run *r, const struct small_meeting *m,
                    const struct small_point *t, const struct body *of, double x[SPRING_COUNT])
{
    const int32_t a = m->key.a;
    const vec3 wa = a < 0 ? r->wall[-1 - a].spin : small_vec(of[a].w);
    struct small_stretch at = { .gap = t->gap, .h = r->h };
    double q[3];
    small_array(at.n, t->n), small_array(at.u, small_point_velocity(r, m, t, of));
    at.spin = 0.5 * r->h * v3_dot(v3_add(wa, small_vec(of[m->key.b].w)), t->n);
    small_spring_begin(x, &at, q);
}

static void begin_bond(const struct small_run *r, const struct small_meeting *m,
                       struct small_point *t)
{
    const double beta = t->spring[SPRING_BETA];
    small_anchor_stiff(r, m, t, t->W[0], t->W[4]);
    if (t->there) {
        stretch(r, m, t, r->l->s.before, t->spring);
    } else { // the wall has gone, or a ball the surface
        t->spring[SPRING_GIVEN] += beta * beta * small_bond_energy(t->spring, t->gap, r->h);
        t->spring[SPRING_BETA] = t->spring[SPRING_HELD] = 0;
    }
    if (!small_point_holds(t)) t->there = t->near = false;
}

/* The bond that holds where point i is; NULL */
static const struct small_point *bond_at(const struct small_run *r, const struct small_meeting *m,
                                         int64_t i)
{
    const struct contact c = contact_at(m, &m->point[i]);
    for (int64_t k = 0; k < m->points; k++) {
        const struct small_point *t = &m->point[k];
        if (small_point_holds(t) && t->there && bond_anchor_near(r->p, &c, t->x)) return t;
    }
    return NULL;
}

/* Of the permitted overlap: a point where a bond is that overlaps by so much more than the bond, because bodies have turned, pushes, too,
   and rubs as the bond does. */
#define DEEPER 0.25

static bool hide_points(const struct small_run *r, struct small_meeting *m)
{
    const double deeper = DEEPER * r->overlap * r->thin;
    bool any = false;
    for (int64_t i = 0; i < m->points; i++) {
        struct small_point *t = &m->point[i];
        if (small_point_bonded(t) || !t->there || t->seam || t->beside) continue;
        const struct small_point *bond = bond_at(r, m, i);
        if (!bond) continue;
        t->beside = true;
        if (t->gap < bond->gap - deeper)
            t->e[0] = t->e[1] = 0, t->mu *= 1 - bond->spring[SPRING_BETA];
        else
            t->near = false, t->seam = any = true;
    }
    return any;
}

/* Is a bond of the meeting broken, and its bodies have not parted? */
static bool has_broken(const struct small_meeting *m)
{
    bool any = false;
    for (int64_t i = 0; i < m->points && !any; i++)
        any = small_point_bonded(&m->point[i]) && m->point[i].spring[SPRING_HELD] > 0 &&
              !small_point_holds(&m->point[i]);
    return any;
}

/* Broken bonds of bodies that have parted are forgotten. */
static void forget_broken(const struct small_run *r, struct small_meeting *m)
{
    const double touch = touch_of(r, m);
    bool together = !has_broken(m);
    for (int64_t i = 0; i < m->points; i++)
        together |= small_point_holds(&m->point[i]) || touches_at(&m->point[i], touch);
    for (int64_t i = 0; i < m->points && !together; i++)
        if (small_point_bonded(&m->point[i])) m->point[i].spring[SPRING_HELD] = 0;
}

bool small_anchors_begin(const struct small_run *r, struct small_meeting *m, bool last)
{
    const struct pair_law *l = law_of(r, m);
    bool broke = false;
    if (!pair_law_adheres(l)) return false;
    for (int64_t i = 0; i < m->points && !last; i++) {
        struct small_point *t = &m->point[i];
        if (!small_point_holds(t)) continue;
        begin_bond(r, m, t);
        broke |= !small_point_holds(t);
    }
    const bool hides = hide_points(r, m);
    forget_broken(r, m);
    const bool stills =
        l->forever && l->beta > 0 && !has_broken(m); // nothing rebounds that is to be bonded
    for (int64_t i = 0; i < m->points && stills; i++) m->point[i].e[0] = m->point[i].e[1] = 0;
    return hides || broke;
}

/* ---- making ---- */

/* Bonds that share areas: to be made at a point that has been found, or made before in this interval, or of a ball with a surface */
struct small_due {
    int64_t meeting, found, bond; /* found, bond: -1: none */
};
struct small_dues {
    struct contacts places;
    struct small_due *due; /* [places.n] */
    struct attraction *of; /* [places.n] */
    int64_t room, of_room;
    bool any; /* one has no area */
};

void small_anchors_free(struct small_run *r)
{
    struct small_dues *y = r->shapes.dues;
    if (y) contacts_free(&y->places), free(y->due), free(y->of);
    free(y), r->shapes.dues = NULL;
}

static bool add_due(struct small_dues *y, const struct small_meeting *m, struct small_due due)
{
    const int64_t at = due.found < 0 ? due.bond : due.found;
    struct contact *c = contacts_add(&y->places, m->key.a, m->key.b);
    if (!c || !array_grow(&y->due, &y->room, y->places.n, sizeof *y->due) ||
        !array_grow(&y->of, &y->of_room, y->places.n, sizeof *y->of))
        return false;
    *c = contact_at(m, &m->point[at]);
    y->due[y->places.n - 1] = due;
    y->of[y->places.n - 1] = (struct attraction){ .bonded = true };
    y->any |= due.found >= 0;
    return true;
}

/* Beta of bonds that are made of the meeting's points that touch; 0: none are */
static double beta_due(const struct small_run *r, const struct small_meeting *m)
{
    const struct pair_law *l = law_of(r, m);
    if (!pair_law_adheres(l) || (l->forever ? has_broken(m) : !r->begins)) return 0;
    if (l->forever) return l->beta;
    struct packing whole = *r->p;
    whole.dt = r->l->interval;
    return contact_laws_bond(&whole, l) ? l->beta : 0;
}

static bool gather_dues(const struct small_run *r, struct small_dues *y, int64_t meeting)
{
    struct small_meeting *m = &r->l->meetings.of[meeting];
    const double due = beta_due(r, m), touch = touch_of(r, m);
    bool room = true;
    for (int64_t i = 0; room && i < m->points; i++) {
        struct small_point *t = &m->point[i];
        if (small_point_holds(t) && (t->fresh || !(t->area > 0)))
            room = add_due(y, m, (struct small_due){ meeting, -1, i });
        else if (due > 0 && touches_at(t, touch))
            room = add_due(y, m, (struct small_due){ meeting, i, -1 });
        y->any |= small_point_holds(t) && !(t->area > 0);
    }
    return room;
}

/* A new bond of the meeting, whose feature is below all others'; NULL when memory is short */
static struct small_point *add_bond(struct small_meeting *m)
{
    int32_t least = 0;
    if (!array_grow(&m->point, &m->room, m->points + 1, sizeof *m->point)) return NULL;
    for (int64_t i = 0; i < m->points; i++)
        if (m->point[i].feature < least) least = m->point[i].feature;
    struct small_point *t = &m->point[m->points++];
    *t = (struct small_point){ .feature = least > INT32_MIN ? least - 1 : least };
    return t;
}

/* Bond t has its place where `found` is, and the reaction and all of the past that this has. */
static void place_bond(const struct small_run *r, const struct small_meeting *m,
                       struct small_point *t, struct small_point *found, double area)
{
    const struct contact c = contact_at(m, found);
    const struct small_point bond = *t;
    struct pose of[2];
    struct bond b;
    poses_of(r, m, of), bond_anchor_at(&b, &c, area, of);
    *t = *found;
    t->feature = bond.feature, t->fresh = true, t->area = area;
    t->from = has_places(r, m) ? 0 : found->feature + 1;
    t->at[0] = b.at_a, t->at[1] = b.at_b, t->axis = b.axis;
    memset(t->spring, 0, sizeof t->spring);
    t->spring[SPRING_BETA] = beta_due(r, m), t->spring[SPRING_HELD] = 1;
    t->there = t->near = true, t->e[0] = t->e[1] = 0;
    small_anchor_stiff(r, m, t, t->W[0], t->W[4]);
    for (int k = 0; k < 3; k++) found->f[k] = found->sum[k] = found->m[k] = found->turned[k] = 0;
    found->pull = v3(0, 0, 0);
}

/* A bond of this interval shares its area with one more. */
static void share_area(const struct small_run *r, const struct small_meeting *m,
                       struct small_point *t, double area)
{
    const double beta = t->spring[SPRING_BETA];
    const double stored = beta * beta * small_bond_energy(t->spring, t->gap, r->h);
    if (t->area > 0) t->spring[SPRING_GIVEN] += (1 - area / t->area) * stored;
    t->area = area;
    small_anchor_stiff(r, m, t, t->W[0], t->W[4]);
}

static bool make_due(const struct small_run *r, const struct small_due *due, double among)
{
    struct small_meeting *m = &r->l->meetings.of[due->meeting];
    const double area = small_stiff_area(r->p, m->key.a, m->key.b) / among;
    struct small_point *t = due->bond < 0 ? add_bond(m) : &m->point[due->bond];
    if (!t) return false;
    if (due->found >= 0)
        place_bond(r, m, t, &m->point[due->found], area);
    else if (area != t->area)
        share_area(r, m, t, area);
    return true;
}

static int by_feature(const void *x, const void *y)
{
    const struct small_point *s = x, *t = y;
    return s->feature < t->feature ? -1 : s->feature > t->feature;
}

void small_anchors_make(struct small_run *r)
{
    struct small_meetings *all = &r->l->meetings;
    struct small_dues *y = r->shapes.dues;
    struct failure failure = { 0 };
    const struct packing here = small_points_packing(r);
    if (!y) y = r->shapes.dues = calloc(1, sizeof *y);
    bool room = y != NULL;
    if (y) y->places.n = 0, y->any = false;
    for (int64_t i = 0; room && i < all->n; i++) room = gather_dues(r, y, i);
    if (room && y->any) {
        room = !attraction_share(y->of, &y->places, &here, &failure);
        for (int64_t i = 0; room && i < y->places.n; i++)
            room = make_due(r, &y->due[i], y->of[i].bonds);
        for (int64_t i = 0; room && i < y->places.n; i++) {
            struct small_meeting *m = &all->of[y->due[i].meeting];
            if (i && y->due[i].meeting == y->due[i - 1].meeting) continue;
            qsort(m->point, (size_t)m->points, sizeof *m->point, by_feature);
            hide_points(r, m);
        }
    }
    if (!room) r->lost = r->stop = true;
}

/* ---- from the packing, and back ---- */

bool small_anchor_recall(const struct small_run *r, struct small_meeting *m, const struct bond *b)
{
    struct small_point *t = NULL;
    const bool placed = bond_anchored(b);
    for (int64_t i = 0; i < m->points && placed; i++)
        if (m->point[i].feature == b->feature) t = &m->point[i];
    if (!t && !(t = add_bond(m))) return false;
    if (placed) {
        t->feature = b->feature, t->area = b->area;
        t->at[0] = b->at_a, t->at[1] = b->at_b, t->axis = b->axis;
    } else {
        t->from = b->feature + 1;
    }
    t->gap = b->gap, t->n = b->n;
    small_array(t->spring + SPRING_X, b->slip);
    t->spring[SPRING_BETA] = b->beta, t->spring[SPRING_HELD] = 1;
    small_anchor_stiff(r, m, t, 1, 1);
    qsort(m->point, (size_t)m->points, sizeof *m->point, by_feature);
    return true;
}

bool small_anchor_keep(const struct small_run *r, const struct small_meeting *m,
                       const struct small_point *t, struct bond *b)
{
    double x[SPRING_COUNT];
    if (!(t->spring[SPRING_HELD] > 0) || (!has_places(r, m) && !t->from)) return false;
    memcpy(x, t->spring, sizeof x);
    if (small_point_holds(t) && t->there) stretch(r, m, t, r->l->s.body, x);
    b->gap = t->gap, b->n = t->n, b->slip = small_vec(x + SPRING_X);
    b->beta = x[SPRING_BETA];
    if (!(b->beta > 0)) b->slip = v3(0, 0, 0);
    if (!has_places(r, m)) return true;
    b->area = t->area, b->at_a = t->at[0], b->at_b = t->at[1], b->axis = t->axis;
    return true;
}
