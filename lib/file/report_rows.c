#include "file/report_rows.h"

#include "file/h5.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { AHEAD = 256 }; /* reports read at once: 64 KiB */

/* The reports whose numbers in these columns are there: a killed writer's may differ. */
static void report_rows_count_rows(struct report_rows *r, const struct field *columns)
{
    for (const struct field *c = columns; c->name; c++) {
        uint64_t shape[4];
        char path[80];
        snprintf(path, sizeof path, "%s/%s/value", r->group, c->name);
        if (source_shape(r->source, path, shape) > 0 && shape[0] < (uint64_t)r->solves)
            r->solves = (int64_t)shape[0];
    }
}

int report_rows_open(struct report_rows *r, struct source *source, struct failure *failure)
{
    *r = (struct report_rows){ .source = source };
    char path[80];
    r->group = source_has(r->source, LAYOUT_REPORT) ? LAYOUT_REPORT : LAYOUT_REPORT_0_1;
    snprintf(path, sizeof path, "%s/step", r->group);
    if (source_has(r->source, path))
        r->solved = table_read_steps(r->source, path, &r->solves, failure);
    uint64_t shape[4];
    snprintf(path, sizeof path, "%s/time", r->group);
    if (source_shape(r->source, path, shape) > 0 && shape[0] < (uint64_t)r->solves)
        r->solves = (int64_t)shape[0];
    report_rows_count_rows(r, report_fields);
    report_rows_count_rows(r, velocity_fields);
    report_rows_count_rows(r, balance_fields);
    for (int k = 0; k < BALANCE_PARTS; k++) report_rows_count_rows(r, balance_parts[k].fields);
    r->solves = account_rows_count(source, r->solves);
    if (!failure->status) r->solves = table_read_rising(r->solved, r->solves);
    return failure->status;
}

/* Counts that are counts, a flag that is one */
static int check_report(const struct report *rep, const char *group, struct failure *failure)
{
    if (records_check(RECORDS(report_fields, 1, rep), group, failure) ||
        records_check(RECORDS(velocity_fields, 1, rep), group, failure))
        return failure->status;
    if (rep->converged && !isfinite(rep->err.paper.eps_glob))
        return failure_set(failure, EX_DATAERR, "%s: has converged with errors that are not finite",
                           group);
    return 0;
}

static int read_history(struct source *doc, const char *group, struct report *rep,
                        struct failure *failure)
{
    uint64_t n;
    char path[80];
    snprintf(path, sizeof path, "%s/history", group);
    if (!source_has(doc, path)) return 0;
    double *h = source_read_all(doc, path, COLUMN_F64, &n, failure);
    if (!h) return failure->status;
    rep->history = (struct terms *)h;
    return n == 5 * (uint64_t)rep->sweeps
               ? 0
               : failure_set(failure, EX_DATAERR, "%s: not of shape %d x 5", path, rep->sweeps);
}

/* Numbers of a step are finite, else it is not made; a solve of a problem without bodies may end with any errors. */
static int report_rows_read_table(const struct report_rows *r, int64_t at, struct records records,
                                  struct failure *failure)
{
    return (source_has(r->source, "/particles/all") ? table_read_finite : table_read_columns)(
        r->source, r->group, "/value", at, records, failure);
}

