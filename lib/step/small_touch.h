/* step/small_touch.h: the law where a ball touches a wall in a small step, in the order of these functions. */
#pragma once

#include "step/small_run.h"

/* Body b gets an impulse f and a moment m about its centre. */
void small_body_push(struct body *b, vec3 f, vec3 m);

/* The body gets that, with the moment. */
void small_touch_push(struct small_run *r, struct small_touch *t);
/* First sweep: a touch that does not push, and whose body cannot have come near its wall */
bool small_touch_waits(const struct small_run *r, const struct small_touch *t);
/* Is the body near its wall? One that has left gives its reaction back. */
bool small_touch_near(struct small_run *r, struct small_touch *t);
/* First sweep: the law of this step, attraction and static friction. Returns the change of the pull (N s), which l->u
   has. */
vec3 small_touch_begin(const struct small_run *r, struct small_touch *t, struct small_law *l);
/* The reaction, l->f, and its change df (N s), with the springs of the touch, in steps of h (s) */
void small_touch_solve(const struct small_touch *t, struct small_law *l, double h, double df[3]);
/* The body gets the change df of its reaction, l->f, a change dp of the pull, and what rolling friction makes of them. */
void small_touch_give(struct small_run *r, struct small_touch *t, const struct small_law *l,
                      double df[3], vec3 dp, double heavy, bool again);
/* After the sweeps: what has been done to the wall, and what persists. Returns what does not, on the body (N s). */
vec3 small_touch_end(struct small_run *r, struct small_touch *t);
