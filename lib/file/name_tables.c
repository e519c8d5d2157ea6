#include "file/name_tables.h"

#include "file/h5.h"
#include "file/table_read.h"

#include <stdlib.h>
#include <string.h>

#define NAMES_HOME "/nsd/names"
static const char text_path[] = NAMES_HOME "/text";

int name_tables_write(struct table_write *s, const struct packing *p, struct failure *failure)
{
    const struct names *names = &p->names;
    bool growing = s->growing;
    size_t length = 1;
    if (!names->n) return 0;
    for (int32_t k = 0; k < names->n; k++) length += strlen(names->text[k]) + 1;
    char *text = calloc(length, 1), *at = text;
    if (!text) return failure_set(failure, EX_SOFTWARE, "no memory for the names");
    for (int32_t k = 0; k < names->n; k++) {
        size_t n = strlen(names->text[k]);
        memcpy(at, names->text[k], n), at[n] = '\n', at += n + 1;
    }
    s->growing = false;
    if (!h5_write_text(s->file, text_path, text, failure) && names->rows)
        table_write_columns(s, NAMES_HOME, "", RECORDS(layout_names, names->rows, names->row), 0, failure);
    s->growing = growing;
    free(text);
    return failure->status;
}

static int read_rows(struct source *r, struct packing *p, struct failure *failure)
{
    const char *path = NAMES_HOME "/boundary";
    uint64_t shape[4];
    if (!source_has(r, path)) return 0;
    if (source_shape(r, path, shape) != 1 || shape[0] > NAMED_MOST)
        return failure_set(failure, EX_DATAERR, "%s: not of one dimension, or of more than %d rows", path,
                       NAMED_MOST);
    p->names.row = calloc((size_t)shape[0] + 1, sizeof *p->names.row);
    if (!p->names.row) return failure_set(failure, EX_SOFTWARE, "no memory for the names");
    p->names.rows = (int32_t)shape[0];
    return table_read_columns(r, NAMES_HOME, "", 0, RECORDS(layout_names, p->names.rows, p->names.row),
                              failure);
}

int name_tables_read(struct source *r, struct packing *p, struct failure *failure)
{
    if (!source_has(r, text_path)) return 0;
    char *text = source_text(r, text_path, NULL, failure);
    for (char *at = text, *end; at && *at && !failure->status; at = end + 1) {
        int32_t had = p->names.n, which;
        if (!(end = strchr(at, '\n'))) {
            failure_set(failure, EX_DATAERR, "%s: the last name does not end", text_path);
            break;
        }
        *end = 0;
        if (names_add(&p->names, at, &which, failure))
            failure_set(failure, EX_DATAERR, "%s: a name that is no name", text_path);
        else if (p->names.n == had)
            failure_set(failure, EX_DATAERR, "%s: \"%s\" occurs twice", text_path, at);
    }
    free(text);
    return failure->status ? failure->status : read_rows(r, p, failure);
}
