/* bodies/contact_law.c: ties made, followed over a step, and kept [bodies/contact_law.h]. */
#include "bodies/contact_law.h"

#include "bodies/anchor.h"
#include "bodies/freedom.h"
#include "bodies/kinematics.h"
#include "bodies/offset.h"

#include <stdlib.h>

static const double TOUCH = 1e-6;      /* radii: pairs not further apart touch; it is rounding */
static const double LEAST_BETA = 1e-3; /* bonds of less are broken */
static const double MARGIN = 0.05;     /* radii: by which a step may miss the gap that it expects */

static const struct pair_law *law_of(const struct packing *p, const struct contact *c)
{
    return &p->law[packing_pair(p, c->a, c->b)];
}

/* m: pairs with at most this gap touch */
static double touch_of(const struct packing *p, const struct contact *c)
{
    return TOUCH * packing_smaller_radius(p, c);
}

/* m: of a liquid bridge */
static double bridge_size(const struct packing *p, const struct contact *c)
{
    return bridge_radius(c->a < 0 ? 0 : p->radius[c->a], p->radius[c->b]);
}

/* m^2: of a bond, of all places of a pair together; discs are 1 m deep */
static double bond_area(const struct packing *p, const struct contact *c, const struct pair_law *l)
{
    double r = packing_smaller_radius(p, c);
    return l->area > 0 ? l->area : p->dim == 2 ? 2 * r : M_PI * r * r;
}

double contact_laws_reach(const struct packing *p)
{
    const struct whole all = packing_whole(p);
    double reach = 0;
    for (int32_t k = 0; k < p->kinds * p->kinds; k++)
        reach = fmax(reach,
                     fmax(p->law[k].cohesion > 0 ? p->law[k].range : 0, bridge_reach(&p->law[k])));
    if (all.apart > -INFINITY) reach = fmax(reach, all.apart + MARGIN * all.small);
    return fmax(reach, TOUCH * all.large);
}

/* The rotation that takes the unit vector `from` to `to` the short way, of a vector across `from` */
static vec3 turn_along(vec3 from, vec3 to, vec3 x)
{
    vec3 axis = v3_cross(from, to);
    double c = v3_dot(from, to);
    if (!(c > -0.999)) return v3(0, 0, 0); // the pair has been passed: nothing of the shear is left
    // Rodrigues: x + axis x x + axis x (axis x x)/(1 + c)
    vec3 y = v3_cross(axis, x);
    return v3_axpy(v3_add(x, y), 1 / (1 + c), v3_cross(axis, y));
}

/* What a pair shares among the places where it meets; of balls, one each */
struct places {
    double touching, tied; /* that touch; that cohesion or liquid holds */
    bool broken;           /* a bond of the pair has broken, and it has not parted since */
};

