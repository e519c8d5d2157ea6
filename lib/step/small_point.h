/*
 * step/small_point.h: the points of meetings in a small step. In this order:
 *
 *     place     bodies turn, with their corners and world inertia
 *     look      the narrow phase finds the points of each meeting; those of a body at seams of surfaces go
 *     start     reactions go to the bodies: of points that start, and back of points that have gone
 *     sweep     the law of each point, exact with its W of 3 x 3; the points of a meeting several times in turn
 *     end       what of a new reaction does not persist, as of pairs [solve/small.h]
 *
 * The law is that of pairs. An impact has C = 0, for its body may meet in several points, each of which has a part
 * of the impulse.
 */
#pragma once

#include "step/small_wall.h"

/* Bodies where the small steps begin: orientations ahead, world inertia, corners. surface: of walls that are meshes; NULL:
   none. Returns 0 or EX_SOFTWARE. */
int small_points_init(struct small_run *r, const struct surface *surface, int threads,
                      struct failure *failure);
void small_points_free(struct small_run *r);
/* The orientation and the angular velocity (rad/s) of body i when the small steps end */
quat small_points_q(const struct small_run *r, int64_t i, vec3 *w);

/* Bodies first .. end-1 have moved by a small step, and turn. */
void small_points_place(struct small_run *r, int64_t first, int64_t end);

/* By thread `me` of `threads`, all together; they have met before. */
void small_points_look(struct small_run *r, int me, int threads);
void small_points_start(struct small_run *r, int me, int threads);
void small_points_sweep(struct small_run *r, int me, int threads, bool again);
/* By one thread: bodies that meet others at points are to be swept again. */
void small_points_wake(struct small_run *r);
/* What is missing of their reactions [step/small_error.h] */
void small_points_judge(struct small_run *r, int me, int threads);
void small_points_end(struct small_run *r, int me, int threads);

/*
 * Meetings with walls that loads move, which the passes above leave out; by one thread. A sweep begins, returns
 * whether a point is in reach, and is taken back to where it has begun, and tries: the points in turn, at the speed r->loads.trial. Returns
 * D . df (kg m/s, of the load), the change that the points push it by; *slope grows by an estimate of the derivative.
 */
void small_meeting_start(struct small_run *r, struct small_meeting *m);
bool small_meeting_begin(struct small_run *r, struct small_meeting *m, bool again);
void small_meeting_back(struct small_run *r, struct small_meeting *m);
double small_meeting_try(struct small_run *r, struct small_meeting *m, double *slope);
/* m/s: by how much the last try has changed the points, at most */
double small_meeting_moved(const struct small_run *r, const struct small_meeting *m);
/* Its body has been changed by so much (m/s) by the sweep. */
void small_meeting_mark(struct small_run *r, const struct small_meeting *m, double change,
                        bool again);
void small_meeting_end(struct small_run *r, struct small_meeting *m);

/* f[3], in: the reaction of a point that has it, out: that by its law, of which u would be b without it: exact, or as of balls where
   there is no solution. d: 2 or 3 */
void small_point_solve(int d, const double W[9], const double b[3], double mu, double f[3]);
/* m/s: of the image of b that a meets against a, at a point, where bodies are of[] */
vec3 small_point_velocity(const struct small_run *r, const struct small_meeting *m,
                          const struct small_point *t, const struct body *of);
/* The packing where bodies are in the small step in hand; its arrays are borrowed */
struct packing small_points_packing(const struct small_run *r);
/* By one thread: the points where the bodies are now */
void small_points_last(struct small_run *r);

/* rad/s: what a moment m (N m s) makes of body i */
static inline vec3 small_turned_by(const struct small_run *r, int32_t i, vec3 m)
{
    const double *s = r->shapes.inverse[i];
    return v3(s[0] * m.x + s[5] * m.y + s[4] * m.z, s[5] * m.x + s[1] * m.y + s[3] * m.z,
              s[4] * m.x + s[3] * m.y + s[2] * m.z);
}

/* Has it pushed in this interval, a reaction that its bodies have, or a bond? */
static inline bool small_point_lasts(const struct small_point *t)
{
    if (t->feature < 0 && (t->spring[SPRING_HELD] > 0 || t->spring[SPRING_GIVEN] != 0)) return true;
    return !small_is_zero(t->f) || !small_is_zero(t->sum) || v3_dot(t->pull, t->pull) > 0;
}

/* What a point has pushed goes into its sums. */
static inline void small_point_end(struct small_point *t)
{
    for (int k = 0; k < 3; k++) t->sum[k] += t->f[k], t->turned[k] += t->m[k];
    for (int k = 0; k < 3; k++) t->f[k] = t->m[k] = 0;
}
