/*
 * step/step_options.h: the options of a step: of the solver and of the contacts, one table for command lines and for
 * programs that call the library; and what they are when they are not given.
 */
#pragma once

#include "base/option.h"
#include "step/step.h"

/* What was given, and which of them were */
struct options {
    int protocol;                                  /* 0: nsd's, 1: the paper's */
    int local;                                     /* 0: auto; else 1 + the index in methods[] */
    int solver, criterion, order, newton, overlap; /* indices among their choices */
    double tolerance, alpha, newton_eps, newton_abs, max_seconds, relax;
    double gap; /* m */
    double theta;
    int64_t max_sweeps, newton_max, threads;
    double small; /* radii: small steps; 0: none */
    double bound; /* of what is missing of their reactions; 0: none */
    bool warm, every_sweep, history, strict, keep_going;
    const char *log;    /* or NULL */
    const char *dt;     /* s; or NULL */
    const char *device; /* that makes the sweeps, as device_open() has it; NULL: the CPU */
    uint64_t given;     /* which of them were, by options_give() */
};

/* That of a tool, whose members the tables name. Another one has them as far from its beginning. */
extern struct options options;
extern const struct cli_option options_solve[];  /* the solver's own */
extern const struct cli_option options_detect[]; /* --gap, --theta, --overlap-rule */
extern const void
    *const options_others[]; /* members of which tools have options of their own; NULL at the end */

/* `to` is a member of `options`, as the tables have it: the same member of o, */
void *options_member(struct options *o, const void *to);
/* is given from now on; */
void options_give(struct options *o, const void *to);
/* was it given? */
bool options_has(const struct options *o, const void *to);

/* The words that --overlap-rule takes */
struct cli_choice options_overlap_choice(int index);
/* The default of the member of `options` that `to` points to, as --help shows it. */
const char *options_usual(const void *to);
/* EX_USAGE where options contradict each other */
int options_names(const struct options *o, struct failure *failure);

/* Options and defaults for a packing with this dt, or for an FCLIB problem (foreign, dt = 1). */
struct step_opt options_step_of(const struct options *o, double dt, bool foreign);
/* Radii: how far small steps move bodies; 0: each step is one solve. That is so where an option chooses how a step is solved, or the
   packing has a rule of overlaps that is not the default, an adapted time step or contacts with a stiffness. */
double options_small_of(const struct options *o, const struct packing *p);
/* Is it --order alone that asks for one solve per step? */
bool options_order_alone(const struct options *o, const struct packing *p);
/* All that shapes the result, as JSON for the document; NULL when memory is short. To be freed. */
char *options_json_of(const struct options *asked, const struct step_opt *step);
/* What is to be done about overlap: --overlap-rule, keep with --protocol paper, else what the document says, else nsd's choice */
enum overlap options_overlap_of(const struct options *o, const struct packing *p, bool detected);
