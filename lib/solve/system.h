/*
 * solve/system.h: the linear system of the solvers that see all contacts at once,
 *
 *     (L W + D) x = b,     L and D block-diagonal, by contacts.
 *
 * What is factorised is of the size of S, W = T S T' [solve/faces.h]. With w = T' x and all x = M w + N n
 * that have it, the rows of a face read (L T) S w + D M w + D N n = b; an orthogonal transformation
 * takes D N to a triangle above zeros, so that n drops out of the last rows,
 *
 *     (L' S + D') w = b',
 *
 * and follows from the first ones. D need not be regular for that. In a wall of bricks with 4 contacts
 * a face this halves the unknowns, and takes an eighth of the time.
 */
#ifndef NSD_SYSTEM_H
#define NSD_SYSTEM_H

#include "solve/scaled.h"

struct system;

/* Borrows a. NULL where memory is short or, *too_large, the factors would need more than `bytes`. */
struct system *system_new(const struct scaled *a, double bytes, bool *too_large);
void system_free(struct system *s);

/* Of a Newton step with it [solve/prices.h] */
double system_price(const struct system *s);
/* What it costs to make one, at most; and what a Newton step with it will cost, at least */
double system_price_new(const struct scaled *a);
double system_price_least(const struct scaled *a);

/*
 * x[n d], b before and the solution after; L and D [n][9], row-major 3 x 3 of which d x d is read.
 * False where the solution is not true to 1e-4.
 */
bool system_solve(struct system *s, const double *L, const double *D, double *x);
/* The same with the L and D of the last time, which are still there, factorised already. */
bool system_solve_again(struct system *s, double *x);

/*
 * The sign of det(L W + D), +-1, of the last time; but for a factor that is the system's, so that it
 * tells when the sign changes.
 */
int system_sign(const struct system *s);

#endif
