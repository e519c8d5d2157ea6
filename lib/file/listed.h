/*
 * file/listed.h: the list of a document's objects, as the process that reads has sent it, and the values
 * that came along with it: for these nothing has to be asked.
 */
#ifndef NSD_LISTED_H
#define NSD_LISTED_H

#include "file/h5.h"
#include "file/object.h"

struct list {
    unsigned char *bytes; /* a sequence of objects */
    struct listed *object;
    int64_t *sorted; /* [count] objects, then attributes, by their paths */
    int64_t count;
};

/* Takes the bytes over, to be freed by list_free even after a failure. EX_DATAERR: no such sequence. */
int list_open(struct list *list, unsigned char *bytes, uint64_t size, struct failure *failure);
void list_free(struct list *list);

/* The object under this path; NULL: there is none. */
const struct listed *list_find(const struct list *list, const char *path);
/* An attribute that came with the list; NULL: it has to be asked for. */
const struct listed *list_attribute(const struct list *list, const char *path, const char *name);
/*
 * Numbers first .. first+n-1 of it, converted into out; false where they are not there or do not fit,
 * which has to be told.
 */
bool listed_numbers(const struct listed *listed, uint64_t first, uint64_t n, enum column_type type,
                    void *out);

#endif
