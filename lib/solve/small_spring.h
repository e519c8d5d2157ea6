/*
 * solve/small_spring.h: contacts with a stiffness in small steps, in LANES lanes: springs and dashpots along n and across,
 * with Coulomb's law. With g the gap where the step of length h begins, x_n = g - g_0 and x_t the stretches of the springs there,
 *
 *     f_n = max(0, - h k_n x_n - G_n u_n) where x_n < 0, else 0
 *     f_t = - h k_t x_t - G_t u_t, on the disc of mu f_n,          G = 2 zeta h sqrt(k/W)
 *
 * with u the velocities after the step, so that dashpots lose energy at any h. x is explicit: without dashpots this is the
 * leapfrog scheme, which keeps the energy of an oscillator and is stable for k h^2 W < 4. zeta is the damping ratio with which a
 * pair alone rebounds with its restitution, e_n along n and e_t across [step/small_springs.h]. As of one solve per step
 * [contact/spring.h], k_t x_t is at most mu k_n |x_n|, x_t turns with n and the mean spin of the pair, and g_0 is the gap with
 * which bodies that overlap are first seen, which rises to 0.
 */
#pragma once

#include "solve/local.h"

/* What a pair has, each in its place of x[] */
enum small_spring {
    SPRING_KN, /* N s/m: h k_n; 0: the pair is rigid */
    SPRING_KT,
    SPRING_GN, /* kg */
    SPRING_GT,
    SPRING_REST, /* m: g_0 */
    SPRING_X,    /* m: x_t, in space */
    SPRING_Y,
    SPRING_Z,
    SPRING_DUE, /* s: x_t grows by so much of u, of the velocities with which the step begins */
    SPRING_COUNT
};

/* Where the step begins: x_t and g_0. u, spin: of the step before, m/s, and rad by which the pair turns about n in this one.
   rise (m): of g_0 in a step. q (N s): what the springs do not push by, 0 where x_n >= 0 */
ALWAYS_INLINE void small_spring_begin(vd x[SPRING_COUNT], const vd n[3], vd gap, const vd u[3],
                                      vd spin, vd mu, double rise, double h, vd q[3])
{
    vd zero = splat(0), one = splat(1), *t = x + SPRING_X, due = x[SPRING_DUE], turn[3];
    vd rest = pick(lt(x[SPRING_REST], gap), gap, x[SPRING_REST]), before = dot3(t, t);
    rest = pick(lt(rest, zero), rest, zero);
    vd along = dot3(n, t), un = dot3(n, u), push = x[SPRING_KN] * larger(rest - gap, zero);
    for (int i = 0; i < 3; i++) t[i] = t[i] - along * n[i];
    vd after = dot3(t, t), same = pick(lt(zero, after), root(before / after), one);
    for (int i = 0; i < 3; i++) t[i] = same * t[i];
    for (int i = 0, j = 1, k = 2; i < 3; j = k, k = i++) turn[i] = n[j] * t[k] - n[k] * t[j];
    for (int i = 0; i < 3; i++) t[i] = t[i] + pick(lt(zero, due), spin, zero) * turn[i];
    for (int i = 0; i < 3; i++) t[i] = t[i] + due * (u[i] - un * n[i]);
    vd t2 = dot3(t, t), most = pick(lt(zero, push), mu * push / x[SPRING_KT], zero);
    vd cut = pick(lt(most * most, t2), most / root(t2), one);
    for (int i = 0; i < 3; i++) t[i] = cut * t[i], q[i] = push * -n[i] + x[SPRING_KT] * t[i];
    x[SPRING_DUE] = pick(lt(zero, push), splat(h), zero);
    x[SPRING_REST] = rest + rise;
}

/* J: of springs, h: s */
ALWAYS_INLINE vd small_spring_energy(const vd x[SPRING_COUNT], vd xn, double h)
{
    vd zero = splat(0), open = pick(lt(xn, zero), xn, zero);
    return 0.5 * (x[SPRING_KN] * open * open + x[SPRING_KT] * dot3(x + SPRING_X, x + SPRING_X)) / h;
}
