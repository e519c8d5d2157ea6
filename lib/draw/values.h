/* draw/values.h: a number for each body, for its colour: of its contacts, or out of a table. */
#ifndef NSD_VALUES_H
#define NSD_VALUES_H

#include "state/contact.h"
#include "draw/paint.h"

#include <stdio.h>

/* Numbers by step and id, out of a table. All zero to begin with. */
struct values {
    char *name; /* of their column */
    int64_t n, room;
    struct value {
        int64_t step, id; /* step -1: of every step */
        double x;
    } * row; /* [n] sorted by (step, id) */
};

/*
 * Reads a table: lines of numbers, columns separated by blanks or tabs, their names in the first
 * line, perhaps after a #. There must be `id`; with `step`, a row is of that step alone. `column`
 * names the numbers wanted; NULL: the last column. Returns 0, EX_DATAERR with file and line, or
 * EX_NOINPUT, EX_SOFTWARE.
 */
int values_read(struct values *v, const char *path, const char *column, struct failure *failure);
void values_free(struct values *v);

/* out[p->n] = what colours of this meaning show; contacts, values may be NULL: NAN. */
void values_of(double *out, enum colour by, const struct packing *p,
               const struct contacts *contacts, const struct values *values);

#endif
