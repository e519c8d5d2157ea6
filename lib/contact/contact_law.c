/* contact/contact_law.c: ties made, followed over a step, and kept [contact/contact_law.h]. */
#include "contact/contact_law.h"

#include "contact/bond_anchor.h"
#include "contact/spring.h"
#include "state/attraction.h"
#include "state/freedom.h"
#include "state/kinematics.h"
#include "state/offset.h"

#include <float.h>
#include <stdlib.h>

void friction_choose(struct contacts *s, const struct packing *p)
{
    vec3 edge[3];
    const double ahead = step_ahead(p);
    if (!packing_sticks(p)) return;
    cell_predict(&p->cell, ahead, edge);
    for (int64_t i = 0; i < s->n; i++) {
        struct contact *c = &s->c[i];
        const int32_t k = packing_pair(p, c->a, c->b);
        if (p->mu_s[k] > c->mu && sliding_of(p, c, ahead, edge) <= p->v_s[k]) c->mu = p->mu_s[k];
    }
}

static const double TOUCH = 1e-6;      /* radii: pairs not further apart touch; it is rounding */
static const double LEAST_BETA = 1e-3; /* bonds of less are broken */
static const double MARGIN = 0.05;     /* radii: by which a step may miss the gap that it expects */

static const struct pair_law *law_of(const struct packing *p, const struct contact *c)
{
    return &p->law[packing_pair(p, c->a, c->b)];
}

double contact_laws_touch(const struct packing *p, const struct contact *c)
{
    return TOUCH * packing_smaller_radius(p, c);
}

double contact_laws_touch_most(const struct packing *p)
{
    return TOUCH * packing_whole(p).large;
}

/* m: of a liquid bridge */
static double bridge_size(const struct packing *p, const struct contact *c)
{
    return bridge_radius(c->a < 0 ? 0 : p->radius[c->a], p->radius[c->b]);
}

double contact_laws_area(const struct packing *p, const struct contact *c)
{
    const struct pair_law *l = law_of(p, c);
    double r = packing_smaller_radius(p, c);
    return l->area > 0 ? l->area : p->dim == 2 ? 2 * r : M_PI * r * r;
}

double contact_laws_reach(const struct packing *p)
{
    const struct whole all = packing_whole(p);
    double reach = 0;
    for (int32_t k = 0; k < p->materials * p->materials; k++)
        reach = fmax(reach,
                     fmax(p->law[k].cohesion > 0 ? p->law[k].range : 0, bridge_reach(&p->law[k])));
    if (all.apart > -INFINITY) reach = fmax(reach, all.apart + MARGIN * all.small);
    return fmax(reach, contact_laws_touch_most(p));
}

bool contact_laws_bond(const struct packing *p, const struct pair_law *l)
{
    const double end = p->t + p->dt, rounding = 4 * DBL_EPSILON; // of times, relative
    if (!pair_law_adheres(l)) return false;
    return l->forever ||
           (p->t - 2 * rounding * fabs(p->t) <= l->made && l->made < end - rounding * fabs(end));
}

/* Is a pair to be bonded in this step if it touches? Not one that is, or whose bond has broken and that has not parted
   since. old: what lasts of the contact, or NULL; broken: bonds_broken() */
static bool contact_law_is_due(const struct packing *p, const struct contact *c,
                               const struct bond *old, bool broken)
{
    const struct pair_law *l = law_of(p, c);
    if (!contact_laws_bond(p, l) || (old && old->beta > 0)) return false;
    bool parted = !old || (old->wet && old->gap > contact_laws_touch(p, c));
    return !l->forever || (parted && !broken);
}

