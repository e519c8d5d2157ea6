/*
 * state/pull.h: forces and torques on single bodies as functions of time, which a scene has: signals in N, N m along
 * and about an axis, each of the body whose id is its `boundary`, in the order of these ids. A step sees them at its
 * middle, beside gravity.
 */
#ifndef NSD_PULL_H
#define NSD_PULL_H

#include "shape/drive.h"

/* N; N m where `turns`: the sum on the body with this id at time t (s) */
vec3 pulls_on(const struct drives *pulls, int32_t id, double t, bool turns);
/* m/s^2: no body of these ids and masses (kg) [n] gains more by them */
double pulls_most(const struct drives *pulls, int64_t n, const int32_t *id, const double *mass);
/* Are they signals of forces, in their order, and `most` (m/s^2) a number? Returns 0 or EX_DATAERR. */
int pulls_check(const struct drives *pulls, double most, int dim, struct failure *failure);

#endif
