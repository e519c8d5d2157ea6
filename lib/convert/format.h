/*
 * convert/format.h: the table of the formats that nsd-export writes. A format is a file
 * (export/NAME.c) and its line in the table.
 */
#ifndef NSD_FORMAT_H
#define NSD_FORMAT_H

#include "base/failure.h"
#include "convert/export_frame.h"

#include <stdio.h>

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
    format_tsv, format_stl, format_gsd, format_lammps_data, format_ondem;

/* The k-th from 0; NULL behind the last. */
const struct format *format_at(int k);
/* The format that a file of this name has, by its ending; NULL: none. */
const struct format *format_of_name(const char *name);

#endif
