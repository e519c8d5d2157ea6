/*
 * state/names.h: names of walls, of parts of their surfaces, and of groups of bodies. Several walls may
 * have one name: what is said by name is then said of all of them.
 *
 * A face is a triangle of a mesh, in the plane a segment; any other wall is one face.
 */
#pragma once

#include "base/failure.h"
#include "shape/wall_shape.h"

#include <stdbool.h>
#include <stdint.h>

enum {
    NAME_BYTES = 60,      /* at most: a line of a message has room for two names */
    NAMES_MOST = 4096,    /* as many as there may be materials */
    NAMED_MOST = 1 << 20, /* rows */
};

/* What has a name: a wall, or some of its faces */
struct named {
    int32_t name;  /* row of text[] */
    int32_t wall;  /* row of the packing's walls */
    int32_t first; /* of its faces, counted from its own first one */
    int32_t count; /* faces; 0: the whole wall */
};

struct names {
    int32_t n, rows;
    char **text;       /* [n] each once; those of bodies' groups have no row */
    struct named *row; /* [rows] sorted by name, wall and first; no face twice under one name */
};

void names_free(struct names *names);
/* to need not be initialised. Returns 0 or EX_SOFTWARE. */
int names_copy(struct names *to, const struct names *from, struct failure *failure);

/* NULL, or what is wrong with a name: it must not be empty, too long, no UTF-8, or a number; commas separate names in
   options, and quotes and backslashes would have to be escaped where names are printed. */
const char *name_trouble(const char *text, size_t n);
/* The same of materials and shapes, which may be numbers */
const char *name_trouble_of_material(const char *text, size_t n);

/* The row of a name of n bytes; -1: none */
int32_t names_find(const struct names *names, const char *text, size_t n);
/* The same; a new one is added. Returns 0, EX_DATAERR (name_trouble) or EX_SOFTWARE. */
int names_add(struct names *names, const char *text, int32_t *which, struct failure *failure);
/* Gives a wall, or some of its faces, the name. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int names_give(struct names *names, const char *text, int32_t wall, int32_t first, int32_t count,
               struct failure *failure);
/* Sorts the rows, and joins those of one name. */
void names_settle(struct names *names);

/* Do the rows speak of walls and faces that exist, each face once a name? Returns 0 or EX_DATAERR. */
int names_check(const struct names *names, int32_t walls, const struct wall *wall,
                struct failure *failure);

/* The name of a whole wall; NULL: it has none */
const char *names_of_wall(const struct names *names, int32_t wall);
/* The name of a face, counted from the wall's first one: the last of the parts that it is in, else that of its
   wall; NULL: it has none */
const char *names_of_face(const struct names *names, int32_t wall, int32_t face);
