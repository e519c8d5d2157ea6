/*
 * solve/faces.h: contacts that repeat one another, found in W alone.
 *
 * The k contacts of one pair of rigid bodies, a face, move with 6 numbers (3 in the plane), and not
 * with 3 k (2 k): their rows of W are combinations of as many of them, the pivots,
 *
 *     W = T S T',     S = W of the pivots' rows and columns,  T block-diagonal, by faces.
 *
 * They have the same neighbours in W, by which they are found. A contact that repeats nothing is a
 * face of its own, T = 1.
 */
#ifndef NSD_FACES_H
#define NSD_FACES_H

#include "problem/delassus.h"

#include <stdbool.h>

enum { FACE_CONTACTS_MAX = 16 }; /* contacts; more are several faces */

struct face {
    int32_t *contact;  /* [count] */
    int32_t count, at; /* its contacts; its first row of S */
    int rows, rank;    /* d count; and how many of them are pivots. Where these are fewer: */
    double *T;         /* [rows][rank] */
    double *M, *N; /* [rows][rank], [rows][rows - rank]: x = M w + N n has T' x = w, whatever n */
};

struct faces {
    int32_t n;    /* faces */
    int32_t size; /* of S */
    struct face *face;
    int32_t *row; /* [size] which rows of W they are */
    /* S by rows: entry k of row i is S[k] in column col[k], first[i] <= k < first[i+1] */
    int32_t *first, *col;
    double *S;
    int32_t *contact; /* the faces' */
    double *room;     /* their matrices' */
};

/* Of a W with blocks of order 1; false when memory is short. */
bool faces_init(struct faces *, const struct delassus *);
void faces_free(struct faces *);

#endif
