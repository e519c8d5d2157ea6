/* draw/values.c: sums over contacts, and a table read [draw/values.h]. */
#include "draw/values.h"

#include "base/mark.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char blank[] = " \t\r\n,";

enum {
    LINE = 1 << 20,      /* bytes of a line */
    MOST_PIPED = 1 << 22 /* lines of a table that is no file: 100 MB of memory */
};

/* ---- the table ---- */

static int paint_compare(const void *a, const void *b)
{
    const struct value *x = a, *y = b;
    if (x->step != y->step) return x->step < y->step ? -1 : 1;
    return (x->id > y->id) - (x->id < y->id);
}

static struct value *paint_add_row(struct values *v)
{
    if (v->n == v->room) {
        int64_t room = v->room ? 2 * v->room : 1024;
        struct value *more = realloc(v->row, (size_t)room * sizeof *more);
        if (!more) return NULL;
        v->row = more, v->room = room;
    }
    return &v->row[v->n++];
}

struct paint_columns {
    int id, step, x; /* which; -1: not there */
};

/* The first line: names. */
static int paint_read_names(struct values *v, char *line, const char *path, const char *column,
                      struct paint_columns *c, struct failure *failure)
{
    int k = 0;
    *c = (struct paint_columns){ -1, -1, -1 };
    line += mark_length(line, strlen(line));
    line += strspn(line, "# \t");
    for (char *name = strtok(line, blank); name; name = strtok(NULL, blank), k++) {
        if (!strcmp(name, "id")) c->id = k;
        if (!strcmp(name, "step")) c->step = k;
        if (column && strcmp(name, column) != 0) continue;
        c->x = k;
        free(v->name);
        if (!(v->name = strdup(name))) return failure_set(failure, EX_SOFTWARE, "no memory");
    }
    if (c->id < 0) return failure_set(failure, EX_DATAERR, "%s:1: no column is named id", path);
    if (c->x < 0) return failure_set(failure, EX_DATAERR, "%s:1: no column is named %s", path, column);
    return 0;
}

static int read_row(struct values *v, char *line, const char *path, int64_t number,
                    const struct paint_columns *c, struct failure *failure)
{
    int k = 0, found = 0;
    struct value *row = paint_add_row(v);
    if (!row) return failure_set(failure, EX_SOFTWARE, "no memory for %s", path);
    *row = (struct value){ .step = -1, .x = NAN };
    for (char *word = strtok(line, blank); word; word = strtok(NULL, blank), k++) {
        char *end;
        if (k != c->id && k != c->step && k != c->x) continue;
        double x = strtod(word, &end);
        bool none = k == c->x && (!strcmp(word, "null") || !strcmp(word, "nan"));
        if ((*end || (k != c->x && !(fabs(x) < 1e15))) && !none)
            return failure_set(failure, EX_DATAERR, "%s:%lld: '%s' is no number", path, (long long)number,
                           word);
        found++;
        if (k == c->id) row->id = (int64_t)x;
        if (k == c->step) row->step = (int64_t)x;
        if (k == c->x) row->x = none ? NAN : x;
    }
    if (found < (c->step < 0 ? 2 : 3) && !(c->id == c->x && found))
        return failure_set(failure, EX_DATAERR, "%s:%lld: too few columns", path, (long long)number);
    return 0;
}

int values_read(struct values *v, const char *path, const char *column, struct failure *failure)
{
    FILE *in = fopen(path, "r");
    struct paint_columns c = { -1, -1, -1 };
    char *line = malloc(LINE);
    struct stat st;
    if (in && !line) failure_set(failure, EX_SOFTWARE, "no memory");
    if (!in) free(line);
    if (!in) return failure_set(failure, EX_NOINPUT, "%s: %s", path, strerror(errno));
    bool file = !fstat(fileno(in), &st) && S_ISREG(st.st_mode);
    for (int64_t number = 1; !failure->status && fgets(line, LINE, in); number++) {
        if (strlen(line) == LINE - 1)
            failure_set(failure, EX_DATAERR, "%s:%lld: a line of more than %d bytes", path,
                    (long long)number, LINE - 2);
        else if (!file && number > MOST_PIPED)
            failure_set(failure, EX_DATAERR, "%s: too many lines for a pipe (endless?): put it into a file",
                    path);
        else if (number == 1)
            paint_read_names(v, line, path, column, &c, failure);
        else if (line[strspn(line, blank)] && *line != '#')
            read_row(v, line, path, number, &c, failure);
    }
    if (!failure->status && ferror(in)) failure_set(failure, EX_NOINPUT, "%s: %s", path, strerror(errno));
    if (!failure->status && !v->name) failure_set(failure, EX_DATAERR, "%s: empty", path);
    free(line), fclose(in);
    if (v->n) qsort(v->row, (size_t)v->n, sizeof *v->row, paint_compare);
    return failure->status;
}

void values_free(struct values *v)
{
    free(v->name), free(v->row);
    *v = (struct values){ 0 };
}

static double value_at(const struct values *v, int64_t step, int64_t id)
{
    const struct value exact = { step, id, 0 }, any = { -1, id, 0 };
    if (!v || !v->n) return NAN;
    const struct value *found = bsearch(&exact, v->row, (size_t)v->n, sizeof *v->row, paint_compare);
    if (!found) found = bsearch(&any, v->row, (size_t)v->n, sizeof *v->row, paint_compare);
    return found ? found->x : NAN;
}

/* ---- of a packing ---- */

void values_of(double *out, enum colour by, const struct packing *p, const struct contacts *s,
               const struct values *values)
{
    bool solved = s && s->found;
    for (int64_t i = 0; i < p->n; i++)
        out[i] = by == COLOUR_VALUE ? value_at(values, p->step, p->id[i]) : solved ? 0 : NAN;
    for (int64_t i = 0; by != COLOUR_VALUE && solved && i < s->n; i++) {
        double f = s->found[i].r[0] / p->dt;
        if (!(f > 0)) continue;
        double x = by == COLOUR_FORCE ? f : 1;
        out[s->c[i].b] += x;
        if (s->c[i].a >= 0) out[s->c[i].a] += x;
    }
}
