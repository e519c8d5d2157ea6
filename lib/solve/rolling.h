/*
 * solve/rolling.h: one contact with rolling and pivoting friction [Acary & Bourrier 2021]: find
 *
 *     u = W x + b,   x = (r_n, r_t, m_n, m_t),   u = (u_n, u_t, omega_n, omega_t)
 *
 *     |r_t| <= mu r_n,  |m_n| <= mu_p r_n,  |m_t| <= mu_r r_n,
 *
 * u_n on Signorini's condition, and each of the other three parts of u against its part of x, where
 * that is at its limit, or 0. The five local methods are those of law/local_NAME.h with more parts:
 * u^ = u + (mu |u_t| + mu_p |omega_n| + mu_r |omega_t|) n, and the cone K of all three limits.
 *
 * omega is the angular velocity of b relative to a, turned a quarter in the tangent plane,
 * omega_t = (-omega_2, omega_1), and so is the moment. Between balls W is then four numbers:
 *
 *     u_n = w_n r_n + b_n              u_t = w_t r_t + k m_t + b_t
 *     omega_n = w_p m_n + b_p          omega_t = k r_t + w_r m_t + b_r
 *
 * and between other bodies it is any symmetric, positive definite matrix.
 *
 * Moments are divided, and angular velocities multiplied, by a length that makes w_r about w_t, so
 * that all parts of x are impulses (N s), all of u velocities (m/s), and one step rho suits them.
 */
#pragma once

#include "solve/rolling_parts.h"

/* Solves the contact by the local method. */
void rolling_solve(enum method_id method, struct rolling *q, const struct local_opt *opt);
/* What exact falls back on where W is full and Newton's method fails: x by a search for r_n, where b_n < 0.
   False: there is no solution in reach. */
bool rolling_search(struct rolling *q);
/* u = W x + b */
void rolling_velocity(const struct rolling *q, const double x[ROLLING], double u[ROLLING]);
/* p = the nearest point of K */
void rolling_project(const struct rolling *q, const double tau[ROLLING], double p[ROLLING]);
/* |x - proj(x - rho u^)|^2 */
double rolling_natural2(const struct rolling *q, double rho, const double x[ROLLING],
                        const double u[ROLLING]);
/* u.x + (mu |u_t| + mu_p |omega_n| + mu_r |omega_t|) r_n */
double rolling_bipotential(const struct rolling *q, const double x[ROLLING],
                           const double u[ROLLING]);
/* kg^-1: of W, the largest eigenvalue */
double rolling_lambda(const struct rolling *q);