/* Beta and the jump of a bond that there is, or that is made in this step */
static void contact_law_set_bond(struct contact_law *t, const struct packing *p, struct contact *c,
                                 const struct bond *old, const struct attraction *of)
{
    const struct pair_law *l = law_of(p, c);
    const bool due = contact_law_is_due(p, c, old, of->broken);
    if (due && c->gap <= contact_laws_touch(p, c)) {
        t->beta = l->beta, t->state |= CONTACT_LAW_BONDED;
    } else if (due) {
        if (l->beta > 0) c->en = c->et = 0; // nothing rebounds that is bonded where it touches
    } else if (old && (old->beta > 0 || l->forever)) {
        vec3 slip = v3_turn_along(old->n, c->n, old->slip);
        t->beta = old->beta, t->state |= CONTACT_LAW_BONDED;
        t->jump[1] = v3_dot(slip, c->t1), t->jump[2] = v3_dot(slip, contact_t2(c));
    }
    if (!(t->beta > 0)) return;
    double area = old && bond_anchored(old) ? old->area : contact_laws_area(p, c) / of->bonds;
    double S = area * t->beta * t->beta;
    t->stiff[0] = S * l->cn, t->stiff[1] = S * l->ct;
}

/* m/s: an impact that rebounds waits for the bodies to touch */
static double offset_apart(const struct packing *p, const struct contact *c)
{
    double approach = -opening_of(p, c, step_ahead(p));
    bool impact = c->en > 0 && approach > freedoms_calm(p);
    return c->gap / p->dt + (impact ? 2 * approach : 0);
}

/* Does one surface push the other? */
static bool contact_law_pushes(const struct packing *p, const struct contact_law *t,
                               const struct found *f)
{
    double push[3];
    contact_law_push(p->dt, t, f, push);
    return push[0] > 0;
}

/* N: of cohesion and, where the contact is wet, liquid, were the place the only one of its pair */
static double whole_pull(const struct packing *p, const struct contact *c, const struct pair_law *l,
                         bool wet)
{
    double f =
        l->cohesion > 0 && c->gap <= fmax(l->range, contact_laws_touch(p, c)) ? l->cohesion : 0;
    return wet ? f + bridge_force(l, bridge_size(p, c), c->gap) : f;
}

static bool is_wet(const struct packing *p, const struct contact *c, const struct pair_law *l,
                   const struct bond *old)
{
    bool touches = c->gap <= contact_laws_touch(p, c);
    return pair_law_wets(l) && (touches || (old && old->wet && c->gap < bridge_reach(l)));
}

void contact_laws_rolling(const struct packing *p, int32_t a, int32_t b, double *mu_r, double *mu_p)
{
    const double r = p->radius[b], R = a < 0 ? r : r * p->radius[a] / (r + p->radius[a]);
    const struct pair_law *l = p->law ? &p->law[packing_pair(p, a, b)] : NULL;
    *mu_r = l ? l->mu_r : 0, *mu_p = l ? l->mu_p : 0;
    if (l && l->mu_r_ratio > 0) *mu_r += l->mu_r_ratio * R;
    if (l && l->mu_p_ratio > 0) *mu_p += l->mu_p_ratio * R;
}

static void set_tie(struct contact_law *t, const struct packing *p, struct contact *c,
                    const struct bond *old, const struct attraction *of)
{
    const struct pair_law *l = law_of(p, c);
    bool wet = is_wet(p, c, l, old);
    t->jump[0] = fmax(0, c->gap);
    contact_laws_rolling(p, c->a, c->b, &t->mu_r, &t->mu_p);
    if (wet)
        t->state |= old && old->wet == BOND_WET ? CONTACT_LAW_WET
                                                : CONTACT_LAW_WET | CONTACT_LAW_NEW_BRIDGE;
    t->pull = whole_pull(p, c, l, wet) / of->among;
    if (pair_law_adheres(l)) contact_law_set_bond(t, p, c, old, of);
    const bool soft = pair_law_springs(l) && !(t->beta > 0);
    if (contact_law_holds(t) && c->gap > 0 && !soft) t->offset = offset_apart(p, c);
    if (t->beta > 0 || t->offset > 0) c->en = c->et = 0;
    c->mu *= 1 - t->beta;
    spring_set(t, p, c, old);
}

/* Are both contacts of the same two bodies? */
static bool is_of_pair(const struct contact *c, const struct contact *d)
{
    return c->a == d->a && c->b == d->b;
}

