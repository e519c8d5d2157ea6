/*
 * run/tool_filter.h: what the tools share that read frames and write each of them, changed:
 * nsd-detect, nsd-solve, nsd-move.
 */
#pragma once

#include "file/frame.h"

/*
 * Reads every frame of every document of the files (of standard input where there are none), passes
 * it through each(), adds the command to its history and writes it to standard output at once, or to the
 * file of -o.
 * `where` names the document, for messages. Ends the tool where a frame cannot be read or written.
 */
void tool_filter(int files, char *const *file, void (*each)(struct frame *, const char *where));

/* Each ends the tool with EX_DATAERR unless the frame is a packing; */
void tool_wants_packing(const struct frame *f, const char *where);
/* a packing with contacts that have not moved it yet; */
void tool_wants_contacts(const struct frame *f, const char *where);
/* and these solved. */
void tool_wants_solution(const struct frame *f, const char *where);
