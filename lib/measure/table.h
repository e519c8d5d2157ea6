/*
 * measure/table.h: the numbers of a measure: one row, or a row for each layer, bin, wall, grain.
 * A number that there is not is NaN here, and null or nan where it is printed.
 */
#pragma once

#include "base/failure.h"
#include "base/vec.h"
#include "measure/tensor.h"
#include "state/names.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* What a measure's numbers are called, and their units. */

struct quantity {
    const char *name; /* NULL ends a list */
    const char *
        unit; /* in space; "1" without any; "name": the number is a row of the packing's names, which is printed */
    int width;        /* numbers: 1, 3 a vector, 9 a tensor by rows */
    const char *help; /* a few words */
};

static inline bool quantity_is_name(const struct quantity *q)
{
    return !strcmp(q->unit, "name");
}

struct table {
    const struct quantity *quantity; /* up to one without a name */
    int width;                       /* numbers in a row */
    int64_t rows, room;
    double *x;                 /* [rows][width] */
    const struct names *names; /* of words */
    char null[200];            /* why there are no numbers, or not all; "" where there are */
};

/* An empty one; the quantities have to last. */
void table_init(struct table *t, const struct quantity *quantity);
void table_free(struct table *t);
/* One more row, all NaN; NULL when memory is short (EX_SOFTWARE). Valid until the next. */
double *table_row(struct table *t, struct failure *failure);
/* Why there are no numbers, unless a reason is there already. */
void table_null(struct table *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Each writes at *at and continues after it. */
void put(double **at, double x);
void put_vec(double **at, vec3 v);
void put_tensor(double **at, const struct tensor *T);

/* A number with as many digits as it takes to read the same bits back; null or nan where there is none */
void print_number(FILE *out, double x, const char *none);

/* The JSON of a table: an object of numbers and arrays; with `list` arrays of the rows' numbers.
   null where there is no row. */
void table_json(FILE *out, const struct table *t, int list);

/* For tables of text, a tab before each: the columns' names, after "prefix_" unless that is NULL;
   the numbers of a row */
void table_names(FILE *out, const struct quantity *quantity, const char *prefix);
void table_numbers(FILE *out, const struct table *t, int64_t row);
