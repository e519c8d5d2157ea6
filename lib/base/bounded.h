/*
 * base/bounded.h: work on bytes that may come from anybody, done by a process of its own that is bounded in memory
 * and time. What breaks down there, is endless or takes all memory is a reason here (EX_DATAERR).
 */
#ifndef NSD_BOUNDED_H
#define NSD_BOUNDED_H

#include "base/failure.h"

#include <stddef.h>
#include <stdint.h>

struct bounded;

/* The process's answer continues with these bytes. Returns 0, or EX_SOFTWARE where there is no room. */
int bounded_put(struct bounded *to, const void *bytes, size_t size, struct failure *failure);

struct bounded_task {
    int (*work)(void *with, struct bounded *to, struct failure *failure);
    void *with;
    const char *name; /* of the file that it works on, for messages; */
    uint64_t size;    /* and its bytes */
};

/*
 * The task in a new process: it may take 256 MiB and eight times the file, and 4 s of the processor and a second for
 * 10 MB. *answer: what it has put, *n bytes; to be given
 * back by bounded_free. Returns 0, the work's own reason, or EX_DATAERR.
 */
int bounded_run(const struct bounded_task *task, void **answer, size_t *n, struct failure *failure);
void bounded_free(void *answer, size_t n);

#endif
