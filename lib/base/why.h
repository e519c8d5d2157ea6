/*
 * base/why.h: the reason of a failure, carried from where it happened to the tool that says it.
 *
 * A function of lib/ that can fail takes a struct why, prints nothing and returns 0 for good or the
 * exit status of sysexits.h that fits: EX_DATAERR (65) the input is wrong, EX_NOINPUT (66) it cannot
 * be opened, EX_SOFTWARE (70) we are wrong or out of memory, EX_IOERR (74) it cannot be written.
 */
#ifndef NSD_WHY_H
#define NSD_WHY_H

#include <sysexits.h>

struct why {
    int status;
    char text[400]; /* "thing: trouble", one line */
};

/* Keep the first reason given; returns its status, so that `return why_set(...)` reads well. */
int why_set(struct why *, int status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
