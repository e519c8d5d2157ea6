/*
 * cli/partner.h: a program that is started once, and is written to and read from line by line, with a bound on the time
 * that it takes and on what it says.
 */
#ifndef NSD_PARTNER_H
#define NSD_PARTNER_H

#include "base/why.h"

#include <stddef.h>

struct partner;

/* Starts /bin/sh -c command. Returns 0, or EX_UNAVAILABLE with the reason, as all do. */
int partner_start(struct partner **partner, const char *command, struct why *why);
/* Writes it all within so many seconds. */
int partner_write(struct partner *partner, const void *bytes, size_t n, double seconds,
                  struct why *why);
/* The next line, of at most so many bytes, within so many seconds. It ends with 0 in place of the end of line, and is valid until
   the next call. */
int partner_line(struct partner *partner, char **line, size_t *n, size_t most, double seconds,
                 struct why *why);
/* It reads an end of file, and is waited for so long, then killed; NULL: nothing. */
void partner_end(struct partner *partner, double seconds);

#endif
