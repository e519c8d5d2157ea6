/*
 * base/limits.h: what a process that reads bytes of anybody may take, and what its end means.
 */
#ifndef NSD_LIMITS_H
#define NSD_LIMITS_H

#include "base/failure.h"

#include <stdint.h>

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

#endif
