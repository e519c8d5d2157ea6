/*
 * solve/arc.h: the central path [solve/central_path.h] followed by its arc length, where it bends.
 *
 * Where Newton's long steps with t = 1 become very short, the path is steep or folds: as a function
 * of g it turns back for a while, since the problem is not that of a minimum. With s in place of g,
 *
 *     z - y(x) = s p_0,   x o z = s g_0 (1, 0, 0),     p_0, g_0 those of the starting point
 *
 * is a curve in (x, z, s). A step corrects at a right angle to the curve's tangent and continues
 * along the curve to second order; s follows, and turns back where the determinant of Newton's
 * matrix changes its sign. Steps are made in tau = x - z, from which x and z with x o z = s g_0 (1,
 * 0, 0) follow exactly, so that the border of K stops no step. Their length is chosen so that the
 * next correction is small, measured by F.
 */
#pragma once

#include "solve/central_path.h"

/*
 * Starts from m's x and z, centred first, and follows the curve until the scaled natural map is at
 * most `natural`. False where `steps` steps do not reach it or too many of them go backwards. The
 * best point found becomes the iterate.
 */
bool arc_follow(struct central *m, double natural, int steps);
