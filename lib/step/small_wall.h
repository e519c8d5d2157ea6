/* step/small_wall.h: walls in a small step. */
#pragma once

#include "step/small_run.h"

/* r->wall, in the step in hand */
void small_walls_set(struct small_run *r);
/* m/s: the fastest point of walls, with their belts */
double small_wall_speed(const struct packing *p);
/* m/s: of the wall's material at x (m), where its normal is n */
vec3 small_wall_velocity(const struct small_wall *w, vec3 x, vec3 n);
/* Where the body of t is against its wall: n, v, arm. False: it is farther than `reach` (m). */
bool small_look_at_touch(const struct small_run *r, struct small_touch *t, double reach);
/* m/s: of the body b against the wall at the contact, without its load */
vec3 small_touch_velocity(const struct small_touch *t, const struct body *b);
/* The same before the small step in hand, with the load */
vec3 small_touch_before(const struct small_run *r, const struct small_touch *t);
/* m/s, m: of the material of a wall that a load moves, per unit of its speed, at x (m), where the body touches it */
vec3 small_load_material(const struct small_run *r, int32_t wall, int32_t body, vec3 x);
vec3 small_load_direction(const struct small_run *r, const struct small_touch *t);
/* The load, if there is one, gets the reaction f (N s) that the body of t has been given. */
void small_load_push(struct small_run *r, const struct small_touch *t, vec3 f);
/* m/s, rad/s, 1/s: the speed of the load of a wall, the mean over the small step in hand */
double small_load_speed(const struct small_run *r, int32_t wall);
/* m/s: by the load, the mean over the small step in hand */
vec3 small_load_velocity(const struct small_run *r, const struct small_touch *t);
/* The law of a touch that is near, from where it is; but for rn */
void small_touch_law(const struct small_run *r, const struct small_touch *t, struct small_law *l);
