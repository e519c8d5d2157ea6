/* contact/bond_anchor.c: bonds as contacts of a step [contact/bond_anchor.h]. */
#include "contact/bond_anchor.h"

#include "state/kinematics.h"
#include "state/rotation.h"

#include <stdlib.h>

static const double NEAR = 0.2; /* smaller radii: closer contacts are where the bond is */

/* The image of a place on a wall that is nearest to x (m): a wall goes on where the cell repeats,
   and b, whom it has carried out of the cell, has come in again on the other side. */
static vec3 nearest_image(const struct cell *cell, const vec3 edge[3], vec3 at, vec3 x)
{
    vec3 inverse[3], way = v3_sub(x, at);
    if (!cell_repeats(cell)) return at;
    cell_inverse(edge, inverse);
    for (int k = 0; k < 3; k++) {
        double edges = cell->repeats[k] ? floor(v3_dot(inverse[k], way) + 0.5) : 0;
        if (edges != 0) at = v3_axpy(at, edges, edge[k]);
    }
    return at;
}

/* The contact of bond b; at->q has no half step of balls, whose turning is constant. */
static struct contact bond_anchor_place(const struct packing *p, const struct bond *b,
                                        const struct positions *at)
{
    const vec3 *x = at->x;
    const quat *q = at->q;
    struct contact c = { .a = b->a, .b = b->b, .feature = b->feature };
    quat qb = packing_shape(p, b->b) ? q[b->b] : rotation_predict(p, b->b);
    vec3 xb = v3_add(v3_add(x[b->b], cell_shift(at->edge, b->shift)), quat_turn(qb, b->at_b)), xa;
    if (b->a < 0) {
        const struct pose pose = wall_pose(p, &p->wall[-1 - b->a], at->t);
        xa = nearest_image(&p->cell, at->edge, pose_of(&pose, b->at_a), xb);
    } else {
        quat qa = packing_shape(p, b->a) ? q[b->a] : rotation_predict(p, b->a);
        xa = v3_add(x[b->a], quat_turn(qa, b->at_a));
    }
    for (int k = 0; k < 3; k++) c.shift[k] = b->shift[k];
    vec3 n = quat_turn(qb, b->axis);
    if (p->dim == 2) n.z = 0;
    contact_basis(&c, p->dim, v3_scale(1 / v3_norm(n), n));
    c.x = v3_scale(0.5, v3_add(xa, xb)), c.gap = v3_dot(c.n, v3_sub(xb, xa));
    packing_set_law(p, &c);
    return c;
}

/* Is the contact where one of these is, which are sorted? *from: where its pair's begin */
static bool is_taken(const struct packing *p, const struct contact *c, const struct contact *of,
                     int64_t n, int64_t *from)
{
    while (*from < n && (of[*from].a < c->a || (of[*from].a == c->a && of[*from].b < c->b)))
        ++*from;
    double near = NEAR * packing_smaller_radius(p, c);
    for (int64_t i = *from; i < n && of[i].a == c->a && of[i].b == c->b; i++) {
        vec3 d = v3_sub(of[i].x, c->x);
        bool same = true;
        for (int k = 0; k < 3; k++) same = same && of[i].shift[k] == c->shift[k];
        if (same && v3_dot(d, d) <= near * near) return true;
    }
    return false;
}

/* to = both, in order; those of s that are taken left out. False when memory is short. */
static bool bond_anchor_merge(struct contacts *to, const struct packing *p,
                              const struct contacts *s, const struct contact *placed, int64_t n)
{
    int64_t next = 0, from = 0;
    bool good = true;
    for (int64_t i = 0; good && i <= s->n; i++) {
        for (; good && next < n && (i == s->n || contact_compare(&placed[next], &s->c[i]) < 0);
             next++) {
            struct contact *c = contacts_add(to, 0, 0);
            if ((good = c != NULL)) *c = placed[next];
        }
        if (!good || i == s->n || is_taken(p, &s->c[i], placed, n, &from)) continue;
        struct contact *c = contacts_add(to, 0, 0);
        if ((good = c != NULL)) *c = s->c[i];
    }
    return good;
}

int anchors_place(struct contacts *s, const struct packing *p, const struct positions *at,
                  struct failure *failure)
{
    int64_t n = 0;
    for (int64_t i = 0; i < p->bonds.n; i++) n += bond_anchored(&p->bonds.bond[i]);
    if (!n) return 0;
    struct contact *placed = malloc((size_t)n * sizeof *placed);
    struct contacts both = { 0 };
    n = 0;
    for (int64_t i = 0; placed && i < p->bonds.n; i++) {
        const struct bond *b = &p->bonds.bond[i];
        bool there = b->a >= 0 || wall_there(&p->wall[-1 - b->a], at->t);
        if (!there || !packing_may_meet(p, b->a, b->b)) continue;
        if (bond_anchored(b) && (b->beta > 0 || b->wet)) placed[n++] = bond_anchor_place(p, b, at);
    }
    if (!placed || !bond_anchor_merge(&both, p, s, placed, n)) {
        free(placed), contacts_free(&both);
        return failure_set(failure, EX_SOFTWARE, "no memory for the contacts of bonds");
    }
    free(placed), contacts_free(s);
    *s = both;
    return 0;
}

/* Where body i is, and how it is turned, `ahead` (s) from here */
static struct pose ahead_of(const struct packing *p, int64_t i, double ahead)
{
    if (!(ahead > 0)) return (struct pose){ p->q[i], p->x[i] };
    return (struct pose){ rotation_predict(p, i), packing_predict(p, i) };
}

void bond_anchor(struct bond *b, const struct packing *p, const struct contact *c, double area,
                 double ahead)
{
    vec3 edge[3], half = v3_scale(0.5 * c->gap, c->n);
    cell_predict(&p->cell, ahead, edge);
    vec3 on_a = v3_sub(c->x, half), on_b = v3_add(c->x, half);
    const struct pose of_b = ahead_of(p, c->b, ahead);
    vec3 xb = v3_add(of_b.shift, cell_shift(edge, c->shift));
    b->at_b = quat_turn_back(of_b.q, v3_sub(on_b, xb)), b->axis = quat_turn_back(of_b.q, c->n);
    b->area = area;
    const struct pose of_a =
        c->a < 0 ? wall_pose(p, &p->wall[-1 - c->a], p->t + ahead) : ahead_of(p, c->a, ahead);
    b->at_a = quat_turn_back(of_a.q, v3_sub(on_a, of_a.shift));
}
