/*
 * measure/snapshot.h: what measures look at: a frame's packing and its contacts, what was asked, and
 * what is remembered of frames before.
 */
#pragma once

#include "measure/region.h"
#include "measure/table.h"
#include "measure/tensor.h"
#include "state/contact.h"
#include "state/packing.h"
#include "state/report.h"
#include "state/selection.h"

/*
 * How the room of the grains is deformed from frame to frame: dx = F dX, by the edges
 * of the periodic cell and, along other axes, by how far walls are apart that are upright to the axis,
 * or the bodies reach where there are none.
 *
 * The edges of a cell are a basis of a lattice, and a run may change it [state/placement.h]. From one frame to
 * the next E' = F E N, N whole numbers of determinant 1 or -1: those that leave F nearest to what the
 * edges' rates say.
 */

/* All zero to begin with. */
struct deformed {
    bool known;      /* of a frame */
    bool lost;       /* the frames were too far apart to follow the cell's edges */
    double t;        /* s */
    struct tensor F; /* since the first frame */
    vec3 span[3];    /* m: edges, or the extents along the axes */
    vec3 rate[3];    /* m/s: of the edges; 0 of extents */
};

/* To the frame that the packing is: the first one has F = 1. */
void deformed_follow(struct deformed *d, const struct packing *p);

/* What is remembered of a frame, for measures of what happens between frames. */

struct frame_memory {
    int64_t step;
    double t;             /* s */
    struct deformed form; /* since the first frame that was kept here */
    int64_t n;
    struct frame_memory_body {
        int32_t id;
        double mass; /* kg */
        vec3 x;      /* m: unwrapped, where the cell repeats: the way since it was built */
        double
            entered; /* s: when it came into the region [measure/follow.h]; NaN: it is not there */
        bool whole;  /* it was seen to come, else it was there in the first frame */
        bool chosen; /* measures keep to it [measure/follow.h] */
    } * body;        /* [n] sorted by id */
    int64_t pairs;
    struct frame_memory_pair {
        int32_t a, b;      /* ids, a < b; of wall w a = -1-w */
        double began;      /* s */
        bool whole;        /* as above */
    } * pair;              /* [pairs] that touch, sorted; NULL: not looked at */
    struct wall_sums sums; /* over steps, of walls */
    /* bodies in front of each pixel, over `covered` frames [measure/silhouette.h]; NULL: not looked at */
    uint32_t *cover;
    int64_t covered;
    int dim;
};

/* k = the packing now, in place of what was kept; all zero to begin with. Returns 0 or EX_SOFTWARE. */
int frame_memory_set(struct frame_memory *k, const struct packing *p, struct failure *failure);
void frame_memory_free(struct frame_memory *k);
/* The body with this id; NULL: it was not there. */
const struct frame_memory_body *frame_memory_find(const struct frame_memory *k, int32_t id);
/* For qsort: of kept pairs; and the pair of the same bodies, NULL: it did not touch, or k is NULL. */
int frame_memory_pair_order(const void *a, const void *b);
const struct frame_memory_pair *frame_memory_pair_find(const struct frame_memory *k,
                                                       const struct frame_memory_pair *pair);

/* m: where body i is, with the edges added that were taken off it */
vec3 frame_memory_place(const struct packing *p, int64_t i);
/* m: from the kept place to the present one, the shortest among images where the cell repeats */
vec3 frame_memory_way(const struct packing *p, vec3 from, vec3 to);

/* A photograph: bytes by rows, the lowest one first; 0 is black */
struct photo {
    int64_t w, h;
    uint8_t *grey; /* NULL: there is none */
};

/* What the user asks for in addition to the measures' names; the same for all frames */
struct asked {
    bool boxed;
    double lo[3], hi[3]; /* m: the box that measures keep to */
    int axis;            /* of layers: 0 x, 1 y, 2 z, 3 shells around the line along z; -1: up */
    int64_t layers;
    vec3 point;    /* m: of torques, of shells, of the plane */
    vec3 normal;   /* of the plane that is crossed; 0: none is asked for */
    double radius; /* m: of the disc in it that is crossed; INFINITY: the plane */
    int64_t bins;  /* of histograms */
    char only
        [256]; /* names of walls, groups and materials, numbers of walls, to which measures keep; "": all */
    double wear;     /* 1/Pa: coefficient of wear; 0: that of each wall */
    double distance; /* m: up to which pairs are counted; 0: three mean diameters */
    char tracer
        [64]; /* the material whose mixing with the others is measured, or large; "": see measure/mixing.c */
    double sample;    /* m: edge of the samples of a mixture; 0: three mean diameters */
    int view;         /* axis of the projection of a silhouette: 0 x, 1 y, 2 z */
    double window[4]; /* m: its left, right, lower and upper edge; all 0: none is asked for */
    int64_t pixels;   /* across, where there is no photograph */
    struct photo photo;
};

struct snapshot {
    const struct packing *p;
    const struct contacts *s;    /* NULL: the document has none; s->found NULL: not solved */
    bool moved;                  /* the contacts have led to these positions, not from them */
    const struct report *report; /* of the step that the contacts belong to; NULL: none is known */
    const struct asked *asked;
    double
        unconverged; /* steps since the frame before, or of the first all, that have not converged; NaN: not known */
    const struct frame_memory *first, *before; /* frames before this one; NULL: it is the first */
    struct region whole;                       /* all there is, and its volume */
    struct region region;                      /* the box, or else the whole */
    struct selection only;                     /* of this frame, what asked->only names */
};

/* s = a frame. Regions and names are found; the rest is borrowed. Returns 0, EX_DATAERR where a name of `asked` is not
   in the document, or EX_SOFTWARE; to be freed in any case. */
int snapshot_init(struct snapshot *s, const struct packing *p, const struct contacts *contacts,
                  bool moved, const struct asked *asked, struct failure *failure);
void snapshot_free(struct snapshot *s);
/* Do measures keep to the body; to the wall, or any of its faces; to this face? All, where none is named. */
bool snapshot_body(const struct snapshot *s, int64_t i);
bool snapshot_wall(const struct snapshot *s, int32_t wall);
bool snapshot_face(const struct snapshot *s, int32_t wall, int32_t face);

/* A row of t for each layer asked for: its beginning and end (m), and what add() puts behind them, at `at`; a reason
   in t where there are no such layers. Returns 0 or EX_SOFTWARE. */
typedef void layer_function(struct table *t, const struct snapshot *s, const struct region *layer,
                            double *at, const void *with);
int snapshot_layers(const struct snapshot *s, struct table *t, layer_function *add,
                    const void *with, struct failure *failure);
/* The axis of layers: the asked one, or the one nearest to up */
int snapshot_axis(const struct snapshot *s);
