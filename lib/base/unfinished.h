/*
 * base/unfinished.h: a file that is being made. Should the tool end by exit() before it is done, the
 * file is removed: no output is left that is none.
 */
#ifndef NSD_UNFINISHED_H
#define NSD_UNFINISHED_H

#include <sys/types.h>

struct unfinished {
    const char *path; /* NULL: done, or nothing to remove */
    dev_t device;     /* the file that was opened, */
    ino_t inode;      /* for another may have its name by then */
    struct unfinished *next;
};

/* From now on; fd is the open file. Only a regular file that is no link is removed. Both have to last. */
void unfinished_begin(struct unfinished *file, const char *path, int fd);
/* It is whole, or holds something worth keeping. */
void unfinished_done(struct unfinished *file);
/* It will not be: it is removed now. */
void unfinished_drop(struct unfinished *file);

#endif