/* Reports from `at` on, as many as there are up to AHEAD, but for their texts. */
static int read_ahead(struct report_rows *r, int64_t at, struct failure *failure)
{
    char time[80];
    free(r->ahead.row), free(r->ahead.account), free(r->ahead.time);
    int64_t n = r->solves - at < AHEAD ? r->solves - at : AHEAD;
    r->ahead.first = at, r->ahead.n = 0;
    r->ahead.row = calloc((size_t)n, sizeof *r->ahead.row);
    r->ahead.account = calloc((size_t)n, sizeof *r->ahead.account);
    r->ahead.time = calloc((size_t)n, sizeof *r->ahead.time);
    if (!r->ahead.row || !r->ahead.account || !r->ahead.time)
        return failure_set(failure, EX_SOFTWARE, "no memory for %s", r->group);
    snprintf(time, sizeof time, "%s/time", r->group);
    if (report_rows_read_table(r, at, RECORDS(report_fields, n, r->ahead.row), failure) ||
        source_rows(r->source, time, (struct slab){ COLUMN_F64, at, n, 1 }, r->ahead.time,
                    failure) ||
        account_rows_read(r->source, at, n, r->ahead.account, failure))
        return failure->status;
    for (int64_t i = 0; i < n; i++)
        if (!isfinite(r->ahead.time[i]))
            return failure_set(failure, EX_DATAERR, "%s: a time is not finite", time);
    snprintf(time, sizeof time, "%s/velocity/value", r->group);
    bool velocity = source_has(r->source, time);
    if (velocity &&
        report_rows_read_table(r, at, RECORDS(velocity_fields, n, r->ahead.row), failure))
        return failure->status;
    for (int64_t i = 0; i < n && !velocity; i++)
        r->ahead.row[i].err.velocity = r->ahead.row[i].err.velocity_error = NAN; // not known
    snprintf(time, sizeof time, "%s/dissipation/value", r->group);
    bool balanced = source_has(r->source, "/particles/all") && source_has(r->source, time);
    if (balanced &&
        report_rows_read_table(r, at, RECORDS(balance_fields, n, r->ahead.row), failure))
        return failure->status;
    bool has[BALANCE_PARTS];
    for (int k = 0; k < BALANCE_PARTS; k++) {
        snprintf(time, sizeof time, "%s/%s/value", r->group, balance_parts[k].fields[0].name);
        has[k] = balanced && source_has(r->source, time);
        if (has[k] && report_rows_read_table(
                          r, at, RECORDS(balance_parts[k].fields, n, r->ahead.row), failure))
            return failure->status;
    }
    for (int64_t i = 0; i < n; i++) {
        r->ahead.row[i].balanced = balanced;
        for (int k = 0; k < BALANCE_PARTS; k++)
            *balance_part_flag(&balance_parts[k], &r->ahead.row[i]) = has[k];
    }
    r->ahead.n = n;
    return 0;
}

int report_rows_read(struct report_rows *r, int64_t step, struct report *rep,
                     struct account *account, bool *there, struct failure *failure)
{
    const char *group = r->group;
    const bool alone = r->one_frame && r->solves == 1;
    int64_t at = alone ? 0 : table_read_row(r->solved, r->solves, step);
    *there = at >= 0;
    if (at < 0) return 0;
    bool is_read = at >= r->ahead.first && at < r->ahead.first + r->ahead.n;
    if (!is_read && read_ahead(r, at, failure)) return failure->status;
    *rep = r->ahead.row[at - r->ahead.first], *account = r->ahead.account[at - r->ahead.first];
    if (check_report(rep, group, failure)) return failure->status;
    rep->step = r->solved[at], rep->t = r->ahead.time[at - r->ahead.first];
    char *method = source_text(r->source, group, "method", failure);
    char *criterion = source_text(r->source, group, "criterion", failure);
    rep->options = source_text(r->source, group, "options", failure);
    snprintf(rep->method, sizeof rep->method, "%s", method ? method : "");
    for (int c = 0; criterion && c < CRITERION_COUNT; c++)
        if (!strcmp(criterion, criterion_name[c])) rep->criterion = c;
    free(method), free(criterion);
    if (failure->status || source_attribute(r->source, group, "eps",
                                            (struct numbers){ COLUMN_F64, -1, &rep->eps }, failure))
        return failure->status;
    if (!(rep->eps >= 0 && isfinite(rep->eps)))
        return failure_set(failure, EX_DATAERR, "%s@eps: neither 0 nor a positive number", group);
    return read_history(r->source, group, rep, failure);
}

void report_rows_close(struct report_rows *r)
{
    free(r->solved), free(r->ahead.row), free(r->ahead.account), free(r->ahead.time);
    *r = (struct report_rows){ 0 };
}

/* ---- to a document ---- */