/* Is the bond of a pair that comes before the contact's? */
static bool contact_law_comes_before(const struct bond *x, const struct contact *c)
{
    return x->a < c->a || (x->a == c->a && x->b < c->b);
}

/* What of contact c counts where it shares with others; pair: where the bonds of its pair begin */
static struct attraction attraction_of(const struct packing *p, const struct contact *c,
                                       const struct bond *old, int64_t pair)
{
    const struct pair_law *l = law_of(p, c);
    const bool shaped = contact_shaped(p, c), anchored = old && bond_anchored(old);
    struct attraction t = { .tied = whole_pull(p, c, l, is_wet(p, c, l, old)) > 0 };
    if (shaped) t.broken = bonds_broken(&p->bonds, c->a, c->b, pair);
    if (!pair_law_adheres(l) || anchored) return t;
    t.bonded =
        c->gap <= contact_laws_touch(p, c) && (shaped || contact_law_is_due(p, c, old, false));
    t.bonded = t.bonded || (!shaped && old && old->beta > 0);
    return t;
}

int contact_laws_find(struct contacts *s, const struct packing *p, struct failure *failure)
{
    struct attraction *of = malloc(((size_t)s->n + 1) * sizeof *of);
    if (!of || contacts_alloc_laws(s)) {
        free(of);
        return failure_set(failure, EX_SOFTWARE, "no memory for the ties");
    }
    for (int64_t i = 0, pair = 0, from = 0; i < s->n; i++) {
        const struct contact *c = &s->c[i];
        while (pair < p->bonds.n && contact_law_comes_before(&p->bonds.bond[pair], c)) pair++;
        of[i] = attraction_of(p, c, bonds_find(&p->bonds, c, &from), pair);
    }
    int64_t from = 0;
    if (!attraction_share(of, s, p, failure))
        for (int64_t i = 0; i < s->n; i++)
            set_tie(&s->law[i], p, &s->c[i], bonds_find(&p->bonds, &s->c[i], &from), &of[i]);
    free(of);
    return failure->status;
}

/* ---- over the step ---- */

/* m/s: u_n after the step, out of what the law has seen */
static double opening_after(const struct packing *p, const struct contact *c,
                            const struct contact_law *t, const struct found *found)
{
    if (t->offset > 0) return found->u[0] - t->offset;
    double before = opening_of(p, c, step_ahead(p));
    return (1 + c->en) * found->u[0] - c->en * before - offset_of(p, c, t, before);
}

static double damage(double h, const struct pair_law *l, double beta, double q)
{
    if (!(l->w < beta * q)) return beta;
    double left = fmin(beta, (h * l->w + l->eta * beta) / (h * q + l->eta));
    return left < LEAST_BETA ? 0 : left;
}

struct contact_law_end contact_law_end(const struct packing *p, const struct contact *c,
                                       const struct contact_law *t, const struct found *found,
                                       const double *moment)
{
    const struct pair_law *l = law_of(p, c);
    struct contact_law_end e = { .beta = t->beta };
    if (t->spring[0] > 0) {
        struct spring_end s = spring_end(p, c, t, found, opening_of(p, c, step_ahead(p)));
        e.gap = c->gap + p->dt * s.un;
        for (int k = 0; k < 3; k++) e.stretch[k] = s.stretch[k];
        if (moment) spring_turn_end(p->dt, t, moment, e.turn);
    } else {
        e.gap = c->gap + p->dt * opening_after(p, c, t, found);
    }
    e.wet = t->state & CONTACT_LAW_WET && e.gap < bridge_reach(l);
    for (int k = 0; k < 2 && t->beta > 0; k++) e.slip[k] = t->jump[1 + k] + p->dt * found->u[1 + k];
    double open = fmax(0, e.gap);
    double q = l->cn * open * open + l->ct * (e.slip[0] * e.slip[0] + e.slip[1] * e.slip[1]);
    e.beta = damage(p->dt, l, t->beta, q);
    return e;
}

