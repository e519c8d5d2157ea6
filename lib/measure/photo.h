/* measure/photo.h: photographs with which silhouettes are compared [measure/silhouette.h]. */
#pragma once

#include "measure/snapshot.h"

enum { PHOTO_MOST = 8192 }; /* pixels across and up */

/* Reads a PNG file of at most PHOTO_MOST x PHOTO_MOST pixels. Returns 0, or EX_USAGE with the reason. */
int photo_read(struct photo *photo, const char *file, struct failure *failure);
