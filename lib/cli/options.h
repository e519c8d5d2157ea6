/* cli/options.h: the solver's options, the same for nsd-solve and nsd-step. */
#ifndef NSD_OPTIONS_H
#define NSD_OPTIONS_H

#include "cli/cli.h"
#include "solve/step.h"

struct options {
    int method, global, criterion, order, newton; /* places in their lists; -1: not given */
    double eps, alpha, newton_eps, newton_abs, max_seconds;
    double relax; /* 0: the solver's */
    double gap;
    double theta; /* -1: the document's */
    int64_t max_sweeps, newton_max, threads;
    bool warm, every_sweep, history, strict;
    const char *log; /* or NULL */
};

extern struct options options;                   /* with the defaults in it */
extern const struct cli_option options_solve[];  /* the solver's own */
extern const struct cli_option options_run[];    /* -j, --log, -e */
extern const struct cli_option options_detect[]; /* --gap, --theta */

/* What was asked, for a packing with this dt, or for an FCLIB problem (dt = 1). */
struct step_opt options_step(double dt, bool foreign);

/* What it goes by: the local method of Gauss-Seidel, else the solver */
const char *options_solver(const struct step_opt *);

/* The same as JSON, all of it, for the document; NULL when memory is short. To be freed. */
char *options_json(const struct step_opt *);

/* --theta into the packing; EX_USAGE where it contradicts contacts that are already there. */
void options_theta(struct packing *, bool detected);

/* --log: opened at once, then one JSON line a solve. Ends the tool when it cannot be written, or is
   one of the files that the tool reads or its output (NULL: the standard output). */
void options_log_open(int files, char *const *file, const char *output);
void options_log(const struct report *);
void options_log_close(void);

/* A word about a solve, for people: "1135 contacts, exact: 812 sweeps, eps_glob 9.9e-11, 0.04 s" */
void options_summary(const char *where, const struct report *);

#endif