/* J: of a constant pull */
static double cohesion_energy(const struct packing *p, const struct contact *c,
                              const struct pair_law *l, double gap)
{
    double range = fmax(l->range, contact_laws_touch(p, c));
    return gap < range ? -l->cohesion * (range - gap) : 0;
}

/* What of its pair's cohesion and liquid a contact has */
static double share_of(const struct packing *p, const struct contact *c, const struct pair_law *l,
                       const struct contact_law *t)
{
    double whole = whole_pull(p, c, l, t->state & CONTACT_LAW_WET);
    return whole > 0 ? t->pull / whole : 1;
}

/* J: of the bond, were its beta still the one it began with */
static double elastic_energy(const struct contact_law *t, double gap, double slip1, double slip2)
{
    double open = fmax(0, gap), slip = slip1 * slip1 + slip2 * slip2;
    return 0.5 * (t->stiff[0] * open * open + t->stiff[1] * slip);
}

struct contact_law_account contact_law_account(const struct packing *p, const struct contact *c,
                                               const struct contact_law *t,
                                               const struct contact_law_end *end)
{
    const struct pair_law *l = law_of(p, c);
    struct contact_law_account a = { 0 };
    double R = bridge_size(p, c), share = share_of(p, c, l, t);
    double before = share * cohesion_energy(p, c, l, c->gap);
    double after = share * cohesion_energy(p, c, l, end->gap);
    if (t->state & CONTACT_LAW_WET) {
        double bridge = share * bridge_energy(l, R, c->gap);
        if (t->state & CONTACT_LAW_NEW_BRIDGE)
            a.broken -= bridge;
        else
            before += bridge;
        after += share * bridge_energy(l, R, end->gap);
    }
    if (t->beta > 0) {
        double left = end->beta / t->beta;
        double stretched = elastic_energy(t, end->gap, end->slip[0], end->slip[1]);
        before += elastic_energy(t, c->gap, t->jump[1], t->jump[2]);
        after += left * left * stretched;
        a.broken += (1 - left * left) * stretched;
    }
    if (t->spring[0] > 0) {
        before += spring_energy(t, t->jump, t->turn);
        after += spring_energy(t, end->stretch, end->turn);
        a.implicit = spring_implicit(t, end->stretch, end->turn);
        a.rise = spring_rise(p, c, t, end->gap, end->stretch[0]), after += a.rise;
    }
    a.change = after - before, a.stored = after;
    return a;
}

/* rad: by which the pair turns about the contact's normal in the step */
static double spin_about(const struct packing *p, const struct contact *c)
{
    vec3 wa = c->a < 0 ? wall_spin(p, &p->wall[-1 - c->a]) : p->w[c->a];
    return 0.5 * p->dt * v3_dot(c->n, v3_add(wa, p->w[c->b]));
}

/* Bodies that push each other have touched, also if they rebound: what is made of their contact at the end of the step,
   which is none of what there has been */
struct made {
    bool wet, bonded;
};

/* pair: where the bonds of the contact's pair begin */
static struct made made_by_push(const struct packing *p, const struct contacts *s, int64_t i,
                                int64_t pair)
{
    const struct contact *c = &s->c[i];
    const struct contact_law *t = &s->law[i];
    const struct pair_law *l = law_of(p, c);
    const bool broken = contact_shaped(p, c) && bonds_broken(&p->bonds, c->a, c->b, pair);
    if (!pair_law_attracts(l) || !contact_law_pushes(p, t, &s->found[i]))
        return (struct made){ false, false };
    return (struct made){ .wet = pair_law_wets(l) && !(t->state & CONTACT_LAW_WET),
                          .bonded =
                              l->beta > 0 && !(t->state & CONTACT_LAW_BONDED) &&
                              contact_law_is_due(p, c, bonds_find(&p->bonds, c, &pair), broken) };
}

