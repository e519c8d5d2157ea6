/*
 * solve/small_pairs.h: LANES pairs of a bundle of small steps: where they are, how they move, and what both bodies get
 * [solve/small.h].
 */
#ifndef NSD_SMALL_PAIRS_H
#define NSD_SMALL_PAIRS_H

#include "solve/small.h"

/* LANES pairs of bundle i from lane k on */
struct small_pairs {
    struct small_bundle *c;
    int64_t i;
    int k;
    struct bodies a, b;
    struct twist ma, mb;
    vd ra, rb, d[3], d2;  /* m: radii; from a to b, the image that a meets; m^2 */
    vd n[3], gap, la, lb; /* m: arms along n */
    vd length, sa, sb;    /* m: of d; of that, the arms' parts */
};

ALWAYS_INLINE void small_load_places(const struct small_place *from, const int32_t *place, vd x[4])
{
    const double *at = (const double *)from;
#if LANES <= 2
    for (int k = 0; k < 4; k += LANES) {
        for (int i = 0; i < LANES; i++) x[k + i] = vload(at + place[i] + k);
        transpose(x + k);
    }
#elif LANES == 8 // lanes i and i + 4 side by side: half as many exchanges as of eight whole lines
    for (int i = 0; i < 4; i++)
        x[i] = _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(at + place[i])),
                                  _mm256_loadu_pd(at + place[i + 4]), 1);
    for (int i = 0; i < 4; i += 2)
        EXCHANGE(x, i, i + 1, LIST(0, 8, 2, 10, 4, 12, 6, 14), LIST(1, 9, 3, 11, 5, 13, 7, 15));
    for (int i = 0; i < 2; i++)
        EXCHANGE(x, i, i + 2, LIST(0, 1, 8, 9, 4, 5, 12, 13), LIST(2, 3, 10, 11, 6, 7, 14, 15));
#else
    vd y[LANES];
    for (int i = 0; i < LANES; i++) y[i] = vload(at + place[i]);
    transpose(y);
    for (int k = 0; k < 4; k++) x[k] = y[k];
#endif
}

ALWAYS_INLINE void small_load(vd x[3], double (*from)[BUNDLE], int k)
{
    for (int i = 0; i < 3; i++) x[i] = vload(from[i] + k);
}
ALWAYS_INLINE void small_store(double (*to)[BUNDLE], int k, const vd x[3])
{
    for (int i = 0; i < 3; i++) vstore(to[i] + k, x[i]);
}

/* Distances alone */
ALWAYS_INLINE void small_pairs_look(struct small_pairs *y, const struct small *s, int64_t i, int k)
{
    vd xa[4], xb[4];
    y->c = &s->bundle[i], y->i = i, y->k = k;
    small_load_places(s->place, y->c->a + k, xa), small_load_places(s->place, y->c->b + k, xb);
    for (int j = 0; j < 3; j++) y->d[j] = xb[j] - xa[j];
    for (int j = 0; j < 3 && s->shift; j++) y->d[j] += vload(s->shift[i].d[j] + k);
    y->d2 = dot3(y->d, y->d), y->ra = xa[3], y->rb = xb[3];
}

/* Has no pair of these lanes come in reach since it was last looked at? None of them pushes. */
ALWAYS_INLINE bool small_is_far(const struct small *s, int64_t i, int k, double reach)
{
    return !s->live[BUNDLE * i + k] && s->rate.gone + reach < s->until[(BUNDLE * i + k) / LANES];
}

/* None of them is in reach: when they are to be looked at again */
ALWAYS_INLINE void small_wait(const struct small_pairs *y, const struct small *s)
{
    double gap[LANES], least = INFINITY;
    vstore(gap, root(y->d2) - (y->ra + y->rb));
    for (int j = 0; j < LANES; j++) least = gap[j] >= least ? least : gap[j];
    if (!s->moves) s->until[(BUNDLE * y->i + y->k) / LANES] = s->rate.gone + least - s->slack;
}

/* The rest */
ALWAYS_INLINE void small_pairs_load(struct small_pairs *y, const struct small *s)
{
    bodies_load(&y->a, s->body, y->c->a + y->k, &y->ma);
    bodies_load(&y->b, s->body, y->c->b + y->k, &y->mb);
    vd distance = root(y->d2), per = 1 / distance;
    const vm apart =
        lt(splat(0), distance); // bodies in one place have the normal of small_normal()
    for (int j = 0; j < 3; j++) y->n[j] = pick(apart, y->d[j] * per, splat(j == 1));
    y->gap = distance - (y->ra + y->rb);
    y->la = y->ra + 0.5 * y->gap, y->lb = y->rb + 0.5 * y->gap;
    per = pick(apart, per, splat(0));
    y->length = distance, y->sa = per * y->la, y->sb = per * y->lb;
}

/* m/s: of b against a at the point of contact */
ALWAYS_INLINE void small_velocity(const struct small_pairs *y, const struct twist *a,
                                  const struct twist *b, vd u[3])
{
    vd m[3];
    for (int i = 0; i < 3; i++) m[i] = y->la * a->w[i] + y->lb * b->w[i];
    for (int i = 0, j = 1, k = 2; i < 3; j = k, k = i++)
        u[i] = b->v[i] - a->v[i] - (m[j] * y->n[k] - m[k] * y->n[j]);
}

/* The same of images that move with the cell */
ALWAYS_INLINE void small_velocity_image(const struct small_pairs *y, const struct small *s,
                                        const struct twist *a, const struct twist *b, vd u[3])
{
    small_velocity(y, a, b, u);
    for (int j = 0; j < 3 && s->moves && s->shift; j++) u[j] += vload(s->shift[y->i].v[j] + y->k);
}

/* Both bodies get df, their parts of the couple dc, and a moment dm where it is not NULL. */
ALWAYS_INLINE void small_give(const struct small_pairs *y, struct small *s, const vd df[3],
                              const vd dc[3], const vd *dm)
{
    struct twist da, db;
    vd ta = -(y->a.ii * y->sa), tb = -(y->b.ii * y->sb);
    for (int i = 0; i < 3; i++) {
        da.v[i] = -y->a.im * df[i], db.v[i] = y->b.im * df[i];
        da.w[i] = ta * dc[i], db.w[i] = tb * dc[i];
        if (dm) da.w[i] -= y->a.ii * dm[i], db.w[i] += y->b.ii * dm[i];
    }
    bodies_add(s->body, y->c->a + y->k, &da), bodies_add(s->body, y->c->b + y->k, &db);
}

#endif
