/*
 * convert/import_file.h: packings of other programs: LAMMPS' and LIGGGHTS' data files and dumps, Yade's tables.
 * A file is read by a process of its own [base/bounded.h], and what it says is checked as that of a document.
 */
#pragma once

#include "convert/imported.h"
#include "state/packing.h"

/* Which frame of it, and what it does not say itself */
struct import_wish {
    int dim;       /* 2: discs in the plane z = 0 */
    int64_t frame; /* from 0, or from the end: -1 is the last */
    bool
        has_repeats; /* along which edges of its box it is periodic; else as it says, or not at all */
    bool repeats[3];
};

/*
 * p = the balls of the file at path. Kinds are named by the file's numbers for them, "1", "2" ...; a mass that the file does
 * not have is 0; the cell is the box, where it is periodic. Returns 0, EX_DATAERR, EX_NOINPUT or EX_SOFTWARE.
 */
int import_file(struct packing *p, const char *path, const struct import_wish *wish,
                struct failure *failure);

/* Of n bytes with a 0 behind them, as of a file of this name, in this process: for who tests the readers */
int import_bytes(struct packing *p, const char *name, const char *bytes, int64_t n,
                 const struct import_wish *wish, struct failure *failure);
