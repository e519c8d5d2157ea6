#include "measure/table.h"

#include "base/array.h"
#include "base/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

void table_init(struct table *t, const struct quantity *quantity)
{
    *t = (struct table){ .quantity = quantity };
    for (const struct quantity *q = quantity; q->name; q++) t->width += q->width;
}

void table_free(struct table *t)
{
    free(t->x);
    t->x = NULL, t->rows = t->room = 0;
}

double *table_row(struct table *t, struct failure *failure)
{
    if (!array_grow(&t->x, &t->room, t->rows + 1, (size_t)t->width * sizeof *t->x)) {
        failure_set(failure, EX_SOFTWARE, "no memory for a measure");
        return NULL;
    }
    double *row = t->x + t->rows++ * t->width;
    for (int k = 0; k < t->width; k++) row[k] = NAN;
    return row;
}

void table_null(struct table *t, const char *format, ...)
{
    va_list ap;
    if (*t->null) return;
    va_start(ap, format);
    vsnprintf(t->null, sizeof t->null, format, ap);
    va_end(ap);
}

void put(double **at, double x)
{
    *(*at)++ = x;
}

void put_vec(double **at, vec3 v)
{
    put(at, v.x), put(at, v.y), put(at, v.z);
}

void put_tensor(double **at, const struct tensor *T)
{
    for (int k = 0; k < 9; k++) put(at, T->x[k / 3][k % 3]);
}

void print_number(FILE *out, double x, const char *none)
{
    char text[NUMBER_ROOM];
    if (!isfinite(x)) {
        fputs(none, out);
        return;
    }
    if (x == 0) x = 0; // no minus zero
    number_shortest(text, x);
    fputs(text, out);
}

/* A number, a vector or a tensor */
static void json_value(FILE *out, const double *x, int width)
{
    if (width == 1) {
        print_number(out, *x, "null");
        return;
    }
    int part = width == 9 ? 3 : 1;
    for (int k = 0; k < width; k += part) {
        fputc(k ? ',' : '[', out);
        json_value(out, x + k, part);
    }
    fputc(']', out);
}

/* Names need no escapes [state/names.h]. */
static void print_word(FILE *out, const struct table *t, double x, const char *quote,
                       const char *none)
{
    bool is = t->names && x >= 0 && x < t->names->n;
    fprintf(out, "%s%s%s", is ? quote : "", is ? t->names->text[(int32_t)x] : none,
            is ? quote : "");
}

static void json_quantity(FILE *out, const struct table *t, const struct quantity *q,
                          const double *x)
{
    if (quantity_is_name(q))
        print_word(out, t, *x, "\"", "null");
    else
        json_value(out, x, q->width);
}

void table_json(FILE *out, const struct table *t, int list)
{
    int at = 0;
    if (!t->rows && (*t->null || !list)) {
        fputs("null", out);
        return;
    }
    for (const struct quantity *q = t->quantity; q->name; at += q++->width) {
        fprintf(out, "%c\"%s\":", q == t->quantity ? '{' : ',', q->name);
        if (!list) json_quantity(out, t, q, t->x + at);
        for (int64_t i = 0; list && i < t->rows; i++) {
            fputc(i ? ',' : '[', out);
            json_quantity(out, t, q, t->x + i * t->width + at);
        }
        if (list) fputs(t->rows ? "]" : "[]", out);
    }
    fputc('}', out);
}

void table_names(FILE *out, const struct quantity *quantity, const char *prefix)
{
    const char *axis = "xyz";
    for (const struct quantity *q = quantity; q->name; q++)
        for (int k = 0; k < q->width; k++) {
            fprintf(out, "\t%s%s%s", prefix ? prefix : "", prefix ? "_" : "", q->name);
            if (q->width == 3) fprintf(out, "_%c", axis[k]);
            if (q->width == 9) fprintf(out, "_%c%c", axis[k / 3], axis[k % 3]);
        }
}

void table_numbers(FILE *out, const struct table *t, int64_t row)
{
    const struct quantity *q = t->quantity;
    for (int k = 0, in = 0; k < t->width; k++, in++) {
        if (in == q->width) q++, in = 0;
        double x = row < t->rows ? t->x[row * t->width + k] : NAN;
        fputc('\t', out);
        quantity_is_name(q) ? print_word(out, t, x, "", "-") : print_number(out, x, "nan");
    }
}
