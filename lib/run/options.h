/*
 * run/options.h: the options of the solver and of the contacts, the same in every tool that has
 * them; what they are when they are not given; and what is said of a solve.
 */
#pragma once

#include "file/frame.h"
#include "run/cli.h"
#include "state/account.h"
#include "step/step_options.h"

extern const struct cli_option options_run[]; /* -j, --device, --log, -e */

extern const struct cli_option options_contacts[]; /* --stiffness */

/* Does a run end with the first step that fails its account? */
bool options_end_on_failure(void);

/* Ends the tool with EX_USAGE where options contradict each other; to be called first. */
void options_check(void);

/* Options and defaults for a packing with this dt, or for an FCLIB problem (foreign, dt = 1). */
struct step_opt options_step(double dt, bool foreign);

/* All that shapes the result, as JSON for the document; NULL when memory is short. To be freed. */
char *options_json(const struct step_opt *step);

/* Puts --theta into the packing; EX_USAGE where contacts were detected with another. */
void options_theta(struct packing *packing, bool detected);
/*
 * Puts what is done about overlap into the packing: --overlap-rule, keep with --protocol paper, else what the
 * document says, else nsd's choice. Of contacts that are detected it may change only what comes
 * after the solve; else EX_USAGE.
 */
void options_overlap(struct packing *packing, bool detected);

/* Sets the stiffness of contacts: --stiffness, else the frame's own. fixed: a file that has one, which another may not
   follow; or NULL */
void options_stiffness(struct frame *frame, const char *fixed);
/* Will that give springs to contacts, whatever the frame has? */
bool options_adds_springs(void);

/*
 * --log: opens the file at once; then a line of JSON for each solve, with the clock's seconds,
 * which no document has, and in the last of a run its account. Ends the tool where it cannot be written, and where it is one of the files
 * that the tool reads or its output (NULL: standard output).
 */
void options_log_open(int files, char *const *file, const char *output);
/* account: or NULL; names: those of its walls */
void options_log(const struct report *report, const struct account *account,
                 const struct names *names);
void options_log_close(void);

/* What a report's criterion is called: eps_glob, scaled or natural. */
const char *options_error(enum criterion criterion);

/* To stderr: that a solver could not do what was asked or gave up, and why; nothing where it did neither. */
void options_warn(const char *where, const struct report *r);

/* To stderr, once for each reason: that the device asked for did not solve this, and why; nothing where it did */
void options_warn_cpu(const char *where, const struct report *r);
/* The end of the device, where one was used. To stderr: which it was, and what went over the bus in a solve, on the average */
void options_leave_device(void);

/* Says on stderr how a solve went: "1135 contacts, exact: 812 sweeps, eps_glob 9.9e-11, 0.04 s" */
void options_summary(const char *where, const struct report *report);
