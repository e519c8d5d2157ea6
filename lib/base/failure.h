/*
 * base/failure.h: the reason of a failure, carried from where it happened to the tool that reports it.
 *
 * A function of lib/ that can fail with a reason takes a struct why, prints nothing and returns 0,
 * or an exit status of sysexits.h: EX_DATAERR (65) the input is wrong, EX_NOINPUT (66) it cannot be
 * opened, EX_SOFTWARE (70) out of memory or a bug, EX_IOERR (74) it cannot be written.
 */
#pragma once

#include <sysexits.h>

struct failure {
    int status;     /* 0: no failure */
    char text[400]; /* "thing: trouble", one line */
};

/* Sets the reason unless there is one already. Control characters become '?', for names out of
   files are in it. Returns the status of the first, never 0, for use as `return why_set(...)`. */
int failure_set(struct failure *failure, int status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Names out of files are in messages: control characters, C1 too, and bytes that are no UTF-8 become '?', for
   they may move a terminal. */
void failure_plain(char *text);

/* What the static analyser, which sees one file at a time, has to know of it */
#ifdef __clang_analyzer__
void why_said(const char *format, ...);
#define failure_set(failure, code, ...)                                                            \
    ((failure)->status ? (failure)->status : (why_said(__VA_ARGS__), (failure)->status = (code)))
#endif
