#include "file/account_rows.h"

#include <math.h>
#include <stdio.h>

static const char home[] = "/nsd/account";

/* A column each, from the table of what is watched */
struct report_rows_columns {
    struct column c[ACCOUNT_ROWS + 2];
};

static struct report_rows_columns columns(void)
{
    struct report_rows_columns t = { { { "steps", "1", COLUMN_I64, 1, offsetof(struct account, steps) } } };
    for (int k = 0; k < ACCOUNT_ROWS; k++)
        t.c[1 + k] = (struct column){ account_watched[k].name, account_watched[k].units, COLUMN_F64,
                                      4, offsetof(struct account, worst[k]) };
    return t;
}

/* Counts and steps that are some; ids are only shown */
static int report_rows_check(const struct account *a, struct failure *failure)
{
    const double most = 9007199254740992; // 2^53: integers beyond it are none that are exact
    if (a->steps < 0) return failure_set(failure, EX_DATAERR, "%s/steps: is negative", home);
    for (int k = 0; k < ACCOUNT_ROWS; k++) {
        const struct account_entry *e = &a->worst[k];
        bool good = !(e->value < 0) && e->step >= 0 && e->step <= most &&
                    fabs(e->bodies[0]) <= most && fabs(e->bodies[1]) <= most;
        if (!good)
            return failure_set(failure, EX_DATAERR, "%s/%s: a number is out of range", home,
                           account_watched[k].name);
    }
    return 0;
}

int64_t account_rows_count(const struct source *source, int64_t n)
{
    struct report_rows_columns t = columns();
    for (const struct column *c = t.c; c->name; c++) {
        char path[80];
        uint64_t shape[4];
        snprintf(path, sizeof path, "%s/%s/value", home, c->name);
        if (source_shape(source, path, shape) > 0 && shape[0] < (uint64_t)n) n = (int64_t)shape[0];
    }
    return n;
}

int account_rows_read(struct source *source, int64_t start, int64_t n, struct account *account,
                      struct failure *failure)
{
    struct report_rows_columns t = columns();
    char path[80];
    for (const struct column *c = t.c; c->name; c++) {
        const struct column one[] = { *c, { 0 } };
        snprintf(path, sizeof path, "%s/%s/value", home, c->name);
        if (!source_has(source, path)) continue; // of a version that does not watch it
        if (table_read_finite(source, home, "/value", start, RECORDS(one, n, account), failure))
            return failure->status;
    }
    for (int64_t i = 0; i < n; i++)
        if (report_rows_check(&account[i], failure)) return failure->status;
    return 0;
}

int account_rows_write(struct table_write *s, const struct account *account, struct failure *failure)
{
    struct report_rows_columns t = columns();
    bool first = !table_write_grows(s, "/nsd/account/steps/value");
    if (table_write_columns(s, home, "/value", RECORDS(t.c, 1, account), CHUNK_FRAMES, failure))
        return failure->status;
    if (first && (table_write_link(s, LAYOUT_REPORT "/step", "step", home, t.c, failure) ||
                  table_write_link(s, LAYOUT_REPORT "/time", "time", home, t.c, failure)))
        return failure->status;
    return 0;
}
