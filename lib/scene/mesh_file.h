/*
 * scene/mesh_file.h: triangles from files of other programs, STL, OBJ and PLY [scene/mesh_file.h]. What the
 * bytes are says which format it is, and the name only where they do not. Readers are nsd's own: they read one
 * file and no other, keep double precision, and refuse what is not as its format says.
 */
#pragma once

#include "scene/scene.h"
#include "scene/soup.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/*
 * The formats of files of surfaces, a table. A new one is a file as mesh_obj.c is, its
 * extern here and its row in mesh_file.c.
 */

struct mesh_format {
    const char *name; /* in capitals */
    const char *ending;
    /* Do n bytes begin as a file of this format? Behind them there is a 0. */
    bool (*looks)(const char *bytes, int64_t n);
    /* Puts what they have into the soup. Returns 0 or the status of a fault. */
    int (*read)(struct soup *s, const char *bytes, int64_t n);
};

extern const struct mesh_format mesh_stl, mesh_obj, mesh_ply;

/*
 * Lines, words and numbers of text in the files of surfaces. Lines end with LF or CR LF; a
 * UTF-8 byte order mark in front is passed over. Numbers are decimal, with a point whatever the locale, and
 * keep all their digits.
 */

struct words {
    struct soup *soup;    /* its `at` is the number of the line */
    const char *at, *end; /* the rest; *end is 0 */
    bool joined;          /* a backslash at the end of a line joins the next one to it */
    bool comments;        /* from # to the end of a line */
};

struct word {
    const char *s;
    int n; /* bytes */
};

/* Of the n bytes of a file, behind which there is a 0 */
struct words words_of(struct soup *soup, const char *bytes, int64_t n);
/* The next word of the line; false at its end */
bool words_next(struct words *w, struct word *word);
/* Goes to the next line; false: there is none */
bool words_line(struct words *w);
/* The next word, on this line or a later one; false at the end of the text */
bool words_any(struct words *w, struct word *word);
/* Letters may be of either case. */
bool word_is(struct word word, const char *what);
bool word_has_only(struct word word, const char *letters);
/* A fault: "WORD" trouble */
int word_fault(struct words *w, struct word word, const char *trouble);

/* The next word of the line, which must be a finite number, or a whole one; each returns 0 or a fault's
   status. */
int words_number(struct words *w, double *x);
int words_whole(struct words *w, int64_t *x);
int word_number(struct words *w, struct word word, double *x);

/* Numbers of binary files, of either byte order. */

enum bytes_type {
    BYTES_I8,
    BYTES_U8,
    BYTES_I16,
    BYTES_U16,
    BYTES_I32,
    BYTES_U32,
    BYTES_F32,
    BYTES_F64,
    BYTES_TYPES
};
static const uint8_t bytes_size[BYTES_TYPES] = { 1, 1, 2, 2, 4, 4, 4, 8 };

/* Exact: a double has them all. */
static inline double bytes_number(const void *at, enum bytes_type type, bool big_endian)
{
    const unsigned char *byte = at;
    uint64_t bits = 0;
    float f;
    double d;
    for (int k = 0, n = bytes_size[type]; k < n; k++)
        bits |= (uint64_t)byte[big_endian ? n - 1 - k : k] << 8 * k;
    uint32_t low = (uint32_t)bits;
    memcpy(&f, &low, sizeof f), memcpy(&d, &bits, sizeof d);
    switch (type) {
    case BYTES_I8:
        return (int8_t)bits;
    case BYTES_I16:
        return (int16_t)bits;
    case BYTES_I32:
        return (int32_t)bits;
    case BYTES_F32:
        return (double)f;
    case BYTES_F64:
        return d;
    default:
        return (double)bits;
    }
}

enum {
    MESH_BYTES_MOST = 1 << 30, /* of all files of a scene */
    MESH_WORK_MOST = 1 << 30   /* for concave polygons [scene/ears.h]: some seconds */
};

/* Adds the triangles of a file, whose name is relative to files->dir and whose unit is `scale` m, and adds
   to its accounts; *left_out: triangles that are not there [scene/soup.h]. Returns 0, EX_NOINPUT,
   EX_DATAERR or EX_SOFTWARE. */
int mesh_file_read(struct mesh *to, struct scene_files *files, const char *name, double scale,
                   int32_t *left_out, struct failure *failure);
/* Reads the files of all meshes of the scene, and adds their triangles, as above. */
int mesh_files_read(struct scene *s, struct scene_files *files, struct failure *failure);
/* What a file has */
struct mesh_bytes {
    const char *name;
    const char *at; /* [n] bytes, and a 0 behind them */
    int64_t n;
    double scale; /* m: its unit */
};
/* The same of bytes */
int mesh_bytes_read(struct mesh *to, struct scene_files *files, const struct mesh_bytes *b,
                    int32_t *left_out, struct failure *failure);
