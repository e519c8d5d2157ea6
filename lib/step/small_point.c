/* step/small_point.c: where bodies of a meeting meet, and the law there [step/small_point.h]. */
#include "step/small_point.h"

#include "base/array.h"
#include "base/team.h"
#include "contact/detect.h"
#include "contact/internal_edge.h"
#include "state/rotation.h"
#include "step/small_anchor.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the smallest thickness: how far a point may be from one that has gone, whose reaction it takes; and the cosine of
   their normals */
#define BESIDE 0.2
#define ALONG  0.9

/* Of the smallest thickness: how much farther than in reach points are looked for. Where there is none, that serves until
   the bodies have gone as far. */
#define WIDE 0.05

/* ---- bodies ---- */

/* The world inertia of body i */
static void set_inverse(struct small_run *r, int64_t i)
{
    const struct packing *p = r->p;
    double *to = r->shapes.inverse[i];
    const vec3 m = rotation_moments(p, i);
    if (!(p->mass[i] > 0)) return;
    if (!rotation_is(p, i)) {
        to[2] = 1 / p->inertia[i];
        if (p->dim == 3) to[0] = to[1] = to[2];
        return;
    }
    const vec3 e[3] = { quat_turn(r->shapes.q[i], v3(1, 0, 0)),
                        quat_turn(r->shapes.q[i], v3(0, 1, 0)),
                        quat_turn(r->shapes.q[i], v3(0, 0, 1)) };
    const double d[3] = { 1 / m.x, 1 / m.y, 1 / m.z };
    for (int k = 0; k < 6; k++) to[k] = 0;
    for (int k = 0; k < 3; k++) {
        to[0] += d[k] * e[k].x * e[k].x, to[1] += d[k] * e[k].y * e[k].y;
        to[2] += d[k] * e[k].z * e[k].z, to[3] += d[k] * e[k].y * e[k].z;
        to[4] += d[k] * e[k].x * e[k].z, to[5] += d[k] * e[k].x * e[k].y;
    }
}

void small_points_free(struct small_run *r)
{
    struct small_shapes *s = &r->shapes;
    for (int k = 0; s->scratch && k < s->threads; k++)
        contacts_free(&s->scratch[k].found), free(s->scratch[k].point);
    free(s->scratch), free(s->q), free(s->inverse), free(s->spread), free(s->way);
    placed_free(&s->placed), small_attract_free(r), small_anchors_free(r);
    *s = (struct small_shapes){ 0 };
}

int small_points_init(struct small_run *r, const struct surface *surface, int threads,
                      struct failure *failure)
{
    struct packing *p = r->p;
    struct small_shapes *s = &r->shapes;
    const size_t n = (size_t)p->n + 1;
    *s = (struct small_shapes){ .threads = threads };
    s->q = calloc(n, sizeof *s->q), s->inverse = calloc(n, sizeof *s->inverse);
    s->spread = calloc(n, sizeof *s->spread), s->way = calloc(n, sizeof *s->way);
    s->scratch = calloc((size_t)threads, sizeof *s->scratch);
    if (!s->q || !s->inverse || !s->spread || !s->way || !s->scratch)
        return failure_set(failure, EX_SOFTWARE, "no memory for small steps");
    for (int64_t i = 0; i < p->n; i++) {
        const vec3 m = rotation_moments(p, i);
        s->q[i] = rotation_predict(p, i);
        small_array(r->l->s.body[i].w, rotation_predict_spin(p, i, s->q[i]));
        if (p->mass[i] > 0) s->spread[i] = 1 / fmin(m.x, fmin(m.y, m.z));
        set_inverse(r, i);
    }
    s->at = (struct situation){ .p = p, .x = r->x, .surface = surface };
    if (cell_repeats(&p->cell)) s->at.edge = r->cell.edge;
    if (!p->shape) return 0;
    const struct positions at = { .x = r->x, .q = s->q };
    s->at.shaped = &s->placed;
    return placed_init(&s->placed, p, &at, failure);
}

/* q and w of body i after a free turning by dt (s) */
static quat turn_freely(const struct small_run *r, int64_t i, double dt, vec3 *w)
{
    const quat q = r->shapes.q[i];
    if (!rotation_is(r->p, i)) return quat_unit(quat_mul(quat_rotation(v3_scale(dt, *w)), q));
    const vec3 L = rotation_momentum(r->p, i, q, *w);
    const quat then = rotation_turn(r->p, i, q, L, dt);
    *w = rotation_spin(r->p, i, then, L);
    return then;
}

