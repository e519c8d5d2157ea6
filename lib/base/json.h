/* base/json.h: numbers as JSON, which knows none that is infinite or no number. */
#ifndef NSD_JSON_H
#define NSD_JSON_H

#include "base/vec.h"

#include <jansson.h>
#include <stdint.h>

json_t *json_number(double x); /* null where x is not finite */
json_t *json_vec(vec3 v);
json_t *json_numbers(const double *x, int64_t n);

#endif
