#include "base/json.h"

#include "base/text.h"

#include <math.h>
#include <stdlib.h>

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

/* A number that is whole stays a real one for who reads it: 2.0 */
static int json_write_real(FILE *out, double x)
{
    char text[NUMBER_ROOM];
    number_shortest(text, x);
    return fputs(text, out) == EOF || (!strpbrk(text, ".e") && fputs(".0", out) == EOF);
}

static int json_write_items(FILE *out, const json_t *j)
{
    if (putc('[', out) == EOF) return 1;
    for (size_t i = 0; i < json_array_size(j); i++)
        if ((i && putc(',', out) == EOF) || json_write(out, json_array_get(j, i))) return 1;
    return putc(']', out) == EOF;
}

static int json_write_members(FILE *out, const json_t *j)
{
    const char *key, *comma = "";
    json_t *value;
    if (putc('{', out) == EOF) return 1;
    json_object_foreach((json_t *)j, key, value)
    {
        json_t *name = json_string(key);
        const int failed = !name || fputs(comma, out) == EOF ||
                           json_dumpf(name, out, JSON_ENCODE_ANY) || putc(':', out) == EOF ||
                           json_write(out, value);
        json_decref(name);
        if (failed) return 1;
        comma = ",";
    }
    return putc('}', out) == EOF;
}

int json_write(FILE *out, const json_t *j)
{
    switch (json_typeof(j)) {
    case JSON_OBJECT:
        return json_write_members(out, j);
    case JSON_ARRAY:
        return json_write_items(out, j);
    case JSON_REAL:
        return json_write_real(out, json_real_value(j));
    default:
        return json_dumpf(j, out, JSON_ENCODE_ANY);
    }
}

char *json_text(const json_t *j)
{
    struct text text;
    size_t size;
    FILE *out = j ? text_open(&text) : NULL;
    if (!out) return NULL;
    const int failed = json_write(out, j);
    char *bytes = text_close(&text, out, &size);
    if (!failed) return bytes;
    free(bytes);
    return NULL;
}
