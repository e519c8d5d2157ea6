/* draw/picture.h: a picture in memory, as PNG, and into a file that is whole or not there. */
#ifndef NSD_PICTURE_H
#define NSD_PICTURE_H

#include "base/why.h"

struct picture {
    int width, height;
    unsigned char *rgb; /* [3 width height] sRGB, the uppermost row first */
};

/* Returns 0 or EX_SOFTWARE when memory is short. */
int picture_init(struct picture *, int width, int height, struct why *);
void picture_free(struct picture *);

/*
 * As PNG to `path`, or to standard output when it is NULL. A file gets its name when all of it is
 * on the disk; what had the name before stays until then, and where it fails (EX_IOERR). A device
 * or a pipe is written as it is.
 */
int picture_write(const struct picture *, const char *path, struct why *);

#endif
