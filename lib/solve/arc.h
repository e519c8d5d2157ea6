/*
 * solve/arc.h: the central path [solve/central_path.h] followed by its arc length, where it bends.
 *
 * Where Newton's long steps of t = 1 come to nothing, the path is steep or folds: seen from g it turns
 * back for a while, since the problem is nobody's minimum. With s in place of g,
 *
 *     z - y(x) = s p_0,   x o z = s g_0 (1, 0, 0),                p_0, g_0 those of the start
 *
 * is a curve in (x, z, s). A step corrects at a right angle to its tangent and goes on along it as it
 * bends, to second order; what becomes of s is the curve's affair, which turns where the determinant
 * of Newton's matrix changes its sign. Steps are made in tau = x - z, from which x and z with
 * x o z = s g_0 follow exactly, so that no border stops them; their length is such that the next
 * correction is small in F's measure.
 */
#ifndef NSD_ARC_H
#define NSD_ARC_H

#include "solve/central_path.h"

/*
 * From x and z as they are, centred first, on to where the scaled natural map is at most `natural`. False
 * where neither `steps` of them nor a few folds lead there. The best that it found becomes the iterate.
 */
bool arc_follow(struct central *m, double natural, int steps);

#endif
