#include "base/json.h"

#include <math.h>

json_t *json_number(double x)
{
    return isfinite(x) ? json_real(x) : json_null();
}

json_t *json_numbers(const double *x, int64_t n)
{
    json_t *a = json_array();
    for (int64_t i = 0; i < n; i++) json_array_append_new(a, json_number(x[i]));
    return a;
}

json_t *json_vec(vec3 v)
{
    const double x[3] = { v.x, v.y, v.z };
    return json_numbers(x, 3);
}

static json_t *json_field_number(const struct field *f, const void *x, int k)
{
    if (f->type == COLUMN_F64) return json_number(((const double *)x)[k]);
    if (f->range == FIELD_FLAG) return json_boolean(((const int8_t *)x)[k]);
    return json_integer(f->type == COLUMN_I64   ? ((const int64_t *)x)[k]
                        : f->type == COLUMN_I32 ? ((const int32_t *)x)[k]
                                                : ((const int8_t *)x)[k]);
}

json_t *json_field(const struct field *f, const void *x)
{
    if (f->width == 1) return json_field_number(f, x, 0);
    json_t *a = json_array();
    for (int k = 0; k < f->width; k++) json_array_append_new(a, json_field_number(f, x, k));
    return a;
}
