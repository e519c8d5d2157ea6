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
