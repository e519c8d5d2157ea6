/* base/json.h: numbers as JSON, which knows none that is infinite or no number, and JSON as text. */
#pragma once

#include "base/field.h"
#include "base/vec.h"

#include <jansson.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

json_t *json_number(double x); /* null where x is not finite */
json_t *json_vec(vec3 v);
json_t *json_numbers(const double *x, int64_t n);
/* A row of the field, at x: a number, a flag as true or false, an array of several numbers */
json_t *json_field(const struct field *field, const void *x);

/* Compact, on one line; each number with the fewest digits, of 15 to 17, that are read as the same number. Returns 0, or not 0 where not
   all was written. jansson's own writes 17 digits of 0.1. */
int json_write(FILE *out, const json_t *j);
/* The same in memory, to be freed; NULL: no memory, or j is NULL */
char *json_text(const json_t *j);

/*
 * The byte order mark that some programs put in front of UTF-8, EF BB BF, which is no part of the
 * text.
 */

/* How many bytes of a text are such a mark: 3 or 0 */
static inline size_t mark_length(const char *text, size_t length)
{
    return length >= 3 && !memcmp(text, "\xef\xbb\xbf", 3) ? 3 : 0;
}
