/*
 * file/vtkhdf.h: the group /VTKHDF of a document [nsd-format(5)], by which VTK, ParaView and pyvista open it
 * themselves [VTKHDF 2.1]. VTK reads no other group, and nsd never reads this one.
 *
 * Grains are points (PolyData, a vertex each). Where bodies stay, their numbers are not stored again: positions and
 * velocities are virtual datasets over /particles/all, radii, masses and ids hard links. Where bodies come and
 * go, those of each frame follow one another.
 *
 * With parts besides the grains, /VTKHDF is a PartitionedDataSetCollection with a PolyData for each part.
 */
#pragma once

#include "file/h5.h"
#include "state/packing.h"

enum { VTKHDF_COLUMNS = 4 };

/* Cells of a part at a moment: what they are of is told by the columns. */
struct vtkhdf_cells {
    int64_t points, cells, corners;
    const vec3 *x;         /* [points] m */
    const int64_t *corner; /* [corners] points of all cells, one after another */
    const int64_t *end;    /* [cells] one past a cell's last in corner[] */
    bool lines;            /* else polygons */
    int columns;
    struct {
        const char *name;
        const int32_t *value; /* [cells] */
    } column[VTKHDF_COLUMNS];
};

/* The parts that a document has besides its grains, made by somebody who can */
struct vtkhdf_parts {
    int count;
    const char *const *name; /* [count] paths, "/VTKHDF/surfaces"; at most 3 */
    /* The cells of part k; they are the maker's, who frees them with `done`. */
    int (*make)(struct vtkhdf_cells *cells, const struct packing *p, int k, void **made,
                struct failure *failure);
    void (*done)(void *made);
};

struct vtkhdf;

/* parts: NULL: the grains alone; else it has to stay where it is. EX_SOFTWARE: no memory. */
int vtkhdf_begin(struct vtkhdf **vtk, const struct vtkhdf_parts *parts, struct failure *failure);
/* What the frame has that is not in the document already. The document, growing or not, has the frame. */
int vtkhdf_frame(struct vtkhdf *vtk, hid_t file, const struct packing *p, struct failure *failure);
/* The document has all its frames: links, offsets and types. The next frame is another document's. */
int vtkhdf_end(struct vtkhdf *vtk, hid_t file, struct failure *failure);
void vtkhdf_free(struct vtkhdf *vtk);
