/*
 * solve/system.h: the linear system of the solvers that treat all contacts at once,
 *
 *     (L W + D) x = b,     L and D block-diagonal, by contacts.
 *
 * The matrix factorised is only as large as S, where W = T S T' [solve/faces.h]. With w = T' x, and
 * x = M w + N n all x that have this w, the rows of a face read (L T) S w + D M w + D N n = b. An
 * orthogonal transformation of the rows turns D N into a triangle above zeros. The rows with the
 * zeros no longer contain n,
 *
 *     (L' S + D') w = b',
 *
 * and the rows of the triangle then give n. D need not be regular for that. In a wall of bricks
 * with 4 contacts a face this halves the unknowns, and takes an eighth of the time.
 *
 * What all contacts have in common, W = blocks + J J^T, would fill the matrix, and is added by the
 * formula of Sherman, Morrison and Woodbury: with A = L blocks + D and Z = A^-1 L J
 *
 *     x = A^-1 b - Z (1 + J^T Z)^-1 J^T A^-1 b.
 */
#pragma once

#include "solve/scaled.h"

struct system;

/* Borrows a. NULL where memory is short or, with *too_large set, the factors would need more than
   this many bytes. */
struct system *system_new(const struct scaled *a, double bytes, bool *too_large);
void system_free(struct system *s);

/* ns of a Newton step with it [solve/solver.h] */
double system_price(const struct system *s);
/* ns of system_new(), at most; and of a Newton step with the new system, at least */
double system_price_new(const struct scaled *a);
double system_price_least(const struct scaled *a);

/*
 * x[n d] is b before and the solution after; L and D are [n][9], row-major 3 x 3 of which d x d is
 * read. False where the relative residual of the solution is above 1e-4, or the matrix is singular.
 * L and D are borrowed until the next call.
 */
bool system_solve(struct system *s, const double *L, const double *D, double *x);
/* The same with L, D and the factors of the last system_solve(), for another b. */
bool system_solve_again(struct system *s, double *x);

/* +1 or -1: the sign of det(L W + D) in the last system_solve(), but for a factor that is always
   the same for this system: of use only to see that the sign changes. */
int system_sign(const struct system *s);
