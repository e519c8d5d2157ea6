/*
 * measure/snapshot.h: what measures look at: a frame's packing and its contacts, what was asked, and
 * what is remembered of frames before.
 */
#ifndef NSD_SNAPSHOT_H
#define NSD_SNAPSHOT_H

#include "state/selection.h"
#include "state/contact.h"
#include "state/packing.h"
#include "measure/kept.h"
#include "measure/region.h"
#include "measure/table.h"

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
        [256]; /* names of walls, groups and kinds, numbers of walls, to which measures keep; "": all */
    double wear;     /* 1/Pa: coefficient of wear; 0: that of each wall */
    double distance; /* m: up to which pairs are counted; 0: three mean diameters */
    char tracer
        [64]; /* the kind whose mixing with the others is measured, or large; "": see measure/mixing.c */
    double sample; /* m: edge of the samples of a mixture; 0: three mean diameters */
};

struct snapshot {
    const struct packing *p;
    const struct contacts *s; /* NULL: the document has none; s->found NULL: not solved */
    bool moved;               /* the contacts have led to these positions, not from them */
    const struct asked *asked;
    double
        unconverged; /* steps since the frame before, or of the first all, that have not converged; NaN: not known */
    const struct frame_memory *first, *before; /* frames before this one; NULL: it is the first */
    struct region whole;               /* all there is, and its volume */
    struct region region;              /* the box, or else the whole */
    struct selection only;                /* of this frame, what asked->only names */
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

#endif
