/*
 * step/project.h: moves bodies that overlap apart, without giving them a velocity: the direct
 * projection of Siconos [Acary 2013].
 *
 * After a step, contact c will at the next predicted position have the gap
 *
 *     g_c + dt u_n,   u_n = n . (v_b - v_a) of the new velocities,
 *
 * to first order, and for balls it does not depend on rotations. Displacements d = M^-1 P lambda,
 * lambda >= 0 along the normals, are sought with
 *
 *     g_c + dt u_n + n . (d_b - d_a) >= -slop,   and = -slop where lambda_c > 0:
 *
 * (and what freedoms beyond the bodies' open [state/freedom.h]: pistons and edges that yield
 * give way, other walls do not) of all that part the bodies, the least in the norm of M. A few
 * Gauss-Seidel sweeps, the same on every machine; what they leave is left to the next step. An
 * impact that rebounds out of its overlap in time is not touched.
 */
#pragma once

#include "state/contact.h"
#include "state/packing.h"

/*
 * Contacts sorted into levels, so that threads can visit them in the order of one thread.
 *
 * The level of a contact is one above the highest level of the earlier contacts of its bodies. Contacts of one
 * level have no body in common. Visiting level after level changes every body by the same contacts in the same
 * order as visiting contact after contact, so results have the same bits.
 */

struct levels {
    int64_t n;        /* levels; 0: not made */
    int64_t *first;   /* [n + 1] level k has contact[first[k]] .. contact[first[k + 1] - 1] */
    int32_t *contact; /* [contacts] rows of the contacts, by level and in their order there */
};

/* The levels of s, whose rows are of `bodies` bodies; walls do not count. Returns 0, or -1 when memory is short.
   levels_free() is due in any case. */
int levels_init(struct levels *l, const struct contacts *s, int64_t bodies);
void levels_free(struct levels *l);

/* A body, with what a sweep reads and changes of it side by side */
struct displaced {
    vec3 d;    /* m */
    double im; /* 1/kg; 0: it does not move */
};

/* What the moves of a step have done, velocities being what they were, and the energy after them */
struct projected {
    double work;     /* J: against gravity, - sum m g . dx */
    double spin[3];  /* N m s: of angular momentum, sum m dx x v */
    double peculiar; /* J: energy_peculiar(), which the caller finds */
};

/* Of a packing of which several processes have a part each, by contacts that each is in one of: what is asked
   of the others */
struct project_share {
    void *with;
    const bool *own;     /* [bodies] that count here */
    const double *brake; /* [contacts] by which a contact's step is shortened, at least 1 */
    /* Is it so in any process? */
    bool (*any)(void *with, bool here);
    /* The processes' displacements of d[n] since the last time are added up; more: is another sweep worth
       it here? Returns whether it is to any. */
    bool (*after_sweep)(void *with, struct displaced *d, bool more);
};
int project_shared(struct packing *p, const struct contacts *s, const struct project_share *share,
                   struct projected *did, struct failure *failure);

/* The bodies after their step by these contacts; did, or NULL: what that has done. Returns 0 or EX_SOFTWARE. */
int project_apart(struct packing *p, const struct contacts *s, struct projected *did,
                  struct failure *failure);
