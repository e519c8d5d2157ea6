/*
 * file/child.h: the tool's end of the process that reads (file/server.h). Whatever becomes of that, the tool goes
 * on, and says which document it was (EX_DATAERR); and none outlives its tool, or is left to be buried by
 * others.
 */
#ifndef NSD_CHILD_H
#define NSD_CHILD_H

#include "file/request.h"

struct child;

/* A new process for the documents of these files. limit: as of served_open. */
int child_start(struct child **child, int files, char *const *file, uint64_t limit,
                struct failure *failure);
void child_close(struct child *child);
/* In a new process by fork(): those that read for the old one are none of this one's, which neither asks nor ends them. */
void child_forget_all(void);
/* Has it ended? */
bool child_lost(const struct child *child);
/* Asks, and takes all pieces of the answer. EX_DATAERR also where the child broke down over it. */
int child_ask(struct child *child, const struct request *request, struct taker *taker,
              struct failure *failure);

#endif
