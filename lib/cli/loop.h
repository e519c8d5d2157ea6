/*
 * cli/loop.h: a program in the loop of nsd-step: before steps it is told what there is, and answers what shall act. Its answers
 * go into the packing's words [bodies/outside.h], and with its frames into documents, from which --replay has them again.
 */
#ifndef NSD_LOOP_H
#define NSD_LOOP_H

#include "api/acts.h"
#include "cli/cli.h"
#include "io/frame.h"

extern const struct cli_option options_loop[]; /* --with ..., --replay */

/* Ends the tool with EX_USAGE where options contradict each other. */
void loop_check(void);
/* Is there a program, or are there answers to replay? */
bool loop_asks(void);
/* Ends the tool with EX_DATAERR where --with-boundaries names what is no wall of this packing, that of the run. */
void loop_choose_boundaries(const struct packing *p);
/* Starts the program, or reads the answers. */
void loop_open(void);
/*
 * Before the frame's next step, the first or a later one of this run: asks, where it is time to, and does what is answered.
 * False: the run ends before the step, because the program says so or, with a status in why, because it failed.
 */
bool loop_before_step(struct frame *f, struct acts *acts, bool first, struct why *why);
/* The run has ended. */
void loop_close(void);

#endif
