/*
 * convert/export_frame.h: what is exported of one moment, and the parts of it: grains, contacts, boundaries,
 * the cell, the surfaces of grains that are no balls. Files of other programs take either a part as a sheet (convert/sheet.h), or the grains.
 */
#ifndef NSD_EXPORT_FRAME_H
#define NSD_EXPORT_FRAME_H

#include "state/selection.h"
#include "state/contact.h"
#include "state/packing.h"

#include <stdio.h>

enum part { PART_GRAINS, PART_CONTACTS, PART_BOUNDARY, PART_CELL, PART_SURFACES, PART_COUNT };
extern const char *const part_name[PART_COUNT];

struct export_frame {
    const struct packing *packing;
    const struct contacts *contacts; /* NULL: there are none in the document */
    int detail;                      /* of balls made of triangles: 20 * 4^detail of them */
    void **kept;                     /* what a format keeps from moment to moment of its file */
    const struct selection
        *only; /* boundaries, bodies and their contacts that are wanted; NULL: all */
    void (*tell)(int64_t done, int64_t of); /* how far it is, for who looks on; NULL: nobody does */
};

/* Row `done` of so many is to be written: once in a while that is told. */
static inline void moment_tell(const struct export_frame *m, int64_t done, int64_t of)
{
    if (m->tell && done % 4096 == 0) m->tell(done, of);
}

/* Is body i wanted? */
static inline bool export_frame_has(const struct export_frame *m, int64_t i)
{
    return !m->only || !m->only->bodies || selection_body(m->only, m->packing, i);
}

/*
 * A box around all: the cell where it repeats, and along its other edges, or without any, as far as
 * the grains reach. In the plane it is one metre thick, the discs in its middle.
 */
struct box {
    bool repeats[3];
    vec3 origin, edge[3]; /* m */
};
void export_frame_box(struct box *box, const struct packing *packing);
/* " I J K": the edges to add to the position of body i for the way that it has gone; nothing where the cell is not
   periodic */
void export_put_image(FILE *out, const struct packing *p, int64_t i);

#endif
