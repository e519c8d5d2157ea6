/*
 * scene/schema.h: the tables of keys [scene/keys.h] for others: a JSON Schema, draft 2020-12, and lines of text, of
 * which the tables of nsd-scene(5) are made.
 *
 * The schema accepts what the tables accept: keys, types, ranges, keys that are needed, and which go together. What follows
 * from several values, as that a box is wide enough for its bodies, only scene_parse() sees.
 */
#pragma once

#include "base/failure.h"

#include <jansson.h>

/* NULL: no memory */
json_t *schema_of_scenes(struct failure *failure);
/* Calls line() for each key, with the fields: table, key, type, unit, default, example, help. */
void schema_lines(void (*line)(const char *const field[7]));
