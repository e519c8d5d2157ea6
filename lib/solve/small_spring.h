/*
 * solve/small_spring.h: contacts with a stiffness, and bonds of adhesion, in small steps, in LANES lanes.
 *
 * A contact with a stiffness has springs and dashpots along n and across, with Coulomb's law. With g the gap where the step of
 * length h begins, x_n = g - g_0 and x_t the stretches of the springs there,
 *
 *     f_n = max(0, - h k_n x_n - G_n u_n) where x_n < 0, else 0
 *     f_t = - h k_t x_t - G_t u_t, on the disc of mu f_n,          G = 2 zeta h sqrt(k/W)
 *
 * with u the velocities after the step, so that dashpots lose energy at any h; in the first step of an impact G is times the time
 * since x_n was 0 and h/2, over h, because velocities are those half a step from x. x is explicit: without dashpots this is the
 * leapfrog scheme, which keeps the energy of an oscillator and is stable for k h^2 W < 4. zeta is the damping ratio with which a
 * pair alone rebounds with its restitution, e_n along n and e_t across [step/small_stiff.h]. As of one solve per step
 * [contact/spring.h], k_t x_t is at most mu k_n |x_n|, x_t turns with n and the mean spin of the pair, and g_0 is the gap with
 * which bodies that overlap are first seen, which rises to 0.
 *
 * A bond [contact/contact_law.h] of area S and intensity beta pulls by
 *
 *     p = - h S beta^2 (c_n (max(0, g) + h u_n) n + c_t (x_t + h u_t))
 *
 * with the law of one solve per step, implicit, so that bonds damp what oscillates. f is what the bodies feel: f - p is on the law
 * of rigid pairs, with mu (1 - beta) and without restitution. x_t is then not cut. beta falls when a step begins, by the stretch that
 * the step before has left, and a bond of less than BETA_LEAST breaks. It is remembered until the bodies have parted, and not made
 * anew before.
 */
#pragma once

#include "solve/local.h"

/* What a pair has, each in its place of x[] */
enum small_spring {
    SPRING_KN, /* N s/m: h k_n; 0: the pair is rigid */
    SPRING_KT,
    SPRING_GN, /* kg */
    SPRING_GT,
    SPRING_YIELD, /* s: h where springs are implicit, by x + h u, because a load moves the wall; 0 */
    SPRING_REST,  /* m: g_0 */
    SPRING_X,     /* m: x_t, in space */
    SPRING_Y,
    SPRING_Z,
    SPRING_DUE,  /* s: x_t grows by so much of u, of the velocities with which the step begins */
    SPRING_PART, /* of the step, for which dashpots push; 0: springs do not */
    SPRING_BETA,
    SPRING_HELD,  /* 1: a bond that holds, or that has broken, of bodies that have not parted; 0 */
    SPRING_GIVEN, /* J: what breaking has given up in this interval */
    SPRING_SN,    /* N s/m: h S c_n; 0: there are no bonds */
    SPRING_ST,
    SPRING_SW,    /* J: S w, */
    SPRING_SETA,  /* N m s: S eta of the damage */
    SPRING_FRESH, /* beta of a bond that is made when bodies meet; 0: none is */
    SPRING_TOUCH, /* m: bodies at this gap touch */
    SPRING_COUNT
};

/* A bond of less is broken: it would never end. */
#define BETA_LEAST 1e-3

/* Lanes whose springs push, and those whose bond holds */
ALWAYS_INLINE vm small_spring_acts(const vd x[SPRING_COUNT])
{
    return lt(splat(0), x[SPRING_KN]) & le(x[SPRING_BETA], splat(0));
}
ALWAYS_INLINE vm small_bond_holds(const vd x[SPRING_COUNT])
{
    return lt(splat(0), x[SPRING_BETA]);
}

/* Lanes whose impacts do not rebound: a bond holds, or would be made */
ALWAYS_INLINE vm small_bond_stills(const vd x[SPRING_COUNT])
{
    vd zero = splat(0);
    return small_bond_holds(x) | (lt(zero, x[SPRING_FRESH]) & le(x[SPRING_HELD], zero));
}

/* p (N s) for u = 0 */
ALWAYS_INLINE void small_bond_pull(const vd x[SPRING_COUNT], const vd n[3], vd gap, vd p[3])
{
    vd zero = splat(0), b2 = x[SPRING_BETA] * x[SPRING_BETA], open = larger(gap, zero);
    for (int i = 0; i < 3; i++)
        p[i] = -(b2 * (x[SPRING_SN] * open * n[i] + x[SPRING_ST] * x[SPRING_X + i]));
}

/* J: of a bond that is stretched so, with beta = 1, in steps of h */
ALWAYS_INLINE vd small_bond_energy(const vd x[SPRING_COUNT], vd gap, double h)
{
    vd open = larger(gap, splat(0)), t2 = dot3(x + SPRING_X, x + SPRING_X);
    return 0.5 * (x[SPRING_SN] * open * open + x[SPRING_ST] * t2) / h;
}

