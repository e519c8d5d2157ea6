/*
 * run/loop.h: a program in the loop of nsd-step: before steps it is told what there is, and answers what shall act. Its answers
 * go into the packing's words [state/external_force.h], and with its frames into documents, from which --replay has them again.
 */
#pragma once

#include "file/frame.h"
#include "run/cli.h"
#include "run/control.h"

#include <signal.h>

extern const struct cli_option options_loop[]; /* --with ..., --replay */

/* Ends the tool with EX_USAGE where options contradict each other. */
void loop_check(void);
/* Is there a program, or are there answers to replay? */
bool loop_asks(void);
/* Ends the tool with EX_DATAERR where --with-walls names what is no wall of this packing, that of the run. */
void loop_choose_walls(const struct packing *p);
/* Starts the program, or reads the answers for a run from this packing on; *stop: other than 0 when the run is to end, as by
   a signal. */
void loop_open(const struct packing *p, const volatile sig_atomic_t *stop);
/*
 * Before the frame's next step, the first or a later one of this run: asks, where it is time to, and does what is answered.
 * False: the run ends before the step, because the program says so, because *stop does or, with a status in why, because it
 * failed.
 */
bool loop_before_step(struct frame *f, struct control *acts, bool first, struct failure *failure);
/* The run has ended. A program that has written more than was read has a status in why: its answers may have acted in other
   steps. */
void loop_close(struct failure *failure);
