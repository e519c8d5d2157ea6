/*
 * run/partner.h: a program that is started once, and answers in lines what is written to it, with a bound on the time that it
 * takes and on the size of its answers. It does not outlive this process, however that ends.
 */
#pragma once

#include "base/failure.h"

#include <signal.h>
#include <stddef.h>

struct partner;

/* Starts /bin/sh -c command; *stop: other than 0 when nothing is to be waited for any more, as by a signal. Returns 0, or
   EX_UNAVAILABLE with the reason, as all do. */
int partner_start(struct partner **partner, const char *command, const volatile sig_atomic_t *stop,
                  struct failure *failure);
/* Writes it all within so many seconds. */
int partner_write(struct partner *partner, const void *bytes, size_t n, double seconds,
                  struct failure *failure);
/* An answer begins: from now on it may take so many seconds. */
void partner_expect(struct partner *partner, double seconds);
/* The next line, of at most `most` bytes; it ends with 0 in place of the end of line, and is valid until the next call. */
int partner_line(struct partner *partner, char **line, size_t *n, size_t most,
                 struct failure *failure);
/* Has it written nothing that was not read? */
int partner_check_silent(struct partner *partner, struct failure *failure);
/* It reads an end of file, and is waited for so long, then killed; NULL: nothing. Fails if it has written what was not
   read. */
int partner_end(struct partner *partner, double seconds, struct failure *failure);
