/* draw/page_data.h: numbers as the page has them: small, packed by zlib, in base64. */
#pragma once

#include "draw/walls.h"
#include "state/packing.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Numbers one after another, in memory that is large enough for all of them */
struct chunk {
    unsigned char *at;
    size_t n; /* bytes so far */
};

void chunk_put(struct chunk *b, const void *from, size_t size);
void chunk_put_float(struct chunk *b, double x);
void chunk_put_u16(struct chunk *b, int x);

/* x in [-most, most] as a whole number of [-steps, steps]; 0 where it is no number */
int chunk_quantise(double x, double most, int steps);

/* As the script element with the id letter, number; -1: no memory */
int chunk_write(FILE *out, char letter, int64_t number, const struct chunk *b);

/*
 * What is kept of a page while it is written, and said at its end: what its numbers are
 * relative to, as the JSON that its program reads.
 */

/* How far whole numbers reach */
enum { U16 = 65535, I16 = 32767, I8 = 127 };

/* A frame */
struct page_moment {
    int64_t step, n, contacts;     /* of which so many are grains and contacts */
    int64_t grains, walls, shapes; /* numbers of its chunks; -1: none */
    double t, lo[3], quantum[3], vmax, wmax, fmax;
    bool repeats[3]; /* the cell, where it repeats */
    vec3 origin, edge[3];
};

/* A number for each frame, shown as a curve over time */
struct page_curve {
    char *name, *unit;
    double *value; /* [frames]; NAN: none */
};

/* Chunks of one kind, written where it changes */
struct page_kept {
    int64_t n;   /* how many there are */
    void *last;  /* the last of them, */
    size_t size; /* and its bytes */
};

/* All zero to begin with. */
struct page {
    FILE *out;
    const char *name; /* of its file, for messages */
    int dim;
    vec3 up; /* against gravity, of the first frame */
    int64_t frames, room;
    struct page_moment *moment; /* [frames] */
    int curves;
    struct page_curve *curve; /* [curves] */
    int32_t materials;
    char **material_name; /* [materials] of the first frame */
    bool solved;          /* some frame has contacts with reactions */
    struct page_kept grains, walls, shapes;
    struct extent seen;                           /* m: of all grains and finite walls */
    double fastest, spin, radius[2], force, push; /* m/s, rad/s, m, N, N: of all frames */
    int most;                                     /* contacts of a grain that push */
};

struct json_t; /* jansson's */
/* The element "meta"; NULL: no memory */
struct json_t *page_meta(const struct page *p);

/* The shapes of grains as a page has them: triangles, and which of their sides are edges. */

/*
 * u32 shapes, of which the first is the ball, and has no triangles; u32[shapes] triangles of each; f32[9] the
 * corners of each triangle, of a grain of radius 1 in its own axes; u8 of each triangle, a bit k where its
 * side from corner k to the next is an edge of the surface and not a cut through a face.
 *
 * b->at is to be freed in any case. Returns 0 or EX_SOFTWARE.
 */
int page_shapes(struct chunk *b, int dim, const struct shapes *t, struct failure *failure);