/* The bond when a step of h begins, of a pair that has pushed in the step before where `pushed`: damage by a step that has stretched
   it where `moved`, and making */
ALWAYS_INLINE void small_bond_begin(vd x[SPRING_COUNT], vd gap, vm pushed, vm moved, double h)
{
    vd zero = splat(0), one = splat(1), beta = x[SPRING_BETA];
    vd twice = 2 * small_bond_energy(x, gap, h); // S q
    vd left = (h * x[SPRING_SW] + x[SPRING_SETA] * beta) / (h * twice + x[SPRING_SETA]);
    left = pick(lt(left, beta), left, beta);
    left = pick(moved & lt(x[SPRING_SW], beta * twice), left, beta);
    left = pick(lt(left, splat(BETA_LEAST)), zero, left);
    x[SPRING_GIVEN] = x[SPRING_GIVEN] + 0.5 * (beta * beta - left * left) * twice;
    vm touches = pushed | le(gap, x[SPRING_TOUCH]), held = lt(zero, x[SPRING_HELD]);
    vm parted = ~touches & le(left, zero);
    held = held & ~parted;
    vm made = touches & ~held & lt(zero, x[SPRING_FRESH]);
    x[SPRING_BETA] = pick(made, x[SPRING_FRESH], left);
    x[SPRING_HELD] = pick(held | made, one, zero);
    for (int i = 0; i < 3; i++) x[SPRING_X + i] = pick(made, zero, x[SPRING_X + i]);
}

/* How a pair is when a step of h (s) begins */
struct small_stretch {
    vd n[3], gap, mu;
    vd u[3], spin;  /* m/s; rad by which it turns about n in the step */
    vm pushed;      /* in the step before */
    double h, rise; /* m: of g_0 in a step */
};

/* Where the step begins: x_t, g_0 and the bond. q (N s): minus what springs push by if u = 0; above 0 where they yield, and push later in the step */
ALWAYS_INLINE void small_spring_begin(vd x[SPRING_COUNT], const struct small_stretch *y, vd q[3])
{
    const vd *n = y->n, *u = y->u, gap = y->gap;
    vd zero = splat(0), one = splat(1), *t = x + SPRING_X, due = x[SPRING_DUE], turn[3];
    vd rest = pick(lt(x[SPRING_REST], gap), gap, x[SPRING_REST]), before = dot3(t, t);
    rest = pick(lt(rest, zero), rest, zero);
    vd along = dot3(n, t), un = dot3(n, u), push = x[SPRING_KN] * larger(rest - gap, zero);
    for (int i = 0; i < 3; i++) t[i] = t[i] - along * n[i];
    vd after = dot3(t, t), same = pick(lt(zero, after), root(before / after), one);
    for (int i = 0; i < 3; i++) t[i] = same * t[i];
    for (int i = 0, j = 1, k = 2; i < 3; j = k, k = i++) turn[i] = n[j] * t[k] - n[k] * t[j];
    for (int i = 0; i < 3; i++) t[i] = t[i] + pick(lt(zero, due), y->spin, zero) * turn[i];
    for (int i = 0; i < 3; i++) t[i] = t[i] + due * (u[i] - un * n[i]);
    small_bond_begin(x, gap, y->pushed, lt(zero, due), y->h);
    vm bonded = small_bond_holds(x);
    vd t2 = dot3(t, t), most = pick(lt(zero, push), y->mu * push / x[SPRING_KT], zero);
    vd cut = pick(~bonded & lt(most * most, t2), most / root(t2), one);
    vd qn = pick(lt(zero, x[SPRING_YIELD]), x[SPRING_KN] * (gap - rest), -push);
    for (int i = 0; i < 3; i++) t[i] = cut * t[i], q[i] = qn * n[i] + x[SPRING_KT] * t[i];
    x[SPRING_DUE] = pick(bonded | lt(zero, push), splat(y->h), zero);
    x[SPRING_REST] = rest + y->rise;
    vd since = pick(lt(un, zero), (gap - rest) / (y->h * un), one), was = x[SPRING_PART];
    since = 0.5 + pick(lt(since, one), since, one);
    x[SPRING_PART] = pick(lt(zero, push), pick(lt(zero, was), one, since), zero);
}

/* J: of springs or of a bond, at this gap (m), in steps of h (s) */
ALWAYS_INLINE vd small_spring_energy(const vd x[SPRING_COUNT], vd gap, double h)
{
    vd zero = splat(0), xn = gap - x[SPRING_REST], open = pick(lt(xn, zero), xn, zero);
    vd t2 = dot3(x + SPRING_X, x + SPRING_X), beta = x[SPRING_BETA];
    vd springs = 0.5 * (x[SPRING_KN] * open * open + x[SPRING_KT] * t2) / h;
    return pick(small_bond_holds(x), beta * beta * small_bond_energy(x, gap, h), springs);
}
