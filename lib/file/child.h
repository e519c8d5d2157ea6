/*
 * file/child.h: the tool's end of the process that reads (file/server.h). Whatever becomes of that, the tool goes
 * on, and says which document it was (EX_DATAERR); and none outlives its tool, or is left to be buried by
 * others.
 */
#pragma once

#include "file/h5.h"
#include "file/object.h"
#include "file/request.h"

struct child;

/* A new process for the documents of these files. limit: as of served_open. */
int child_start(struct child **child, int files, char *const *file, uint64_t limit,
                struct failure *failure);
void child_close(struct child *child);
/* In a new process by fork(): those that read for the old one are none of this one's, which neither asks nor ends them. */
void child_forget_all(void);
/* Has it ended? */
bool child_lost(const struct child *child);
/* Asks, and takes all pieces of the answer. EX_DATAERR also where the child broke down over it. */
int child_ask(struct child *child, const struct request *request, struct taker *taker,
              struct failure *failure);

/*
 * The list of a document's objects, as the process that reads has sent it, and the values
 * that came along with it: for these nothing has to be asked.
 */

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
