/*
 * state/part.h: the parts of a packing: each of its arrays, with the fields of a row. free, copy, compare and send to other
 * ranks are loops over packing_parts[], and over the fields of a part where members count. What a packing has without an
 * array is in packing_fields[] and cell_fields[]; shapes, which own arrays themselves, are copied and compared apart.
 */
#pragma once

#include "base/field.h"
#include "state/packing.h"

enum part_trait {
    PART_SETTING = 1, /* ranks need it, and all frames of a trajectory share its FIELD_SAME */
    PART_BODY = 2,    /* a row for each body */
    PART_TEXT = 4,    /* rows are strings */
    PART_AGAIN = 8    /* other fields of an array that has a row of its own */
};

/* How many rows there are: as a member of struct packing says, its square, or one if there is a text */
enum part_count { PART_I32, PART_I64, PART_SQUARE, PART_ONE_TEXT };

struct part {
    const char *name, *many; /* "wall", "walls": for messages */
    unsigned traits;         /* PART_... */
    size_t array;            /* in struct packing: the pointer to the rows, which may be NULL */
    size_t bytes;            /* of a row */
    enum part_count how;     /* count says how many they are: */
    size_t count;            /* in struct packing */
    size_t room; /* of an int64_t there: rows that there is memory for; 0: no such member */
    const struct field *fields;
};
extern const struct part packing_parts[]; /* one without a name ends them */

void *part_array(const struct part *part, const struct packing *p);
void part_set_array(const struct part *part, struct packing *p, void *array);
int64_t part_count(const struct part *part, const struct packing *p);

/* The first thing in which p differs from `first`, whose trajectory it is to join: of settings, which all frames share
   [FIELD_SAME]. Returns 0 or EX_DATAERR. */
int packing_same_settings(const struct packing *first, const struct packing *p,
                          struct failure *failure);
/* Forgets all arrays of p, which somebody else owns; the counts of rows stay. */
void packing_disown(struct packing *p);
/* p without its bodies, and what belongs to them and to single frames; all is borrowed. */
struct packing packing_settings(const struct packing *p);
