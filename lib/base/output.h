/*
 * base/output.h: an output file. What a tool writes goes into a new file next to its target, hidden, which
 * takes the target's place in one stroke when there is something whole in it. Until then nothing of the
 * user's is touched; a tool that fails, or is stopped by a signal, removes the new file and leaves the
 * target as it was; in the program of somebody else a signal leaves the new file, which the next writer
 * uses. What is no regular file (a pipe, a device, /dev/stdout) is written where it is.
 *
 * An output has one writer: both files are locked, and a second writer is refused.
 */
#pragma once

#include "base/failure.h"

#include <stdbool.h>
#include <stdio.h>
#include <sys/types.h>

struct output {
    const char *name; /* as it was given, for messages; borrowed */
    int fd;
    char *target; /* where it belongs, links followed; NULL: it is written where it is */
    char *at;     /* where it is: next to the target, then there */
    int old;      /* the file whose place it takes, open and locked; -1: there is none */
    bool placed, listed, borrowed;
    bool nameless; /* it had no name when it was opened: a file in memory */
    pid_t child;   /* another program that writes it, and is killed should the tool end now; or 0 */
    struct output *next; /* of those that are to be removed should the tool end now */
};

/* Opens a new file for this path; EX_IOERR: it could not be written, or another program is writing it.
   The struct has to stay where it is until output_close or output_drop. */
int output_open(struct output *o, const char *path, struct failure *failure);
/* There is something whole in it: it takes its place, and may grow there. */
int output_place(struct output *o, struct failure *failure);
/* The same, but it is still removed should the tool end before output_close. */
int output_place_for_now(struct output *o, struct failure *failure);
/* It is whole, unless why has a reason, which drops it: it takes its place if it has not yet, and is closed.
   EX_IOERR also where another program has removed it. */
int output_close(struct output *o, struct failure *failure);
/* It will not be: it is closed, and removed unless it has its place for good. */
void output_drop(struct output *o);

/* An open regular file of somebody else, standard output: emptied should the tool end before output_keep */
void output_borrow(struct output *o, int fd, const char *name);
/* What is in its place may stay there, or has been written over. */
void output_keep(struct output *o);

/* The same as a stream: opened; and closed by what returns EX_IOERR also where any of it was not written */
FILE *output_stream(struct output *o, const char *path, struct failure *failure);
int output_stream_close(struct output *o, FILE *stream, struct failure *failure);

/* Locks a regular file for one writer until it is closed, or another time; how: F_OFD_SETLK, F_OFD_SETLKW.
   Returns 0, or EX_IOERR where another program has it. */
int output_lock(int fd, int how, const char *name, struct failure *failure);
void output_unlock(int fd);
/* Has another program removed the open file, which had a name once? */
bool output_removed(int fd);

/* Is this the library in the program of somebody else? Then the process is not ours: its signals stay as they are, and it may have
   other threads. */
void embedded_set(void);
bool embedded_is(void);
