/* draw/picture.c: PNG by libpng, and its way into a file. */
#include "draw/picture.h"

#include "base/output.h"

#include <errno.h>
#include <fcntl.h>
#include <png.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int picture_init(struct picture *p, int width, int height, struct failure *failure)
{
    *p = (struct picture){ .width = width, .height = height };
    p->rgb = malloc((size_t)width * (size_t)height * 3);
    return p->rgb
               ? 0
               : failure_set(failure, EX_SOFTWARE, "no memory for %d x %d pixels", width, height);
}

void picture_free(struct picture *p)
{
    free(p->rgb);
    p->rgb = NULL;
}

/* ---- PNG ---- */

int bytes_append(struct bytes_out *b, const unsigned char *data, size_t n)
{
    if (b->size + n > b->room) {
        size_t room = 2 * (b->size + n);
        unsigned char *more = realloc(b->at, room);
        if (!more) return -1;
        b->at = more, b->room = room;
    }
    memcpy(b->at + b->size, data, n);
    b->size += n;
    return 0;
}

static void picture_append(png_structp png, png_bytep data, size_t n)
{
    if (bytes_append(png_get_io_ptr(png), data, n)) png_error(png, "no memory");
}

static void flush_nothing(png_structp png)
{
    (void)png;
}

static void fail_silently(png_structp png, png_const_charp text)
{
    (void)text;
    png_longjmp(png, 1);
}

/* Without a date or a name, so that the same picture gives the same bytes. */
static int encode(const struct picture *p, struct bytes_out *b, struct failure *failure)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, fail_silently, NULL);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return failure_set(failure, EX_SOFTWARE, "no memory for the PNG");
    }
    png_set_write_fn(png, b, picture_append, flush_nothing);
    png_set_IHDR(png, info, (png_uint_32)p->width, (png_uint_32)p->height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    for (int y = 0; y < p->height; y++)
        png_write_row(png, p->rgb + 3 * (size_t)p->width * (size_t)y);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return 0;
}

/* ---- out ---- */

static bool picture_write_all(int fd, const struct bytes_out *b)
{
    for (size_t done = 0; done < b->size;) {
        ssize_t n = write(fd, b->at + done, b->size - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        done += (size_t)n;
    }
    return true;
}

/* Writes to an open file; when that fails, a regular file is cut to the length that it had. */
static int write_open(int fd, const struct bytes_out *b, const char *name, struct failure *failure)
{
    off_t start = lseek(fd, 0, fcntl(fd, F_GETFL) & O_APPEND ? SEEK_END : SEEK_CUR);
    if (!picture_write_all(fd, b)) {
        failure_set(failure, EX_IOERR, "%s: %s", name, strerror(errno));
        if (start >= 0 && ftruncate(fd, start)) errno = 0; // there is nothing more that can be done
    }
    if (close(fd)) failure_set(failure, EX_IOERR, "%s: %s", name, strerror(errno));
    return failure->status;
}

int bytes_write(const struct bytes_out *b, const char *path, struct failure *failure)
{
    struct output o;
    if (!path) return write_open(STDOUT_FILENO, b, "standard output", failure);
    if (output_open(&o, path, failure)) return failure->status;
    if (!picture_write_all(o.fd, b))
        failure_set(failure, EX_IOERR, "%s: %s", path, strerror(errno));
    return output_close(&o, failure);
}

int picture_write(const struct picture *p, const char *path, struct failure *failure)
{
    struct bytes_out b = { 0 };
    if (!encode(p, &b, failure)) bytes_write(&b, path, failure);
    free(b.at);
    return failure->status;
}