/* Is there a spring to be remembered: one that pushes, or that keeps the overlap of its pair out of the push? */
static bool contact_law_is_pressed(const struct packing *p, const struct contact *c,
                                   const struct contact_law *t, const struct found *found,
                                   const struct contact_law_end *end)
{
    if (!(t->spring[0] > 0)) return false;
    return contact_law_pushes(p, t, found) || (c->gap - t->jump[0] < 0 && end->gap < 0);
}

/* What lasts of contact i; false: nothing does. */
static bool bond_of(const struct packing *p, const struct contacts *s, int64_t i, struct made made,
                    struct bond *b)
{
    const struct contact *c = &s->c[i];
    const struct contact_law *t = &s->law[i];
    struct contact_law_end e =
        contact_law_end(p, c, t, &s->found[i], s->moment ? s->moment[i] : NULL);
    // A broken bond is remembered while the pair touches, for it is not made anew. An anchored one has no
    // contact of its own in the next step: remember_broken() sees whether its pair has parted.
    bool bonded = t->state & CONTACT_LAW_BONDED;
    bool rests = bonded && (e.gap <= contact_laws_touch(p, c) || contact_anchored(c));
    *b = (struct bond){ .a = c->a, .b = c->b, .feature = c->feature, .n = c->n };
    for (int k = 0; k < 3; k++) b->shift[k] = c->shift[k];
    b->pressed = contact_law_is_pressed(p, c, t, &s->found[i], &e);
    if (b->pressed) b->rest = spring_rest_after(p, c, t, e.gap, e.stretch[0]);
    if (b->pressed && law_of(p, c)->soft > 0) b->spring = t->spring[0];
    b->gap = e.gap, b->beta = made.bonded ? law_of(p, c)->beta : e.beta;
    b->wet = e.wet ? BOND_WET : made.wet && e.gap < bridge_reach(law_of(p, c)) ? BOND_WETTED : 0;
    if (!b->wet && !(b->beta > 0) && !rests && !b->pressed) return false;
    const double *across = b->pressed ? e.stretch + 1 : e.slip;
    vec3 slip = v3_axpy(v3_scale(across[0], c->t1), across[1], contact_t2(c));
    const quat spin = quat_rotation(v3_scale(spin_about(p, c), c->n));
    if (e.beta > 0 || b->pressed) b->slip = quat_turn(spin, slip);
    if (b->pressed && t->roll > 0) b->turn = quat_turn(spin, contact_in_space(c, e.turn));
    return true;
}

bool contact_law_carries(const struct pair_law *l, struct bond *b)
{
    if (!pair_law_wets(l)) b->wet = 0;
    if (!pair_law_springs(l)) b->pressed = 0, b->rest = 0, b->turn = v3(0, 0, 0);
    if (!pair_law_adheres(l)) b->beta = 0;
    return pair_law_adheres(l) || b->wet || b->pressed;
}

static int32_t lesser(int32_t x, int32_t y)
{
    return x < y ? x : y;
}

/* Has the contact's pair bond i of these? */
static bool contact_law_has_bond(const struct contact *c, const struct bonds *s, int64_t i)
{
    return i >= 0 && i < s->n && s->bond[i].a == c->a && s->bond[i].b == c->b;
}

/* The contacts of a step, where the bonds of the present one's pair begin, and what is kept so far */
struct contact_law_keeping {
    const struct packing *p;
    const struct contacts *s;
    int64_t pair, found; /* found: as of bonds_find() */
    struct bonds kept;
};

/* m^2: of the bond that contact i is when the step is over. All that are made of its pair by a push share one area. */
static double contact_law_area_of(const struct contact_law_keeping *y, int64_t i, struct made made)
{
    const struct contact *c = &y->s->c[i];
    const struct contact_law *t = &y->s->law[i];
    const struct pair_law *l = law_of(y->p, c);
    int64_t first = i, end = i + 1, n = 0;
    if (t->beta > 0) return t->stiff[0] / (l->cn * t->beta * t->beta);
    if (!made.bonded) return 0;
    while (first > 0 && is_of_pair(&y->s->c[first - 1], c)) first--;
    while (end < y->s->n && is_of_pair(&y->s->c[end], c)) end++;
    for (int64_t k = first; k < end; k++) n += made_by_push(y->p, y->s, k, y->pair).bonded;
    return contact_laws_area(y->p, c) / (double)n;
}

