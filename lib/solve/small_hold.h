/*
 * solve/small_hold.h: attraction in small steps: a constant pull within a range and liquid bridges [state/pair_law.h], in LANES
 * lanes. In a step of length h a pair at gap g is pulled together by h A(g), and
 *
 *     f = r - h A(g) n
 *
 * is what both bodies feel: r, the push of one surface on the other, is on the law of solve/small.h. A bridge is made where
 * bodies touch, or have pushed in the step before, and ruptures at its reach. A constant pull also
 * holds a pair that is no farther apart than it closes in h.
 */
#pragma once

#include "base/lanes.h"

/* What a pair has, each in its place of x[] */
enum small_hold {
    HOLD_COHESION, /* N, while the gap is at most */
    HOLD_RANGE,    /* m */
    HOLD_TOUCH,    /* m: bodies at this gap touch */
    HOLD_BRIDGE,   /* N: of a bridge whose bodies touch; 0: none is made */
    HOLD_C2,       /* m^2: its c^2, above 0 */
    HOLD_REACH,    /* m: where it ruptures */
    HOLD_WET,      /* 1: there is a bridge; 0 */
    HOLD_PULL,     /* N s: h A in the step in hand, */
    HOLD_X,        /* along this normal */
    HOLD_Y,
    HOLD_Z,
    HOLD_JOINED, /* J: minus what bridges of this interval have given up when they were made */
    HOLD_COUNT
};

/* J: of a bridge at gap g; 0 where it ruptures */
ALWAYS_INLINE vd small_hold_bridge(const vd x[HOLD_COUNT], vd g)
{
    vd zero = splat(0), open = larger(g, zero), under = g - open, end = x[HOLD_REACH];
    vd to = x[HOLD_C2] / (open + root(open * open + x[HOLD_C2]));
    vd from = x[HOLD_C2] / (end + root(end * end + x[HOLD_C2]));
    return pick(lt(g, end), x[HOLD_BRIDGE] * (under - (to - from)), zero);
}

/* J: of all that is attracted */
ALWAYS_INLINE vd small_hold_energy(const vd x[HOLD_COUNT], vd g)
{
    vd zero = splat(0), pulls = x[HOLD_COHESION] * (g - x[HOLD_RANGE]);
    return pick(lt(g, x[HOLD_RANGE]), pulls, zero) +
           pick(lt(zero, x[HOLD_WET]), small_hold_bridge(x, g), zero);
}

/* N: at gap g */
ALWAYS_INLINE vd small_hold_force(const vd x[HOLD_COUNT], vd g)
{
    vd zero = splat(0), open = larger(g, zero);
    vd bridge = x[HOLD_BRIDGE] * (1 - open / root(open * open + x[HOLD_C2]));
    vm wet = lt(zero, x[HOLD_WET]) & lt(g, x[HOLD_REACH]);
    return pick(le(g, x[HOLD_RANGE]), x[HOLD_COHESION], zero) + pick(wet, bridge, zero);
}

/* N s: the pull of a step of h along n, of a pair that has pushed in the step before where `pushed`; bridges are made and
   rupture. dp: its change, of which `warm` persists */
ALWAYS_INLINE vd small_hold_pull(vd x[HOLD_COUNT], const vd n[3], vd g, vm pushed, double h,
                                 double warm, vd dp[3])
{
    vd zero = splat(0), one = splat(1);
    vm was = lt(zero, x[HOLD_WET]), wets = lt(zero, x[HOLD_BRIDGE]);
    vm is = (was | (wets & (pushed | le(g, x[HOLD_TOUCH])))) & lt(g, x[HOLD_REACH]);
    vm made = is & ~was;
    if (any(made)) x[HOLD_JOINED] = x[HOLD_JOINED] + pick(made, small_hold_bridge(x, g), zero);
    x[HOLD_WET] = pick(is, one, zero);
    for (int j = 0; j < 3; j++) dp[j] = -(warm * x[HOLD_PULL] * x[HOLD_X + j]);
    x[HOLD_PULL] = h * small_hold_force(x, g);
    for (int j = 0; j < 3; j++) x[HOLD_X + j] = n[j], dp[j] += x[HOLD_PULL] * n[j];
    return x[HOLD_PULL];
}
