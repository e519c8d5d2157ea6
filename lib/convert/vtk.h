/*
 * convert/vtk.h: what documents have for VTK besides their grains [file/vtkhdf.h]: the surfaces of grains
 * that are no balls, and the walls, as polygons.
 */
#pragma once

#include "base/output.h"
#include "file/vtkhdf.h"

extern const struct vtkhdf_parts vtk_parts;

/*
 * The list of a series' files and their times that ParaView opens (.pvd). It is whole
 * after every file, so that ParaView can look on while a run continues.
 */

struct pvd {
    FILE *out; /* NULL: not begun */
    struct output file;
};

/* Begins the list in a file of this name. EX_IOERR: it cannot be written. */
int pvd_begin(struct pvd *list, const char *path, struct failure *failure);
/* A file of the series, of this time (s); the name is relative to the list's. */
int pvd_add(struct pvd *list, const char *name, double time, struct failure *failure);
int pvd_end(struct pvd *list, struct failure *failure);
