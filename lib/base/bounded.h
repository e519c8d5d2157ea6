/*
 * base/bounded.h: work on bytes that may come from anybody, done by a process of its own that is bounded in memory
 * and time. What breaks down there, is endless or takes all memory is a reason here (EX_DATAERR).
 */
#pragma once

#include "base/failure.h"

#include <stddef.h>
#include <stdint.h>

/*
 * What a process that reads bytes of anybody may take, and what its end means.
 */

#ifdef __SANITIZE_ADDRESS__
enum { SANITIZED = 1 };
#else
enum { SANITIZED = 0 };
#endif

/* From now on this process may take so many bytes more than it has. Without effect under a sanitizer, which needs
   terabytes of addresses. */
void limits_memory(uint64_t bytes);
/* And so many seconds more of the processor; ten times as many under a sanitizer. */
void limits_processor(uint64_t seconds);
/* Bytes that this process can have: of its limit, or of the machine */
double limits_room(void);
/* Neither is bounded any more. */
void limits_lift(void);
/* The process leaves no core where it breaks down. */
void limits_no_core(void);

/* Why a process that read `name` was ended by this signal, where a limit or a lack of memory ended it: EX_DATAERR or
   EX_SOFTWARE; else 0. */
int limits_reason(int signal, const char *name, struct failure *failure);

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
