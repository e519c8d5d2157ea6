/*
 * convert/text.c: tables of text, a row for each grain, contact, piece of a wall or edge of the
 * cell; the first line has the names of the columns. Numbers are written so that reading them gives
 * the same bits.
 */
#include "convert/format.h"
#include "convert/sheet.h"

#include <inttypes.h>

static void text_put_names(FILE *out, const struct sheet *s, char by)
{
    fprintf(out, "step%ctime", by);
    if (s->of_points) fprintf(out, "%cx%cy%cz", by, by, by);
    for (int k = 0; k < s->columns; k++) {
        const struct sheet_column *c = &s->column[k];
        if (!*c->suffix) fprintf(out, "%c%s", by, c->name);
        for (const char *x = c->suffix; *x; x++) fprintf(out, "%c%s_%c", by, c->name, *x);
    }
    putc('\n', out);
}

static void put_row(FILE *out, const struct export_frame *m, const struct sheet *s, int64_t row,
                    char by)
{
    fprintf(out, "%" PRId64 "%c%.17g", m->packing->step, by, m->packing->t);
    if (s->of_points) {
        const vec3 x = s->x[row];
        fprintf(out, "%c%.17g%c%.17g%c%.17g", by, x.x, by, x.y, by, x.z);
    }
    for (int k = 0; k < s->columns; k++) {
        const struct sheet_column *c = &s->column[k];
        for (int64_t i = row * c->width; i < (row + 1) * c->width; i++)
            if (c->real)
                fprintf(out, "%c%.17g", by, c->real[i]);
            else
                fprintf(out, "%c%" PRId32, by, c->whole[i]);
    }
    putc('\n', out);
}

static int text_put(FILE *out, const struct export_frame *m, enum part part, bool first, char by,
                    struct failure *failure)
{
    struct sheet s;
    if (sheet_of(&s, part, m, failure)) return failure->status;
    if (first) text_put_names(out, &s, by);
    for (int64_t row = 0; row < sheet_rows(&s); row++) {
        moment_tell(m, row, sheet_rows(&s));
        put_row(out, m, &s, row, by);
    }
    sheet_free(&s);
    return 0;
}

static int csv(FILE *out, const struct export_frame *m, enum part part, bool first,
               struct failure *failure)
{
    return text_put(out, m, part, first, ',', failure);
}

static int tsv(FILE *out, const struct export_frame *m, enum part part, bool first,
               struct failure *failure)
{
    return text_put(out, m, part, first, '\t', failure);
}

const struct format format_csv = {
    .name = "csv",
    .ending = "csv",
    .help = "table separated by commas",
    .joins = true,
    .parts = true,
    .write = csv,
};

const struct format format_tsv = {
    .name = "tsv",
    .ending = "tsv",
    .help = "table separated by tabs",
    .joins = true,
    .parts = true,
    .write = tsv,
};