/* The place of a bond where there is a shape: that of the old one, or of contact i, with a new key, below
   all of its pair */
static void anchor(struct bond *b, struct contact_law_keeping *y, int64_t i, struct made made)
{
    const struct packing *p = y->p;
    const struct contact *c = &y->s->c[i];
    const struct bond *old = bonds_find(&p->bonds, c, &y->found);
    if (old && bond_anchored(old)) {
        b->area = old->area, b->at_a = old->at_a, b->at_b = old->at_b, b->axis = old->axis;
        return;
    }
    double area = contact_law_area_of(y, i, made);
    if (!(area > 0)) return;
    int32_t least = 0;
    if (contact_law_has_bond(c, &p->bonds, y->pair))
        least = lesser(least, p->bonds.bond[y->pair].feature);
    for (int64_t k = y->kept.n - 1; contact_law_has_bond(c, &y->kept, k); k--)
        least = lesser(least, y->kept.bond[k].feature);
    b->feature = least > INT32_MIN ? least - 1 : least;
    bond_anchor(b, p, c, area, step_ahead(p));
}

/* Adds the anchored bonds that broke in earlier steps, of pairs that have not parted since; false when
   memory is short. */
static bool remember_broken(struct bonds *kept, const struct packing *p, const struct contacts *s)
{
    bool good = true;
    int64_t c = 0;
    for (int64_t i = 0; good && i < p->bonds.n; i++) {
        const struct bond *b = &p->bonds.bond[i];
        if (!bond_anchored(b) || b->beta > 0 || b->wet) continue;
        while (c < s->n && (s->c[c].a < b->a || (s->c[c].a == b->a && s->c[c].b < b->b))) c++;
        bool together = false;
        for (int64_t k = c; k < s->n && s->c[k].a == b->a && s->c[k].b == b->b; k++)
            together = together || s->c[k].gap <= contact_laws_touch(p, &s->c[k]) ||
                       (s->law && s->law[k].beta > 0);
        if (together) good = bonds_add(kept, b) != NULL;
    }
    return good;
}

/* Keeps what lasts of contact i; false when memory is short. */
static bool contact_law_keep(struct contact_law_keeping *y, int64_t i)
{
    const struct contact *c = &y->s->c[i];
    const struct contact_law *t = &y->s->law[i];
    struct bond b;
    while (y->pair < y->p->bonds.n && contact_law_comes_before(&y->p->bonds.bond[y->pair], c))
        y->pair++;
    struct made made = made_by_push(y->p, y->s, i, y->pair);
    bool lasts = t->state & (CONTACT_LAW_WET | CONTACT_LAW_BONDED) || made.wet || made.bonded ||
                 t->spring[0] > 0;
    if (!lasts || !bond_of(y->p, y->s, i, made, &b)) return true;
    bool bonded =
        (t->state & CONTACT_LAW_BONDED && (t->beta > 0 || contact_anchored(c))) || made.bonded;
    if (contact_shaped(y->p, c) && bonded) anchor(&b, y, i, made);
    return bonds_add(&y->kept, &b) != NULL;
}

int contact_laws_keep(struct packing *p, const struct contacts *s, struct failure *failure)
{
    struct contact_law_keeping y = { .p = p, .s = s };
    bool good = true;
    for (int64_t i = 0; good && i < s->n && s->law && s->found; i++) good = contact_law_keep(&y, i);
    good = good && (!p->shape || remember_broken(&y.kept, p, s));
    if (!good) {
        bonds_free(&y.kept);
        return failure_set(failure, EX_SOFTWARE, "no memory for the bonds");
    }
    if (p->shape) bonds_sort(&y.kept);
    bonds_free(&p->bonds);
    p->bonds = y.kept;
    return 0;
}
