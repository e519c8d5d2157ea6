/*
 * contact/seek.h: the pairs of bodies that are near each other, searched again; how long a list of them serves is
 * the affair of contact/neighbours.c. seek.c seeks them.
 *
 * Cost is linear: bodies are sorted by size into levels of a factor of two, each level into the
 * cells of its own grid, and a body looks into the grids of its own and of larger sizes only.
 * Cells are hashed, so that a body far away costs nothing. Bodies that
 * lie within reach of the cell's border look from their images too, which costs as much as the
 * border has bodies.
 */
#pragma once

#include "base/failure.h"
#include "shape/mesh.h"
#include "state/packing.h"
#include "state/placement.h"

/* Bodies and walls, prepared for a search of contacts. */

struct situation {
    const struct packing *p;
    const vec3 *x, *edge;          /* [p->n] m; edges of the cell, NULL: it does not repeat */
    double t;                      /* s: of the walls */
    const struct placed *shaped;   /* NULL: all are balls */
    const struct surface *surface; /* [p->walls] of those that are meshes */
};

/* The surface of wall w; NULL: it is no mesh */
static inline const struct surface *situation_surface(const struct situation *o, int32_t w)
{
    return o->p->wall[w].shape == WALL_MESH ? &o->surface[w] : NULL;
}

struct pair {
    int32_t a, b;    /* bodies, a < b; at least one can move */
    int8_t shift[3]; /* of the cell, when the list was made: b is near a at x_b + shift edge */
};

struct pairs {
    int64_t bodies, n, room; /* bodies; pairs; how many pairs there is memory for */
    struct pair *pair;       /* [n] sorted by (a, b, shift), each once */
    double reach;            /* m: every pair whose gap was at most this when the list was made */
    int part,
        parts; /* parts > 1: only those that this part of the bodies finds, of so many parts; sorted among themselves */
};

/*
 * s->pair[s->n] = every pair whose gap is at most s->reach (m), the s->bodies bodies at x (m) and the cell's edges
 * at edge[3] (m). Returns 0, EX_SOFTWARE, or EX_DATAERR where bodies crowd, or are more than three cells apart.
 */
int seek_pairs(struct pairs *s, const struct packing *p, const vec3 *x, const vec3 edge[3],
               struct failure *failure);
/* Sorts all that parts have found. False when memory is short. */
bool pairs_sort(struct pairs *s);
