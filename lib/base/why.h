/*
 * base/why.h: the reason of a failure, carried from where it happened to the tool that reports it.
 *
 * A function of lib/ that can fail takes a struct why and prints nothing. It returns 0 for success,
 * else the exit status of sysexits.h that fits: EX_DATAERR (65) the input is wrong, EX_NOINPUT (66)
 * the input cannot be opened, EX_SOFTWARE (70) a fault of our own or no memory, EX_IOERR (74) the
 * output cannot be written.
 */
#ifndef NSD_WHY_H
#define NSD_WHY_H

#include <sysexits.h>

struct why {
    int status;     /* 0: nothing has failed */
    char text[400]; /* one line, "thing: trouble" */
};

/*
 * Records a reason, unless there is one already: the first is the one that counts. Control characters
 * become '?', for names out of files are in it. Returns the status on record, so that
 * `return why_set(...)` reads well.
 */
int why_set(struct why *why, int status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
