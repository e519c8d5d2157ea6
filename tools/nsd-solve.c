/* nsd-solve: solves the contact problem of one step, or one in the FCLIB format. */
#include "run/cli.h"
#include "run/options.h"
#include "run/tool_filter.h"

#include <stdio.h>
#include <stdlib.h>

static bool forces, verbose;

static const struct cli_option own[] = {
    { CLI_REAL, 0, "theta", &options.theta, "T", .max = 1,
      .help = "check that the contacts were detected with T [document]" },
    { CLI_CHOICE, 0, "overlap-rule", &options.overlap, .choice = options_overlap_choice,
      .help = "change how nsd-move treats overlaps [document]" },
    { CLI_FLAG, 'w', "warm", &options.warm, .help = "start from the reactions in the document" },
    { CLI_UNFLAG, 0, "cold", &options.warm, .help = "start from reactions 0, as in the paper",
      .usual = options_usual },
    { CLI_FLAG, 0, "history", &options.history,
      .help = "store the error terms of every sweep in the document" },
    { CLI_FLAG, 0, "forces", &forces, .help = "store the forces of the contacts as vectors in N" },
    { CLI_FLAG, 'v', "verbose", &verbose, .silent = true,
      .help = "print one line per document [if it did not converge]" },
    { 0 },
};
static const struct cli_option *const tables[] = { options_solve, own, options_run, NULL };

const struct cli_tool tool = {
    "nsd-solve", "[FILE ...]",
    "Solves the frictional contact problem.\n"
    "Reads packings with contacts, or FCLIB problems (local or global); writes each with its\n"
    "reactions and a report.",
    tables,
    "  nsd-cat --last out.h5 | nsd-detect | nsd-solve | nsd-err | jq .natural\n"
    "  nsd-solve KaplasTower-i1061-4.hdf5 | nsd-err | jq .natural\n"
};

/* ---- what is said of a stream ---- */

static struct {
    int64_t documents, missed; /* those that did not converge */
    int64_t contacts, sweeps;
    double worst, seconds; /* the largest error, and in which criterion */
    enum criterion criterion;
    struct report only; /* of the first document */
    char where[300];
    bool said; /* a line of its own */
} total;

static void count(const char *where, const struct report *r)
{
    double error = err_of(&r->err, r->criterion);
    total.said = verbose || !r->converged || r->given_up;
    if (total.said) options_summary(where, r);
    if (!total.documents) total.criterion = r->criterion;
    if (!total.documents++) total.only = *r, snprintf(total.where, sizeof total.where, "%s", where);
    total.missed += !r->converged;
    total.contacts += r->err.contacts, total.sweeps += r->sweeps, total.seconds += r->seconds;
    if (!(error <= total.worst)) total.worst = error, total.criterion = r->criterion;
}

/* One line of one document is that of the stream. */
static void summary(void)
{
    char missed[60] = "";
    if (total.documents == 1 && !total.said) options_summary(total.where, &total.only);
    if (total.documents < 2) return;
    if (total.missed)
        snprintf(missed, sizeof missed, ": %lld NOT CONVERGED", (long long)total.missed);
    warn("%lld documents, %lld contacts, %lld sweeps, largest %s %.3g, %.3g s%s",
         (long long)total.documents, (long long)total.contacts, (long long)total.sweeps,
         options_error(total.criterion), total.worst, total.seconds, missed);
}

/* The solver calls it at every evaluation of the criterion. */
static void show(int32_t sweeps, double value)
{
    progress("%d sweeps, %.2g", sweeps, value);
}

/* The reactions to start from: those of the last step; with --warm those that the document has already */
static void start_from(struct frame *f, const struct step_opt *o)
{
    struct failure failure = { 0 };
    struct memory *m = &f->packing.memory;
    memory_set(m, o->warm);
    if (!o->warm || (cli_given(&options.warm) && f->contacts.found)) return;
    if (memory_give(m, &f->contacts, packing_rolls(&f->packing), &failure)) die_why(&failure);
}

static void solve(struct frame *f, const char *where)
{
    struct failure failure = { 0 };
    if (!f->foreign) tool_wants_contacts(f, where);
    struct step_opt o = options_step(f->foreign ? 1 : f->packing.dt, f->foreign);
    o.solve.progress = show;
    report_free(&f->report);
    f->report.options = options_json(&o);
    if (!f->foreign) {
        options_theta(&f->packing, true);
        options_overlap(&f->packing, true);
        start_from(f, &o);
        if (step_solve(&f->packing, &f->contacts, &o, &f->report, &failure)) die_why(&failure);
    } else {
        struct delassus *W = &f->problem.W;
        free(f->u);
        f->u = calloc((size_t)(W->d * W->n) + 1, sizeof *f->u);
        if (!f->u) die(EX_SOFTWARE, "%s: no memory", where);
        if (step_solve_delassus(W, f->u, &o, &f->report, &failure)) die_why(&failure);
    }
    f->reported = true;
    f->forces |= forces;
    options_log(&f->report, NULL, NULL);
    options_warn_cpu(where, &f->report);
    count(where, &f->report);
}

int tool_main(int argc, char **argv)
{
    options_check();
    options_log_open(argc, argv, cli_output());
    tool_filter(argc, argv, solve);
    options_log_close();
    summary();
    options_leave_device();
    return options.strict && total.missed;
}