quat small_points_q(const struct small_run *r, int64_t i, vec3 *w)
{
    *w = small_vec(r->l->s.body[i].w);
    return turn_freely(r, i, -r->ahead, w);
}

/* What has been added to the w of body i is a moment's, and remains so when the body turns to q. */
static void keep_moment(const struct small_run *r, int64_t i, quat q, double w[3])
{
    const vec3 L = rotation_momentum(r->p, i, r->shapes.q[i], small_vec(w));
    small_array(w, rotation_spin(r->p, i, q, L));
}

void small_points_place(struct small_run *r, int64_t first, int64_t end)
{
    struct small_shapes *s = &r->shapes;
    for (int64_t i = first; i < end; i++) {
        struct body *b = &r->l->s.body[i];
        vec3 w = small_vec(b->w);
        r->x[i] = small_vec(r->l->s.place[i].x);
        s->way[i] += r->h * small_point_speed(r, i);
        if (!packing_shape(r->p, i) && !r->bonds) continue; // a ball: r->turned is enough
        const quat q = turn_freely(r, i, r->h, &w);
        if (rotation_is(r->p, i)) {
            keep_moment(r, i, q, r->l->s.before[i].w);
            if (r->pull) keep_moment(r, i, q, r->pull[i].dw);
            small_array(b->w, w);
        }
        s->q[i] = q;
        if (rotation_is(r->p, i)) set_inverse(r, i);
        if (packing_shape(r->p, i)) placed_turn(&s->placed, i, q);
    }
}

struct packing small_points_packing(const struct small_run *r)
{
    struct packing here = *r->p;
    here.x = r->x, here.q = r->shapes.q, here.theta = 1;
    memcpy(here.cell.edge, r->cell.edge, sizeof here.cell.edge);
    return here;
}

/* ---- where points are ---- */

static vec3 image_of(const struct small_run *r, const struct small_meeting *m)
{
    return r->shapes.at.edge ? cell_shift(r->cell.edge, m->key.shift) : v3(0, 0, 0);
}

/* Adds to W what body i has of it, with this arm (m). */
static void add_block(const struct small_run *r, struct small_point *t, int32_t i, vec3 arm)
{
    const vec3 e[3] = { t->n, t->t1, v3_cross(t->n, t->t1) };
    const double im = r->l->s.body[i].im;
    vec3 lever[3], turn[3];
    for (int k = 0; k < 3; k++)
        lever[k] = v3_cross(arm, e[k]), turn[k] = small_turned_by(r, i, lever[k]);
    for (int k = 0; k < 9; k++) t->W[k] += v3_dot(lever[k / 3], turn[k % 3]) + (k % 4 ? 0 : im);
}

/* The arms of a point at x, and the velocity of a wall there */
static void set_arms(const struct small_run *r, const struct small_meeting *m,
                     struct small_point *t)
{
    t->b = v3_sub(t->x, v3_add(r->x[m->key.b], image_of(r, m)));
    t->v = t->a = t->D = v3(0, 0, 0);
    if (m->key.a < 0)
        t->v = small_wall_velocity(&r->wall[-1 - m->key.a], t->x, t->n);
    else
        t->a = v3_sub(t->x, r->x[m->key.a]);
    if (small_meeting_loaded(r, m)) t->D = small_load_material(r, -1 - m->key.a, m->key.b, t->x);
}

/* A point is where contact c is. */
static void set_point(const struct small_run *r, const struct small_meeting *m,
                      struct small_point *t, const struct contact *c)
{
    const int32_t a = m->key.a, b = m->key.b;
    t->feature = c->feature, t->there = true;
    t->x = c->x, t->n = c->n, t->t1 = c->t1, t->gap = c->gap;
    t->mu = c->mu, t->e[0] = c->en, t->e[1] = c->et;
    set_arms(r, m, t);
    for (int k = 0; k < 9; k++) t->W[k] = 0;
    add_block(r, t, b, t->b);
    if (a >= 0) add_block(r, t, a, t->a);
}

/* The nearest point of those in reach that is beside one that has gone, and, where `starts`, without a reaction; NULL */
static struct small_point *point_beside(const struct small_run *r, struct small_meeting *m,
                                        const struct small_point *gone, bool starts)
{
    struct small_point *next = NULL;
    double least = BESIDE * r->thin;
    for (int64_t i = 0; i < m->points; i++) {
        struct small_point *t = &m->point[i];
        const double way = v3_norm(v3_sub(t->x, gone->x));
        if (!t->near || (starts && !t->starts) || v3_dot(t->n, gone->n) < ALONG || !(way <= least))
            continue;
        least = way, next = t;
    }
    return next;
}

