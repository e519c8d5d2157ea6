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

/* All zero to begin with */
struct pvd {
    char *entries; /* [room] a text, of the files so far */
    size_t length, room;
};

/* Adds a file of this time (s) to the list at path; its name, of less than 100 bytes, is relative to the list's. Returns 0, EX_IOERR or
   EX_SOFTWARE. */
int pvd_add(struct pvd *list, const char *path, const char *name, double time,
            struct failure *failure);
void pvd_free(struct pvd *list);
