/* draw/svg.h: a packing of discs as an SVG: circles and lines, for a paper's figure. */
#pragma once

#include "draw/overlay.h"

/*
 * Writes the picture that view_fit() has framed, with all that o asks for, to `path`; NULL: to
 * standard output. Units are points, one for each pixel of the picture. A file is written under
 * another name and renamed when complete. Returns 0, EX_DATAERR (balls), EX_IOERR or EX_SOFTWARE.
 */
int svg_draw(const struct overlay *o, const struct view *v, const struct packing *p,
             const struct contacts *contacts, const char *path, struct failure *failure);
