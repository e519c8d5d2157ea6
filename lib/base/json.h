/* base/json.h: numbers as JSON, which knows none that is infinite or no number. */
#pragma once

#include "base/field.h"
#include "base/vec.h"

#include <jansson.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

json_t *json_number(double x); /* null where x is not finite */
json_t *json_vec(vec3 v);
json_t *json_numbers(const double *x, int64_t n);
/* A row of the field, at x: a number, a flag as true or false, an array of several numbers */
json_t *json_field(const struct field *field, const void *x);

/*
 * The byte order mark that some programs put in front of UTF-8, EF BB BF, which is no part of the
 * text.
 */

/* How many bytes of a text are such a mark: 3 or 0 */
static inline size_t mark_length(const char *text, size_t length)
{
    return length >= 3 && !memcmp(text, "\xef\xbb\xbf", 3) ? 3 : 0;
}
