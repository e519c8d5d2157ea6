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

struct contact bond_anchor_contact(const struct packing *p, const struct bond *b,
                                   const struct pose of[2], const vec3 edge[3])
{
    struct contact c = { .a = b->a, .b = b->b, .feature = b->feature };
    const vec3 xb = pose_of(&of[1], b->at_b);
    vec3 xa = pose_of(&of[0], b->at_a);
    if (b->a < 0) xa = nearest_image(&p->cell, edge, xa, xb);
    for (int k = 0; k < 3; k++) c.shift[k] = b->shift[k];
    vec3 n = quat_turn(of[1].q, b->axis);
    if (p->dim == 2) n.z = 0;
    contact_basis(&c, p->dim, v3_scale(1 / v3_norm(n), n));
    c.x = v3_scale(0.5, v3_add(xa, xb)), c.gap = v3_dot(c.n, v3_sub(xb, xa));
    packing_set_law(p, &c);
    return c;
}

/* The same; at->q has no half step of balls, whose turning is constant. */
static struct contact bond_anchor_place(const struct packing *p, const struct bond *b,
                                        const struct positions *at)
{
    struct pose of[2];
    for (int side = 0; side < 2; side++) {
        const int32_t i = side ? b->b : b->a;
        if (i < 0)
            of[side] = wall_pose(p, &p->wall[-1 - i], at->t);
        else
            of[side].q = packing_shape(p, i) ? at->q[i] : rotation_predict(p, i),
            of[side].shift = at->x[i];
    }
    of[1].shift = v3_add(of[1].shift, cell_shift(at->edge, b->shift));
    return bond_anchor_contact(p, b, of, at->edge);
}

bool bond_anchor_near(const struct packing *p, const struct contact *c, vec3 x)
{
    const double near = NEAR * packing_smaller_radius(p, c);
    const vec3 d = v3_sub(x, c->x);
    return v3_dot(d, d) <= near * near;
}

/* Is the contact where one of these is, which are sorted? *from: where its pair's begin */
static bool is_taken(const struct packing *p, const struct contact *c, const struct contact *of,
                     int64_t n, int64_t *from)
{
    while (*from < n && (of[*from].a < c->a || (of[*from].a == c->a && of[*from].b < c->b)))
        ++*from;
    for (int64_t i = *from; i < n && of[i].a == c->a && of[i].b == c->b; i++) {
        bool same = true;
        for (int k = 0; k < 3; k++) same = same && of[i].shift[k] == c->shift[k];
        if (same && bond_anchor_near(p, c, of[i].x)) return true;
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

void bond_anchor_at(struct bond *b, const struct contact *c, double area, const struct pose of[2])
{
    const vec3 half = v3_scale(0.5 * c->gap, c->n);
    b->at_b = quat_turn_back(of[1].q, v3_sub(v3_add(c->x, half), of[1].shift));
    b->axis = quat_turn_back(of[1].q, c->n), b->area = area;
    b->at_a = quat_turn_back(of[0].q, v3_sub(v3_sub(c->x, half), of[0].shift));
}

void bond_anchor(struct bond *b, const struct packing *p, const struct contact *c, double area,
                 double ahead)
{
    vec3 edge[3];
    cell_predict(&p->cell, ahead, edge);
    struct pose of[2] = { c->a < 0 ? wall_pose(p, &p->wall[-1 - c->a], p->t + ahead)
                                   : ahead_of(p, c->a, ahead),
                          ahead_of(p, c->b, ahead) };
    of[1].shift = v3_add(of[1].shift, cell_shift(edge, c->shift));
    bond_anchor_at(b, c, area, of);
}
