/*
 * draw/page_meta.h: what is kept of a page while it is written, and said at its end: what its numbers are
 * relative to, as the JSON that its program reads.
 */
#ifndef NSD_PAGE_META_H
#define NSD_PAGE_META_H

#include "draw/walls.h"

#include <stdio.h>

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
    int32_t kinds;
    char **kind_name; /* [kinds] of the first frame */
    bool solved;      /* some frame has contacts with reactions */
    struct page_kept grains, walls, shapes;
    struct extent seen;                           /* m: of all grains and finite walls */
    double fastest, spin, radius[2], force, push; /* m/s, rad/s, m, N, N: of all frames */
    int most;                                     /* contacts of a grain that push */
};

struct json_t; /* jansson's */
/* The element "meta"; NULL: no memory */
struct json_t *page_meta(const struct page *p);

#endif
