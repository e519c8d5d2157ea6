/*
 * measure/silhouette.h: the area that bodies cover in a projection, compared with a photograph.
 *
 * Every pixel counts the bodies in front of its centre, added over the frames. The counts, as bytes of which 255 is the
 * largest count, are closed by squares of CLOSED x CLOSED pixels (gaps between grains through which one sees the
 * background), and what is above BODIES_CUT is covered. Of a photograph, dark on a bright ground and perhaps a mean of
 * several, the same is made with 255 minus its grey and PHOTO_CUT. Only pixels in the disc that is asked for count.
 */
#pragma once

#include "measure/snapshot.h"

/* Writes what is kept as a picture, PNG: grey where both are covered, blue the simulation alone, red the photograph alone.
   Returns 0, EX_SOFTWARE or EX_IOERR. */
int silhouette_write(const char *file, const struct frame_memory *kept, const struct asked *asked,
                     struct failure *failure);