/* One table of the balances, beside the report, whose clocks they share */
static int write_table(struct table_write *s, const struct field *table, const struct report *rep,
                       bool first, struct failure *failure)
{
    const char *solver = LAYOUT_REPORT;
    if (table_write_columns(s, solver, "/value", RECORDS(table, 1, rep), CHUNK_FRAMES, failure))
        return failure->status;
    if (first && (table_write_link(s, LAYOUT_REPORT "/step", "step", solver, table, failure) ||
                  table_write_link(s, LAYOUT_REPORT "/time", "time", solver, table, failure)))
        return failure->status;
    return 0;
}

static int write_balance(struct table_write *s, const struct report *rep, bool first,
                         struct failure *failure)
{
    if (write_table(s, balance_fields, rep, first, failure)) return failure->status;
    for (int k = 0; k < BALANCE_PARTS; k++) {
        char path[80];
        snprintf(path, sizeof path, "%s/%s/value", LAYOUT_REPORT, balance_parts[k].fields[0].name);
        // a trajectory has the terms of its first report in all of them, 0 where there is no such term
        bool has = first ? balance_part_has(&balance_parts[k], rep) : table_write_grows(s, path);
        if (has && write_table(s, balance_parts[k].fields, rep, first, failure))
            return failure->status;
    }
    return 0;
}

int report_rows_write(struct table_write *s, const struct report *rep, struct failure *failure)
{
    const char *solver = LAYOUT_REPORT;
    bool first = !table_write_grows(s, LAYOUT_REPORT "/eps/value");
    if (table_write_columns(s, solver, "/value", RECORDS(report_fields, 1, rep), CHUNK_FRAMES,
                            failure) ||
        table_write_clocks(s, solver, report_fields, rep->step, rep->t, failure) ||
        (rep->criterion == CRITERION_VELOCITY &&
         write_table(s, velocity_fields, rep, first, failure)) ||
        (rep->balanced && write_balance(s, rep, first, failure)))
        return failure->status;
    if (first &&
        (h5_attr_text(s->file, solver, "method", rep->method, failure) ||
         h5_attr_text(s->file, solver, "criterion", criterion_name[rep->criterion], failure) ||
         h5_attr(s->file, solver, "eps", h5_scalar(H5T_NATIVE_DOUBLE, &rep->eps), failure) ||
         h5_attr_text(s->file, solver, "options", rep->options ? rep->options : "{}", failure)))
        return failure->status;
    if (!rep->history || s->growing) return 0;
    const hsize_t shape[2] = { (hsize_t)rep->sweeps, 5 };
    return h5_write(s->file, LAYOUT_REPORT "/history",
                    h5_array(H5T_NATIVE_DOUBLE, 2, shape, rep->history), "1", failure);
}

static const char home[] = "/nsd/account";

/* A column each, from the table of what is watched */
struct report_rows_columns {
    struct field c[ACCOUNT_ROWS + 2];
};

static struct report_rows_columns columns(void)
{
    struct report_rows_columns t = { { FIELD(struct account, steps, I64, 1, "steps", "1", 0) } };
    for (int k = 0; k < ACCOUNT_ROWS; k++)
        t.c[1 + k] = (struct field)FIELD(struct account, worst[k], F64, 4,
                                         account_watched[k].stored, account_watched[k].units, 0);
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
                               account_watched[k].stored);
    }
    return 0;
}

int64_t account_rows_count(const struct source *source, int64_t n)
{
    struct report_rows_columns t = columns();
    for (const struct field *c = t.c; c->name; c++) {
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
    for (const struct field *c = t.c; c->name; c++) {
        const struct field one[] = { *c, { 0 } };
        snprintf(path, sizeof path, "%s/%s/value", home, c->name);
        if (!source_has(source, path)) continue; // of a version that does not watch it
        if (table_read_finite(source, home, "/value", start, RECORDS(one, n, account), failure))
            return failure->status;
    }
    for (int64_t i = 0; i < n; i++)
        if (report_rows_check(&account[i], failure)) return failure->status;
    return 0;
}

int account_rows_write(struct table_write *s, const struct account *account,
                       struct failure *failure)
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
