/*
 * convert/format.h: the table of the formats that nsd-export writes. A format is a file
 * (export/NAME.c) and its line in the table.
 */
#pragma once

#include "base/failure.h"
#include "state/contact.h"
#include "state/packing.h"
#include "state/selection.h"

#include <stdio.h>

/*
 * What is exported of one moment, and the parts of it: grains, contacts, walls,
 * the cell, the surfaces of grains that are no balls. Files of other programs take either a part as a sheet (convert/sheet.h), or the grains.
 */

enum part { PART_GRAINS, PART_CONTACTS, PART_WALLS, PART_CELL, PART_SURFACES, PART_COUNT };
extern const char *const part_name[PART_COUNT];

struct export_frame {
    const struct packing *packing;
    const struct contacts *contacts; /* NULL: there are none in the document */
    int detail;                      /* of balls made of triangles: 20 * 4^detail of them */
    void **kept;                     /* what a format keeps from moment to moment of its file */
    const struct selection *only; /* walls, bodies and their contacts that are wanted; NULL: all */
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

struct format {
    const char *name, *ending; /* of --to, and of files */
    const char *help;          /* a few words */
    bool joins;                /* moments follow one another in one file; else a file each */
    bool parts;                /* takes any part; else what it has is the grains */
    bool binary;
    bool collected; /* ParaView collects its files in a .pvd */
    /*
     * Writes a moment; `first` of its file. 0 also where the disk is full: ferror(out) tells. Returns
     * EX_SOFTWARE when memory is short.
     */
    int (*write)(FILE *out, const struct export_frame *m, enum part part, bool first,
                 struct failure *failure);
    /* What comes behind the last frame of a file, by what `write` has kept (*m->kept), which it frees; NULL:
       nothing does. */
    int (*end)(FILE *out, void *kept, struct failure *failure);
};

extern const struct format format_vtp, format_vtu, format_xyz, format_lammps, format_csv,
    format_tsv, format_stl, format_gsd, format_lammps_data;

/* The k-th from 0; NULL behind the last. */
const struct format *format_at(int k);
/* The format that a file of this name has, by its ending; NULL: none. */
const struct format *format_of_name(const char *name);

/*
 * A packing of some of the bodies of another, for formats that have grains only.
 */

struct some_bodies {
    struct packing bodies;  /* owns the bodies */
    struct packing packing; /* these with all else of the other packing, which is borrowed */
};

/* Bodies of groups and materials that c names, in their order. Returns 0, or EX_SOFTWARE with nothing to free. */
int some_bodies_init(struct some_bodies *s, const struct packing *p, const struct selection *c,
                     struct failure *failure);
void some_bodies_free(struct some_bodies *s);
