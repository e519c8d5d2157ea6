/*
 * solve/levers.h: bundles of contacts whose lever arms are any vectors, between bodies of any
 * inertia.
 *
 *     u_i = e_i . (v_b - v_a) + G_b,i . y_b - G_a,i . y_a,   y = I^1/2 w,   G_i = I^-1/2 (r x e_i)
 *
 * with e = (n, t1, t2), r from a body's centre to the point of contact, and I its inertia where the
 * contact acts. In y, which struct body holds in place of w, a body's inertia is 1: a change of the
 * reactions adds G^T dr, and a body stays a cache line. A body that does not move has y = w and
 * G_i = r x e_i, and keeps them. W_cc is full [solve/problem.h: block].
 */
#ifndef NSD_LEVERS_H
#define NSD_LEVERS_H

#include "solve/bundle.h"

struct levers {
    double Ga[9][BUNDLE], Gb[9][BUNDLE]; /* m (kg m^2)^-1/2: component j of G_i at 3 i + j */
};

/* As bundle_velocity() */
ALWAYS_INLINE void levers_velocity(const struct bundle *c, const struct beside *t,
                                   const struct levers *g, const struct rebound *e, int k,
                                   const struct twist *a, const struct twist *b, vd u[3], vd t1[3],
                                   vd t2[3])
{
    vd n[3], dv[3];
    bundle_basis(c, t, k, n, t1, t2);
    for (int i = 0; i < 3; i++) dv[i] = b->v[i] - a->v[i];
    u[0] = dot3(n, dv), u[1] = dot3(t1, dv), u[2] = dot3(t2, dv);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            u[i] += vload(g->Gb[3 * i + j] + k) * b->w[j] - vload(g->Ga[3 * i + j] + k) * a->w[j];
    for (int i = 0; i < 3 && e; i++) u[i] = vload(e->s[i > 0] + k) * u[i] + vload(e->offset[i] + k);
}

/* As bundle_push() */
ALWAYS_INLINE void levers_push(const struct bundle *c, const struct levers *g, int k,
                               const vd t1[3], const vd t2[3], const vd dr[3], struct body *body,
                               const struct bodies *a, const struct bodies *b)
{
    vd im = -a->im, ii = -a->ii;
    struct twist da, db;
    for (int i = 0; i < 3; i++) {
        vd f = dr[0] * vload(c->n[i] + k) + dr[1] * t1[i] + dr[2] * t2[i];
        vd ma = splat(0), mb = splat(0);
        for (int j = 0; j < 3; j++) {
            ma += vload(g->Ga[3 * j + i] + k) * dr[j];
            mb += vload(g->Gb[3 * j + i] + k) * dr[j];
        }
        da.v[i] = im * f, da.w[i] = ii * ma;
        db.v[i] = b->im * f, db.w[i] = b->ii * mb;
    }
    bodies_add(body, c->a + k, &da), bodies_add(body, c->b + k, &db);
}

#endif