/* Beta and the jump of a bond that there is, or that is made in this step */
static void set_bond(struct contact_law *t, const struct packing *p, const struct contact *c,
                     const struct bond *old, const struct places *of)
{
    const struct pair_law *l = law_of(p, c);
    bool touches = c->gap <= touch_of(p, c);
    bool due = fabs(p->t - l->made) < 0.5 * p->dt && !(old && old->beta > 0);
    if (touches && (l->forever ? !old && !of->broken : due)) {
        t->beta = l->beta, t->state |= CONTACT_LAW_BONDED;
    } else if (old && (old->beta > 0 || l->forever)) {
        vec3 slip = turn_along(old->n, c->n, old->slip);
        t->beta = old->beta, t->state |= CONTACT_LAW_BONDED;
        t->jump[1] = v3_dot(slip, c->t1), t->jump[2] = v3_dot(slip, contact_t2(c));
    }
    if (!(t->beta > 0)) return;
    double area = old && bond_anchored(old) ? old->area : bond_area(p, c, l) / of->touching;
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

/* N: of cohesion and, where the contact is wet, liquid, were the place the only one of its pair */
static double whole_pull(const struct packing *p, const struct contact *c, const struct pair_law *l,
                         bool wet)
{
    double f = l->cohesion > 0 && c->gap <= fmax(l->range, touch_of(p, c)) ? l->cohesion : 0;
    return wet ? f + bridge_force(l, bridge_size(p, c), c->gap) : f;
}

static bool is_wet(const struct packing *p, const struct contact *c, const struct pair_law *l,
                   const struct bond *old)
{
    bool touches = c->gap <= touch_of(p, c);
    return pair_law_wets(l) && (touches || (old && old->wet && c->gap < bridge_reach(l)));
}

static void set_tie(struct contact_law *t, const struct packing *p, struct contact *c,
                    const struct bond *old, const struct places *of)
{
    const struct pair_law *l = law_of(p, c);
    bool wet = is_wet(p, c, l, old);
    t->jump[0] = fmax(0, c->gap);
    t->mu_r = l->mu_r, t->mu_p = l->mu_p;
    if (wet) t->state |= old && old->wet ? CONTACT_LAW_WET : CONTACT_LAW_WET | TIE_NEW_BRIDGE;
    t->pull = whole_pull(p, c, l, wet) / of->tied;
    if (pair_law_adheres(l)) set_bond(t, p, c, old, of);
    if (contact_law_holds(t) && c->gap > 0) t->offset = offset_apart(p, c);
    if (t->beta > 0 || t->offset > 0) c->en = c->et = 0;
    c->mu *= 1 - t->beta;
}

/* The end of the contacts of one pair that begin at `first` */
static int64_t end_of_pair(const struct contacts *s, int64_t first)
{
    int64_t i = first + 1;
    while (i < s->n && s->c[i].a == s->c[first].a && s->c[i].b == s->c[first].b) i++;
    return i;
}

/* Of the contacts first .. end-1 of a pair of which one is no ball; from: as of bonds_find() */
static struct places count_places(const struct contacts *s, const struct packing *p, int64_t first,
                                  int64_t end, int64_t from)
{
    struct places of = { 0, 0, bonds_broken(&p->bonds, s->c[first].a, s->c[first].b, from) };
    for (int64_t i = first; i < end; i++) {
        const struct contact *c = &s->c[i];
        const struct pair_law *l = law_of(p, c);
        const struct bond *old = bonds_find(&p->bonds, c, &from);
        of.touching += c->gap <= touch_of(p, c) && !(old && bond_anchored(old));
        of.tied += whole_pull(p, c, l, is_wet(p, c, l, old)) > 0;
    }
    of.touching = fmax(of.touching, 1), of.tied = fmax(of.tied, 1);
    return of;
}

int contact_laws_find(struct contacts *s, const struct packing *p, struct why *why)
{
    int64_t from = 0;
    if (contacts_alloc_laws(s)) return why_set(why, EX_SOFTWARE, "no memory for the ties");
    for (int64_t i = 0, end; i < s->n; i = end) {
        struct places of = { 1, 1, false };
        end = contact_shaped(p, &s->c[i]) ? end_of_pair(s, i) : i + 1;
        if (contact_shaped(p, &s->c[i])) of = count_places(s, p, i, end, from);
        for (int64_t k = i; k < end; k++)
            set_tie(&s->law[k], p, &s->c[k], bonds_find(&p->bonds, &s->c[k], &from), &of);
    }
    return 0;
}

/* ---- over the step ---- */

/* m/s: u_n after the step, out of what the law has seen */
static double opening_after(const struct packing *p, const struct contact *c,
                            const struct contact_law *t, const struct found *found)
{
    if (t->offset > 0) return found->u[0] - t->offset;
    double before = opening_of(p, c, step_ahead(p));
    return (1 + c->en) * found->u[0] - c->en * before - offset_of(p, c, before);
}

static double damage(double h, const struct pair_law *l, double beta, double q)
{
    if (!(l->w < beta * q)) return beta;
    double left = fmin(beta, (h * l->w + l->eta * beta) / (h * q + l->eta));
    return left < LEAST_BETA ? 0 : left;
}

struct contact_law_end contact_law_end(const struct packing *p, const struct contact *c,
                                       const struct contact_law *t, const struct found *found)
{
    const struct pair_law *l = law_of(p, c);
    struct contact_law_end e = { .gap = c->gap + p->dt * opening_after(p, c, t, found),
                                 .beta = t->beta };
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
    double range = fmax(l->range, touch_of(p, c));
    return gap < range ? -l->cohesion * (range - gap) : 0;
}

/* What of its pair's cohesion and liquid a contact has */
static double share_of(const struct packing *p, const struct contact *c, const struct pair_law *l,
                       const struct contact_law *t)
{
    if (!(t->pull > 0) || !contact_shaped(p, c)) return 1;
    return t->pull / whole_pull(p, c, l, t->state & CONTACT_LAW_WET);
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
        if (t->state & TIE_NEW_BRIDGE)
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
    a.change = after - before, a.stored = after;
    return a;
}

/* rad: by which the pair turns about the contact's normal in the step */
static double spin_about(const struct packing *p, const struct contact *c)
{
    vec3 wa = c->a < 0 ? wall_spin(p, &p->wall[-1 - c->a]) : p->w[c->a];
    return 0.5 * p->dt * v3_dot(c->n, v3_add(wa, p->w[c->b]));
}

/* What lasts of contact i, whose tie is wet or bonded; false: nothing does. */
static bool bond_of(const struct packing *p, const struct contacts *s, int64_t i, struct bond *b)
{
    const struct contact *c = &s->c[i];
    const struct contact_law *t = &s->law[i];
    struct contact_law_end e = contact_law_end(p, c, t, &s->found[i]);
    // A broken bond is remembered while the pair touches, for it is not made anew. An anchored one has no
    // contact of its own in the next step: remember_broken() sees whether its pair has parted.
    bool bonded = t->state & CONTACT_LAW_BONDED;
    bool rests = bonded && (e.gap <= touch_of(p, c) || contact_anchored(c));
    if (!e.wet && !(e.beta > 0) && !rests) return false;
    *b = (struct bond){ .a = c->a, .b = c->b, .feature = c->feature, .n = c->n };
    for (int k = 0; k < 3; k++) b->shift[k] = c->shift[k];
    b->wet = e.wet, b->beta = e.beta, b->gap = e.gap;
    vec3 slip = v3_axpy(v3_scale(e.slip[0], c->t1), e.slip[1], contact_t2(c));
    if (e.beta > 0) b->slip = quat_turn(quat_rotation(v3_scale(spin_about(p, c), c->n)), slip);
    return true;
}

static int32_t lesser(int32_t x, int32_t y)
{
    return x < y ? x : y;
}

/* Has the contact's pair bond i of these? */
static bool has_bond(const struct contact *c, const struct bonds *s, int64_t i)
{
    return i >= 0 && i < s->n && s->bond[i].a == c->a && s->bond[i].b == c->b;
}

/* The place of a bond where there is a shape: that of the old one, or of this contact, with a new key, below
   all of its pair. *found: as of bonds_find() */
static void anchor(struct bond *b, const struct packing *p, const struct contacts *s, int64_t i,
                   int64_t *found, const struct bonds *kept)
{
    const struct contact *c = &s->c[i];
    const struct contact_law *t = &s->law[i];
    const struct bond *old = bonds_find(&p->bonds, c, found);
    int64_t from = *found;
    if (old && bond_anchored(old)) {
        b->area = old->area, b->at_a = old->at_a, b->at_b = old->at_b, b->axis = old->axis;
        return;
    }
    if (!(t->beta > 0)) return;
    int32_t least = 0;
    while (has_bond(c, &p->bonds, from - 1)) from--;
    if (has_bond(c, &p->bonds, from)) least = lesser(least, p->bonds.bond[from].feature);
    for (int64_t k = kept->n - 1; has_bond(c, kept, k); k--)
        least = lesser(least, kept->bond[k].feature);
    b->feature = least > INT32_MIN ? least - 1 : least;
    anchor_bond(b, p, c, t->stiff[0] / (law_of(p, c)->cn * t->beta * t->beta));
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
            together =
                together || s->c[k].gap <= touch_of(p, &s->c[k]) || (s->law && s->law[k].beta > 0);
        if (together) good = bonds_add(kept, b) != NULL;
    }
    return good;
}

int contact_laws_keep(struct packing *p, const struct contacts *s, struct why *why)
{
    struct bonds kept = { 0 };
    bool good = true;
    int64_t from = 0;
    for (int64_t i = 0; good && i < s->n && s->law; i++) {
        const struct contact *c = &s->c[i];
        struct bond b;
        if (!(s->law[i].state & (CONTACT_LAW_WET | CONTACT_LAW_BONDED)) || !bond_of(p, s, i, &b))
            continue;
        bool bonded =
            s->law[i].state & CONTACT_LAW_BONDED && (s->law[i].beta > 0 || contact_anchored(c));
        if (contact_shaped(p, c) && bonded) anchor(&b, p, s, i, &from, &kept);
        good = bonds_add(&kept, &b) != NULL;
    }
    good = good && (!p->shape || remember_broken(&kept, p, s));
    if (!good) {
        bonds_free(&kept);
        return why_set(why, EX_SOFTWARE, "no memory for the bonds");
    }
    if (p->shape) bonds_sort(&kept);
    bonds_free(&p->bonds);
    p->bonds = kept;
    return 0;
}
