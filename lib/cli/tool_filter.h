/* cli/tool_filter.h: what the tools that turn frames into frames have in common. */
#ifndef NSD_TOOL_FILTER_H
#define NSD_TOOL_FILTER_H

#include "io/frame.h"

/*
 * Every frame of every document of the files (none: standard input) through each(), with the
 * command's line in its history, out to standard output as it is done. `where` names the document
 * for messages. Ends the tool where something cannot be read or written.
 */
void tool_filter(int files, char *const *file, void (*each)(struct frame *, const char *where));

/* Ends the tool with EX_DATAERR unless f is a packing; with its contacts detected and not yet used
   to move it; solved. */
void tool_wants_packing(const struct frame *, const char *where);
void tool_wants_contacts(const struct frame *, const char *where);
void tool_wants_solution(const struct frame *, const char *where);

#endif
