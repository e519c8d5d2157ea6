/* draw/picture.h: a picture in memory, written as a PNG file that is complete or not there. */
#pragma once

#include "base/failure.h"

#include <stddef.h>

struct picture {
    int width, height;  /* pixels */
    unsigned char *rgb; /* [3 width height] sRGB, the top row first */
};

/* Returns 0 or EX_SOFTWARE when memory is short. */
int picture_init(struct picture *p, int width, int height, struct failure *failure);
void picture_free(struct picture *p);

/* The bytes of a file to be. All zero to begin with; `at` is to be freed. */
struct bytes_out {
    unsigned char *at;
    size_t size, room;
};
/* -1 when memory is short */
int bytes_append(struct bytes_out *b, const unsigned char *data, size_t n);
/* Writes them as picture_write() does. */
int bytes_write(const struct bytes_out *b, const char *path, struct failure *failure);

/*
 * Writes a PNG to `path`, or to standard output when that is NULL. A file is written under another
 * name and renamed when complete; a file that had the name before stays until then, and if writing
 * fails. A device or a pipe is written directly. Returns 0, EX_IOERR or EX_SOFTWARE.
 */
int picture_write(const struct picture *p, const char *path, struct failure *failure);
