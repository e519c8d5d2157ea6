/*
 * step/small_list.h: what small steps work on: pairs and touches of walls, found with a margin, which serve until something
 * has moved through half of it; and their reactions, which the packing remembers from step to step.
 */
#pragma once

#include "contact/seek.h"
#include "solve/small.h"
#include "state/packing.h"
#include "step/small_meet.h"
#include "step/small_tie.h"

/* A body near a wall: numbers as in struct small_bundle */
struct small_touch {
    int32_t wall, body;
    double f[3], kept, q[3], sum[3];
    double couple[3];                /* N m s: of f about the body's centre, where it was made */
    double m[3], turned[3], most[2]; /* turned: the sum of m */
    double mu, e[2];
    double hold[HOLD_COUNT];     /* where something attracts */
    double spring[SPRING_COUNT]; /* where the contact has a stiffness */
    /* Of the step in hand */
    bool near;
    vec3 n, v;   /* normal; m/s: of the wall's material there */
    double arm;  /* m: from the body's centre to the wall, along -n */
    double work; /* J: that the body has done on the wall in this interval */
    double
        until; /* m: one that does not push is looked at when rate.gone and the reach exceed it */
};

struct small_list {
    struct small s;
    double margin, spare; /* m: pairs are listed that come to this gap on straight ways; the list
                             serves until a body is half of `spare` beside its own, */
    double serves, since; /* s: or for so long; since it was made */
    double strays, walls; /* m: no body is farther beside its way; by how much walls have gone
                             farther than at `wall` */
    double wall;          /* m/s: of walls, when it was made */
    vec3 *listed, *drift; /* [bodies] m, m/s: where the ways begin, and velocities along them */
    double interval;      /* s: of the whole step */
    struct small_stiffness *stiffness; /* [materials^2]; NULL: no contact has one */
    struct pairs pairs;                /* of balls */
    struct small_meetings meetings;    /* of others */
    const struct surface *surface;     /* [walls] of meshes; borrowed */
    int64_t *slot;                     /* [pairs.n] of a pair: lane slot % 8 of bundle slot / 8 */
    int64_t *early; /* [groups] bundles of a group from there on are swept later */
    struct small_part
        *part;              /* of these pairs and bodies [step/small_part.h]; NULL: all. Borrowed */
    int64_t images, *image; /* [images] pairs whose b is an image */
    int64_t touches, room;
    struct small_touch *touch; /* [touches] by body, then by wall */
};

void small_list_free(struct small_list *l);
/* Frees what is made anew with the pairs, and leaves it; the list has none of it. */
void small_list_empty(struct small_list *l);
void small_list_forget(struct small_list *l);
/* The first touch that is not before that of this body and wall */
int64_t small_list_touch(const struct small_list *l, int64_t body, int32_t wall);
/* [touches] in the order of contacts; NULL when memory is short. To be freed */
struct small_touch **small_list_touches(const struct small_list *l);

/* From `from` on, the first pair that is not before that of this key; *found: it is that one */
int64_t small_list_pair(const struct small_list *l, int64_t from, struct contact_key key,
                        bool *found);
/* The same among the first `end` pairs */
int64_t small_list_pair_before(const struct small_list *l, int64_t from, int64_t end,
                               struct contact_key key, bool *found);
/* The touch of this body and wall, or NULL */
struct small_touch *small_list_find_touch(const struct small_list *l, int32_t body, int32_t wall);
/* The bundle of a slot has a lane that pushes, or is held. */
void small_list_wake(struct small *s, int64_t slot);
struct contact_key small_pair_key(const struct pair *pair);

/*
 * Which bundles a repeated sweep looks at: those with a body that this sweep or the one before has changed by more than is
 * allowed [step/small_mark.c]. By one thread, before the first repeated sweep of a list; where memory is short, repeated sweeps
 * look at all bundles.
 */
void small_marks_make(struct small *s);
void small_marks_free(struct small *s);
/* Marks the bundles of bodies first .. end-1 that are hot where the sweep begins. */
void small_marks_begin(struct small *s, int64_t first, int64_t end);

/* The image of b in lane k is so far from b (m), and moves against it (m/s) */
static inline void small_shift_set(struct small_shift *to, int k, vec3 d, vec3 v)
{
    to->d[0][k] = d.x, to->d[1][k] = d.y, to->d[2][k] = d.z;
    to->v[0][k] = v.x, to->v[1][k] = v.y, to->v[2][k] = v.z;
}

/* m/s: of the image in a slot against its body */
static inline vec3 small_image_velocity(const struct small *s, int64_t slot)
{
    const struct small_shift *h = &s->shift[slot / BUNDLE];
    const int k = (int)(slot % BUNDLE);
    return v3(h->v[0][k], h->v[1][k], h->v[2][k]);
}
/* N s: what both bodies of slot i feel, on b, in the step in hand */
vec3 small_slot_force(const struct small *s, int64_t slot);
/* Of a branch; of bodies in one place, that along y */
static inline vec3 small_normal(vec3 branch)
{
    const double length = v3_norm(branch);
    return length > 0 ? v3_scale(1 / length, branch) : v3(0, 1, 0);
}
/* m: how far the point x is from wall w, where `pose` has brought it, and the normal there; infinite where a ball of radius r
   has left it */
double small_wall_distance(const struct packing *p, const struct pose *pose, int32_t w, vec3 x,
                           double r, vec3 *n);

static inline vec3 small_vec(const double x[3])
{
    return v3(x[0], x[1], x[2]);
}
/* m, from a to the image of b that it meets: of slot i */
static inline vec3 small_branch(const struct small *s, int64_t slot)
{
    const int k = (int)(slot % BUNDLE);
    const struct small_bundle *c = &s->bundle[slot / BUNDLE];
    const struct small_place *a = &s->place[body_index(c->a[k])];
    const struct small_place *b = &s->place[body_index(c->b[k])];
    vec3 d = v3_sub(small_vec(b->x), small_vec(a->x));
    if (!s->shift) return d;
    const struct small_shift *h = &s->shift[slot / BUNDLE];
    return v3_add(d, v3(h->d[0][k], h->d[1][k], h->d[2][k]));
}
static inline void small_array(double to[3], vec3 x)
{
    to[0] = x.x, to[1] = x.y, to[2] = x.z;
}
static inline bool small_is_zero(const double x[3])
{
    return x[0] == 0 && x[1] == 0 && x[2] == 0;
}
