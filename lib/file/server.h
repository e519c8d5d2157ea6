/*
 * file/server.h: the process that reads: a child of the tool, which opens the files and asks libhdf5
 * (file/serve.h), with bounds on its memory and time. Requests come over a socket, answers go back over it,
 * and their data through shared memory.
 */
#pragma once

#include "file/request.h"

#include <sys/types.h>

/* What parent and child share. */
struct server_memory {
    char where[300]; /* the document in hand, for messages when the child is gone */
    unsigned char piece[2][REQUEST_PIECE];
};

/* The child's life: answers until the line is closed, and ends. limit: as of served_open. */
void server_run(int line, struct server_memory *shared, int files, char *const *file,
                uint64_t limit, pid_t parent) __attribute__((noreturn));
