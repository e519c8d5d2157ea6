/*
 * solve/faces.h: contacts that repeat one another, found in W alone.
 *
 * The k contacts of one pair of rigid bodies, a face, have 3 k velocities (2 k in the plane), but
 * the bodies move relative to each other in 6 ways only (3). So a face's rows of W are linear
 * combinations of as many of them, the pivots:
 *
 *     W = T S T',     S = W of the pivots' rows and columns,  T block-diagonal, by faces.
 *
 * The contacts of a face are recognised by their having the same neighbours in W. A contact that
 * repeats no other is a face of its own, with T = 1.
 */
#pragma once

#include "solve/delassus.h"

#include <stdbool.h>

enum { FACE_CONTACTS_MAX = 16 }; /* contacts of a face; a pair with more has several faces */

struct face {
    int32_t *contact; /* [count] */
    int32_t count;    /* contacts */
    int32_t at;       /* its first row of S */
    int rows, rank;   /* d count; how many of them are pivots */
    /* Only where rank < rows: all x with T' x = w are x = M w + N n, for any n. */
    double *T, *M; /* [rows][rank] */
    double *N;     /* [rows][rows - rank] */
};

struct faces {
    int32_t n;    /* faces */
    int32_t size; /* rows of S */
    struct face *face;
    int32_t *row; /* [size] row i of S is row[i] of W */
    /* S by rows: entry k of row i is S[k] in column col[k], first[i] <= k < first[i+1] */
    int32_t *first, *col;
    double *S;
    int32_t *contact; /* holds the faces' contacts */
    double *room;     /* holds their matrices */
};

/* W's blocks must be of order 1 (solve/scaled.h). False when memory is short: nothing to free. */
bool faces_init(struct faces *f, const struct delassus *W);
void faces_free(struct faces *f);