/* Does its reaction go over to another? Not what a bond that has broken has pulled. */
static bool leaves_reaction(const struct small_point *gone)
{
    if (small_is_zero(gone->f)) return false;
    return !small_point_bonded(gone) || v3_dot(small_vec(gone->f), gone->n) > 0;
}

/* Points that are in reach no more leave their reactions, and what they have pushed, to others beside them. */
static void hand_over(const struct small_run *r, struct small_meeting *m)
{
    for (int64_t i = 0; i < m->points; i++) {
        struct small_point *gone = &m->point[i], *next;
        if (gone->near || gone->starts || gone->left) continue;
        if (!small_is_zero(gone->sum) && (next = point_beside(r, m, gone, false)))
            for (int k = 0; k < 3; k++) {
                next->sum[k] += gone->sum[k], next->turned[k] += gone->turned[k];
                gone->sum[k] = gone->turned[k] = 0;
            }
        if (!leaves_reaction(gone) || !(next = point_beside(r, m, gone, true))) continue;
        for (int k = 0; k < 3; k++) next->f[k] += gone->f[k], next->m[k] += gone->m[k];
        gone->left = true;
        if (!small_point_bonded(gone) && !small_point_bonded(next))
            for (int k = 0; k < 3; k++) {
                next->spring[SPRING_X + k] += gone->spring[SPRING_X + k];
                next->spring[SPRING_DUE] = gone->spring[SPRING_DUE];
            }
    }
}

/* The points that c->found has, and those before that last. False when memory is short. */
static bool take_points(const struct small_run *r, struct small_meeting *m, struct small_scratch *c)
{
    int64_t i = 0, j = 0, n = 0;
    const struct contacts *found = &c->found;
    if (!array_grow(&c->point, &c->room, m->points + found->n, sizeof *c->point)) return false;
    while (i < m->points || j < found->n) {
        struct small_point *to = &c->point[n];
        const struct small_point *was = i < m->points ? &m->point[i] : NULL;
        const struct contact *is = j < found->n ? &found->c[j] : NULL;
        if (was && (!is || was->feature <= is->feature)) {
            const bool same = is && was->feature == is->feature;
            *to = *was, to->there = false, i++;
            if (!same && !small_point_lasts(was)) continue;
            if (same) set_point(r, m, to, is), j++;
        } else {
            *to = (struct small_point){ .spring[SPRING_REST] = m->rest };
            set_point(r, m, to, is), j++;
        }
        n++;
    }
    if (!array_grow(&m->point, &m->room, n, sizeof *m->point)) return false;
    if (n) memcpy(m->point, c->point, (size_t)n * sizeof *m->point);
    m->points = n;
    return true;
}

/* Which points are in reach */
static void choose_points(const struct small_run *r, struct small_meeting *m)
{
    for (int64_t i = 0; i < m->points; i++) {
        struct small_point *t = &m->point[i];
        t->near = t->there && (small_point_bonded(t) || t->gap <= r->l->s.rate.reach);
        if (t->near && small_is_zero(t->f)) t->starts = true;
        t->seam = t->left = t->beside = false;
    }
}

static bool find_points(const struct small_run *r, struct small_meeting *m, double gap,
                        struct small_scratch *c)
{
    const struct situation *at = &r->shapes.at;
    const struct contact_key *k = &m->key;
    const struct pair pair = { k->a, k->b, { k->shift[0], k->shift[1], k->shift[2] } };
    bool room = true;
    c->found.n = 0;
    if (pair.a >= 0)
        room = detect_pair(&c->found, at, &pair, gap);
    else if (r->wall[-1 - pair.a].there)
        room = detect_wall(&c->found, at, -1 - pair.a, pair.b, gap);
    return room && take_points(r, m, c);
}

/* Bonds are where their bodies have carried them. */
static void place_bonds(const struct small_run *r, struct small_meeting *m)
{
    for (int64_t i = 0; i < m->points && small_point_bonded(&m->point[i]); i++) {
        struct small_point *t = &m->point[i];
        struct contact c;
        t->there = false;
        if (!small_point_holds(t) || !small_anchor_place(r, m, t, &c)) continue;
        set_point(r, m, t, &c);
        t->e[0] = t->e[1] = 0;
    }
}

