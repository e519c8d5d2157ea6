#include "base/field.h"

#include <float.h>
#include <math.h>
#include <string.h>

void *field_array(const struct field *f, const void *structure)
{
    void *array;
    memcpy(&array, (const char *)structure + f->offset, sizeof array);
    return array;
}

void field_set_array(const struct field *f, void *structure, void *array)
{
    memcpy((char *)structure + f->offset, &array, sizeof array);
}

void *field_row(const struct field *f, const void *structure, int64_t i)
{
    return (char *)field_array(f, structure) + (size_t)i * field_bytes(f);
}

void field_gather(const struct field *f, int64_t n, const void *structs, size_t stride, void *out)
{
    size_t bytes = field_bytes(f);
    const char *from = (const char *)structs + f->offset;
    for (int64_t i = 0; i < n; i++) memcpy((char *)out + bytes * i, from + stride * i, bytes);
}

void field_scatter(const struct field *f, int64_t n, const void *in, void *structs, size_t stride)
{
    size_t bytes = field_bytes(f);
    char *to = (char *)structs + f->offset;
    for (int64_t i = 0; i < n; i++) memcpy(to + stride * i, (const char *)in + bytes * i, bytes);
}

/* A number of a row, all of which a double holds but for large integers */
static double number_at(const struct field *f, const void *x, int k)
{
    switch (f->type) {
    case COLUMN_F64:
        return ((const double *)x)[k];
    case COLUMN_I64:
        return (double)((const int64_t *)x)[k];
    case COLUMN_I32:
        return ((const int32_t *)x)[k];
    default:
        return ((const int8_t *)x)[k];
    }
}

static const char *number_trouble(enum field_range range, double x)
{
    switch (range) {
    case FIELD_POSITIVE:
        return x > 0 && isfinite(x) ? NULL : "must be positive and finite";
    case FIELD_NOT_NEGATIVE:
        return x >= 0 && isfinite(x) ? NULL : "must be finite and not negative";
    case FIELD_FRACTION:
        return x >= 0 && x <= 1 ? NULL : "must lie in [0, 1]";
    case FIELD_FLAG:
        return x == 0 || x == 1 ? NULL : "is neither 0 nor 1";
    case FIELD_ANY:
        return NULL;
    default:
        return isfinite(x) ? NULL : "is not finite";
    }
}

const char *field_trouble(const struct field *f, const void *x)
{
    double square = 0;
    for (int k = 0; f->range != FIELD_ANY && k < f->width; k++) {
        double at = number_at(f, x, k);
        const char *trouble = number_trouble(f->range, at);
        if (trouble) return trouble;
        square += at * at;
    }
    return f->range == FIELD_UNIT && !(fabs(square - 1) < 1e-6) ? "is not a unit vector" : NULL;
}

bool field_fits(const struct field *f, const void *rows, int64_t n)
{
    const double *x = rows;
    const int64_t numbers = n * f->width;
    bool bad = false;
    if (f->range == FIELD_ANY) return true;
    if (f->type == COLUMN_F64 && f->range <= FIELD_NOT_NEGATIVE) {
        const double least = f->range == FIELD_FINITE ? -DBL_MAX : 0;
        for (int64_t i = 0; i < numbers; i++) bad |= !(x[i] >= least && x[i] <= DBL_MAX);
        for (int64_t i = 0; f->range == FIELD_POSITIVE && i < numbers; i++) bad |= x[i] == 0;
        return !bad;
    }
    for (int64_t i = 0; i < n && !bad; i++)
        bad = field_trouble(f, (const char *)rows + (size_t)i * field_bytes(f));
    return !bad;
}

int records_check(struct records o, const char *what, struct failure *failure)
{
    for (int64_t i = 0; i < o.n; i++)
        for (const struct field *f = o.fields; f->name; f++) {
            const char *row = (const char *)o.structs + (size_t)i * o.stride;
            const char *trouble = field_trouble(f, row + f->offset);
            if (trouble)
                return failure_set(failure, EX_DATAERR, "%s %lld: %s %s", what, (long long)i,
                                   f->name, trouble);
        }
    return 0;
}

bool field_equal(const struct field *f, const void *x, const void *y)
{
    if (!memcmp(x, y, field_bytes(f))) return true;
    for (int k = 0; k < f->width; k++) {
        double a = number_at(f, x, k), b = number_at(f, y, k);
        if (f->type != COLUMN_F64 || !(a == b || (isnan(a) && isnan(b)))) return false;
    }
    return true;
}

bool field_is_kept(const struct field *f, const struct records *o)
{
    if (f->when) return f->when(o->of);
    if (!(f->traits & FIELD_OPTIONAL)) return true;
    const char *x = (const char *)o->structs + f->offset;
    for (int64_t i = 0; i < o->n; i++, x += o->stride)
        for (int k = 0; k < f->width; k++)
            if (number_at(f, x, k) != 0) return true;
    return false;
}
