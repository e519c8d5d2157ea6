#include "contact/touching.h"

#include "contact/bond_anchor.h"
#include "contact/contact_law.h"
#include "contact/detect.h"
#include "state/kinematics.h"

#include <math.h>

/* Whether pairs with this law are bonded, and have liquid, if they touch where the step begins. Later than in the first
   step what is made whenever bodies meet has been made. */
struct wish {
    bool bonds, wets;
};

static struct wish wish_of(const struct packing *p, const struct pair_law *l)
{
    const bool first = p->step == 0;
    return (struct wish){ contact_laws_bond(p, l) && l->beta > 0 && (first || !l->forever),
                          first && pair_law_wets(l) };
}

static bool wishes_any(const struct packing *p)
{
    bool any = false;
    for (int32_t k = 0; p->law && k < p->materials * p->materials && !any; k++) {
        const struct wish wish = wish_of(p, &p->law[k]);
        any = wish.bonds || wish.wets;
    }
    return any;
}

/* Contacts where the step begins and where it is predicted, in order */
struct two_places {
    struct packing *p;
    struct contacts now, then;
};

static bool touching_touches(const struct packing *p, const struct contact *c)
{
    return c->gap <= contact_laws_touch(p, c);
}

/* Of contacts first .. end-1 of one pair: how many touch; 0 where all of them still do at the predicted positions.
   *then: where to look there from on */
static int64_t count_new(const struct two_places *y, int64_t first, int64_t end, int64_t *then)
{
    int64_t n = 0;
    bool parts = false;
    for (int64_t i = first; i < end; i++) {
        const struct contact *c = &y->now.c[i], *d = y->then.c;
        if (!touching_touches(y->p, c)) continue;
        while (*then < y->then.n && contact_compare(&d[*then], c) < 0) ++*then;
        bool there = *then < y->then.n && !contact_compare(&d[*then], c);
        parts = parts || !there || !touching_touches(y->p, &d[*then]);
        n++;
    }
    return parts ? n : 0;
}

/* m: the gap at the predicted positions, of balls */
static double gap_ahead(const struct packing *p, const struct contact *c)
{
    const double ahead = step_ahead(p);
    if (c->a < 0) return c->gap + ahead * opening_of(p, c, 0);
    vec3 d = v3_sub(v3_add(p->x[c->b], cell_shift(p->cell.edge, c->shift)), p->x[c->a]);
    vec3 u = v3_sub(v3_add(p->v[c->b], cell_shift(p->cell.rate, c->shift)), p->v[c->a]);
    return c->gap + v3_norm(v3_axpy(d, ahead, u)) - v3_norm(d);
}

/* The first of n rows, which are sorted, whose key is not below this one */
static int64_t find_row(const struct bonds *s, int64_t n, struct contact_key key)
{
    int64_t lo = 0, hi = n;
    while (lo < hi) {
        int64_t middle = lo + (hi - lo) / 2;
        if (contact_key_order(bond_key(&s->bond[middle]), key) < 0)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo;
}

/* Has a contact's pair a bond that holds, or is remembered as broken? */
static bool touching_has_bond(const struct bonds *s, int64_t n, const struct contact *c)
{
    struct contact_key first = { c->a, c->b, INT32_MIN, { INT8_MIN, INT8_MIN, INT8_MIN } };
    bool has = false;
    for (int64_t i = find_row(s, n, first); i < n && !has; i++) {
        const struct bond *b = &s->bond[i];
        if (b->a != c->a || b->b != c->b) break;
        has = b->beta > 0 || !b->wet;
    }
    return has;
}

/* Bonds contact c, one of n of its pair, as the laws would. rows: bonds that were there before; key: of an anchored one */
static bool bond(struct packing *p, const struct contact *c, int64_t n, int64_t rows, int32_t key)
{
    const struct pair_law *l = &p->law[packing_pair(p, c->a, c->b)];
    const struct wish wish = wish_of(p, l);
    struct bond new = { .a = c->a, .b = c->b, .feature = c->feature, .n = c->n };
    const int64_t at = find_row(&p->bonds, rows, contact_key(c));
    struct bond *row = at < rows ? &p->bonds.bond[at] : NULL;
    if (row && contact_key_order(bond_key(row), contact_key(c)) != 0) row = NULL;
    bool bonds = wish.bonds && !touching_has_bond(&p->bonds, rows, c);
    for (int k = 0; k < 3; k++) new.shift[k] = c->shift[k];
    if (row) new = *row;
    if (wish.wets && !new.wet) new.wet = BOND_WETTED;
    if (bonds) new.beta = l->beta;
    if (contact_shaped(p, c) && bonds)
        bond_anchor(&new, p, c, contact_laws_area(p, c) / (double)n, 0), new.feature = key;
    new.gap = contact_shaped(p, c) ? c->gap : gap_ahead(p, c);
    if (!new.wet && !bonds) return true;
    if (row) *row = new;
    return row || bonds_add(&p->bonds, &new);
}

static bool bond_all(struct two_places *y)
{
    const int64_t rows = y->p->bonds.n;
    bool good = true;
    for (int64_t i = 0, end, then = 0; good && i < y->now.n; i = end) {
        const struct contact *c = &y->now.c[i];
        end = i + 1;
        while (contact_shaped(y->p, c) && end < y->now.n && y->now.c[end].a == c->a &&
               y->now.c[end].b == c->b)
            end++;
        int64_t n = count_new(y, i, end, &then);
        int32_t key = 0;
        for (int64_t k = i; n && good && k < end; k++)
            if (touching_touches(y->p, &y->now.c[k]))
                good = bond(y->p, &y->now.c[k], n, rows, --key);
    }
    bonds_sort(&y->p->bonds);
    return good;
}

int touching_bond(struct packing *p, struct failure *failure)
{
    struct two_places y = { p, { 0 }, { 0 } };
    if (!wishes_any(p)) return 0;
    const double reach = contact_laws_touch_most(p);
    if (!detect_contacts_at(&y.now, p, p->x, p->t, reach, failure) &&
        !detect_near(&y.then, p, reach, NULL, failure) && !bond_all(&y))
        failure_set(failure, EX_SOFTWARE, "no memory for the bonds");
    contacts_free(&y.now), contacts_free(&y.then);
    return failure->status;
}
