/*
 * solve/assembly.h: the matrices of a packing's contact problem, as FCLIB needs them.
 *
 * Contact by contact in the packing's order. Coulomb's and Signorini's laws do not change when u_n
 * and u_t are scaled, so what is assembled is
 *
 *     D u~ = W r + q,   q = D u~_free,   D = diag(1 + e_n, 1 + e_t, 1 + e_t),
 *
 * with the symmetric W of the bodies, not D^-1 W. The unknowns of the global form,
 *
 *     M v = H r + f,   D u~ = H^T v + w,   f = M v_free,
 *
 * are the velocities of the movable bodies that have a contact, in the problem's order: (vx, vy,
 * vz, wx, wy, wz), or (vx, vy, wz) in the plane; after them the speed of each freedom that moves a
 * contact [solve/coupling.h], whose row of H are its J, and whose v_free is s + dt f/m. Where
 * contacts have levers, y = I^1/2 w stands in the place of w, with the inertia 1 [solve/bundle.h].
 */
#pragma once

#include "base/matrix.h"
#include "solve/problem.h"

struct assembly {
    const struct problem *p;
    int64_t *slot;      /* [n] contact c is in slot[c] of p */
    int32_t *end;       /* [2 n] bodies a and b of contact c at 2 c, 2 c + 1; -1: immovable */
    struct lists of;    /* of each body: its places in end[] */
    struct lists yield; /* of each freedom: its places in p->coupling->of[] */
    double *q, *w;      /* [n d] D u~ at v_free, and with all unknowns at rest, m/s */
    struct body *free;  /* [p->bodies] at v_free */
    double *pulled;     /* [freedoms] m/s, rad/s: what cohesion makes of them; NULL: nothing */
};

/* All return 0, EX_SOFTWARE, or EX_DATAERR where the problem is too large for FCLIB's 32-bit
   indices. What they fill is to be freed in any case. */
int assembly_init(struct assembly *A, const struct problem *p, struct failure *failure);
/* W by rows */
int assembly_W(const struct assembly *A, struct stored *W, struct failure *failure);
/* W block by block, with q, mu and r = 0, and what all contacts have in common in J; nothing to free where it
   fails */
int assembly_blocks(const struct assembly *A, struct delassus *W, struct failure *failure);
/* M and H by columns, and f[M->n] */
int assembly_MH(const struct assembly *A, struct stored *M, struct stored *H, double **f,
                struct failure *);
void assembly_free(struct assembly *A);
