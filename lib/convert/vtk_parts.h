/*
 * convert/vtk_parts.h: what documents have for VTK besides their grains [file/vtkhdf.h]: the surfaces of grains
 * that are no balls, and the walls, as polygons.
 */
#ifndef NSD_VTK_PARTS_H
#define NSD_VTK_PARTS_H

#include "file/vtkhdf.h"

extern const struct vtkhdf_parts vtk_parts;

#endif
