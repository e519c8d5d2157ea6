/*
 * file/unknown.h: what nsd does not know in a document it reads, held in memory, and written into the
 * documents that come of it: objects of the root and of the groups of particles, walls, observables
 * and /nsd whose names nsd does not use. FCLIB problems are among them.
 */
#pragma once

#include "base/failure.h"

#include <stdbool.h>
#include <stdint.h>

struct source;
struct unknown;

/*
 * All of it, with attributes; NULL where there is nothing. Unless `whole` (the document has one frame)
 * only what does not depend on time. EX_DATAERR: there is something that is neither numbers nor texts,
 * and would be lost.
 */
int unknown_read(struct unknown **unknown, struct source *source, bool whole,
                 struct failure *failure);
/* The path of the first object that unknown_read leaves out unless `whole`, or NULL. */
const char *unknown_timed(struct source *source);
/* One more owner, who frees it too. */
struct unknown *unknown_share(struct unknown *unknown);
void unknown_free(struct unknown *unknown);
/* Into the HDF5 file (an hid_t), where a name is not taken yet; `stale`: without FCLIB problems. */
int unknown_write(const struct unknown *unknown, int64_t file, bool stale, struct failure *failure);