static bool look_at_meeting(const struct small_run *r, struct small_meeting *m,
                            struct small_scratch *c)
{
    const int32_t a = m->key.a, b = m->key.b;
    const double *way = r->shapes.way;
    double reach = fmax(r->l->s.rate.reach, small_attract_reach(m));
    if (r->bonds) reach = fmax(reach, small_anchor_reach(r, m));
    const double gone = (a < 0 ? r->wall[-1 - a].way : way[a]) + way[b];
    bool there = false;
    for (int64_t i = 0; i < m->points; i++) there |= m->point[i].there;
    if (there || !m->looked || r->cell.moves || reach + gone - m->way > m->wide) {
        m->looked = true, m->way = gone, m->wide = reach + WIDE * r->thin;
        if (!find_points(r, m, m->wide, c)) return false;
    }
    if (r->bonds) place_bonds(r, m);
    choose_points(r, m);
    hand_over(r, m);
    return true;
}

/* The points of body i with what does not move, as contacts; false when memory is short. */
static bool gather_held(const struct small_run *r, int64_t i, struct small_scratch *c)
{
    const struct small_meetings *all = &r->l->meetings;
    c->found.n = 0;
    for (int64_t k = all->held_first[i]; k < all->held_first[i + 1]; k++) {
        const struct small_meeting *m = &all->of[all->held[k]];
        for (int64_t l = 0; l < m->points; l++) {
            const struct small_point *t = &m->point[l];
            if (!t->near || small_point_bonded(t)) continue;
            struct contact *to = contacts_add(&c->found, m->key.a, m->key.b);
            if (!to) return false;
            to->feature = t->feature, to->x = t->x, to->n = t->n, to->t1 = t->t1, to->gap = t->gap;
            memcpy(to->shift, m->key.shift, sizeof to->shift);
            to->mu = t->mu, to->en = t->e[0], to->et = t->e[1];
        }
    }
    return true;
}

/* Points of body i at seams are none [contact/internal_edge.h]. */
static bool drop_seams(const struct small_run *r, int64_t i, struct small_scratch *c)
{
    const struct small_meetings *all = &r->l->meetings;
    int64_t n = 0;
    if (!gather_held(r, i, c)) return false;
    if (c->found.n < 2) return true;
    for (int64_t k = all->held_first[i]; k < all->held_first[i + 1]; k++) {
        struct small_meeting *m = &all->of[all->held[k]];
        for (int64_t l = 0; l < m->points; l++) {
            struct small_point *t = &m->point[l];
            if (!t->near || small_point_bonded(t)) continue;
            const struct contact *at = &c->found.c[n++];
            if (seams_may(&r->shapes.at, at) &&
                seams_has(&c->found, &r->shapes.at, (int32_t)i, at - c->found.c))
                t->near = false, t->seam = true;
        }
    }
    return true;
}

static void look_some(struct small_run *r, int me, int threads, bool seams)
{
    struct small_meetings *all = &r->l->meetings;
    const int64_t n = seams ? r->p->n : all->n;
    for (int64_t i = n * me / threads; i < n * (me + 1) / threads; i++) {
        struct small_scratch *c = &r->shapes.scratch[me];
        if (seams ? !drop_seams(r, i, c) : !look_at_meeting(r, &all->of[i], c))
            r->shapes.failed = true;
    }
}

/* `last`: at the end of the interval */
static void begin_bonds(struct small_run *r, int me, int threads, bool last)
{
    struct small_meetings *all = &r->l->meetings;
    for (int64_t i = all->n * me / threads; i < all->n * (me + 1) / threads; i++)
        if (small_anchors_begin(r, &all->of[i], last)) hand_over(r, &all->of[i]);
}

void small_points_look(struct small_run *r, int me, int threads)
{
    if (!me) r->shapes.at.t = r->p->t + r->ahead;
    team_meet();
    look_some(r, me, threads, false);
    team_meet();
    look_some(r, me, threads, true);
    team_meet();
    if (r->bonds) begin_bonds(r, me, threads, false);
    if (r->bonds) team_meet();
    if (!me && r->bonds) small_anchors_make(r);
    if (!me && r->shapes.failed) r->lost = r->stop = true;
    if (r->bonds) team_meet();
}

void small_points_last(struct small_run *r)
{
    r->shapes.at.t = r->p->t + r->ahead;
    look_some(r, 0, 1, false), look_some(r, 0, 1, true);
    if (r->bonds) begin_bonds(r, 0, 1, true);
    for (int64_t i = 0; i < r->l->meetings.n; i++) {
        struct small_meeting *m = &r->l->meetings.of[i];
        for (int64_t k = 0; k < m->points; k++) {
            struct small_point *t = &m->point[k];
            if (!t->starts && !t->near) small_point_end(t);
            if (t->starts && t->near)
                for (int j = 0; j < 3; j++) t->sum[j] -= t->f[j], t->turned[j] -= t->m[j];
        }
        hand_over(r, m);
    }
}
