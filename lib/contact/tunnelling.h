/*
 * contact/tunnelling.h: bodies that move in a step by more than they are thick. Where contacts are sought such a body is
 * on one side of a sheet at one step and on the other at the next.
 *
 * Its way in the step, relative to a wall, (v + g dt - v_wall) dt, is looked at in places no farther apart than
 * it is thick. The first of them at which it touches what it did not touch before makes contacts now, with all that
 * is nearer there than it is thick, and with the gaps along their normals that it has now: it gets as far as there in this step, or where the law sees no gaps
 * [state/packing.h] it stops, or rebounds, at most one step's way early. Their features tell them, for they are
 * contacts however wide the gap is. The same is done where a body would meet hulls that are fixed.
 *
 * What still gets through is counted after the step; at the start of a run also what goes through something before
 * the place where contacts are sought first. A contact there would leave the body where it is, behind what it met.
 */
#pragma once

#include "contact/seek.h"
#include "state/contact.h"
#include "state/placement.h"

/* Features of such contacts, of walls and of bodies: no others lie between one of these and its double. */
enum { AHEAD_OF_WALL = 1 << 29, AHEAD_OF_BODY = 1 << 30 };
static inline bool tunnelling_ahead(const struct contact *c)
{
    return c->a < 0 ? c->feature >= AHEAD_OF_WALL && c->feature < AHEAD_OF_BODY
                    : c->feature >= AHEAD_OF_BODY;
}

/* m: of a ball inside the body, around its centre; of a clump the smallest ball */
double tunnelling_thickness(const struct packing *p, int64_t i);
/* Does body i go farther in a step than it is thick, relative to what has at most the velocity `most` (m/s)?
   The thickness is the radius of a ball inside the body, around its centre; of a clump that of the smallest ball. */
bool tunnelling_is(const struct packing *p, int64_t i, double most);
/* m/s: that of wall w, with what gravity adds to a body's */
double tunnelling_beside(const struct packing *p, int32_t w);
/* m: how far any body goes in a step that may meet a fixed hull ahead; 0: none is so fast. Who has some of the bodies
   has to know of fixed hulls as far. */
double tunnelling_reach(const struct packing *p);

/* Adds what body i meets ahead of wall w, which is no plane, besides the contacts out->c[first ...] of these two.
   False when memory is short. */
bool tunnelling_meets_wall(struct contacts *out, int64_t first, const struct situation *o,
                           int32_t w, int64_t i);
/* Adds what bodies meet ahead of fixed hulls, and sorts all contacts again. */
bool tunnelling_meet_hulls(struct contacts *out, const struct situation *o);

/* Bodies that have gone through a wall or another body without meeting it */
struct passed {
    int64_t n;
    /* of the one with the lowest number: what it went through, a wall -1-w or a body's number; of several the last */
    int32_t id, through;
};
void tunnelling_note(struct passed *s, int32_t id, int32_t through);
/* Does the way from a to b (m, from the centre) enter a hull of radius r (m) from outside, and leave it? */
bool tunnelling_through_hull(const struct shape *s, int dim, double r, quat q, vec3 a, vec3 b);

/* s: a part of a step in which a body goes, or went, from x - back v by length v */
struct window {
    double back, length;
};
/* At the start of a step, to where its contacts are sought; and at its end, from there to where the next are */
static inline struct window window_before(const struct packing *p)
{
    return (struct window){ 0, step_ahead(p) };
}
static inline struct window window_after(const struct packing *p)
{
    return (struct window){ step_after(p), p->dt };
}

/* Is there anything of that kind, a wall that is no plane or a fixed hull? */
bool tunnelling_watches(const struct packing *p);
/* In the window, of bodies for which of[p->n] is true; NULL: all */
void tunnelling_passed(struct passed *s, const struct packing *p, const bool *of,
                       const struct surface *surface, struct window window);
