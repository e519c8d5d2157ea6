/* nsd-step: makes many steps: detects, solves and moves in a loop. */
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/tool_filter.h"
#include "io/reader.h"
#include "io/writer.h"

#include <math.h>
#include <stdio.h>

static int64_t steps = 1, every = 1;
static bool contacts;
static const char *output;

static const struct cli_option own[] = {
    { CLI_INT, 'n', "steps", &steps, "N", "steps to make [1]", .max = 1e15 },
    { CLI_INT, 0, "every", &every, "K", "keep every K-th step, and the last [1]", .min = 1,
      .max = 1e15 },
    { CLI_FLAG, 0, "contacts", &contacts, .help = "keep each frame's contacts too" },
    { CLI_FLAG, 'w', "warm", &options.warm,
      .help = "start each solve from the last step's reactions" },
    { CLI_UNFLAG, 0, "cold", &options.warm, .help = "start each solve from 0, as the paper",
      .usual = options_usual },
    { CLI_TEXT, 'o', "output", &output, "FILE", "write to FILE [standard output]", .silent = true },
    { 0 },
};
static const struct cli_option *const tables[] = { own, options_solve, options_detect, options_run,
                                                   NULL };

const struct cli_tool tool = { "nsd-step", "[FILE ...]",
                               "Makes N time steps from the last frame that it reads. To a file: "
                               "one trajectory, each frame on\n"
                               "disk as soon as it is made; to a pipe: one document a frame.",
                               tables,
                               "  nsd-gen 500 | nsd-step -n 1000 > out.h5\n"
                               "  nsd-step -n 100 --eps 1e-8 -o more.h5 out.h5\n" };

static struct {
    int64_t sweeps, safeguarded, gave_up;
    int64_t missed, first_missed; /* steps that have not converged, and the first's number */
    double worst;                 /* the largest error of those */
    enum criterion criterion;     /* which error that is */
    double eps;                   /* and what was asked of it */
    int64_t growing;              /* of those the ones whose reactions grow and only seem good */
    double approach;              /* m/s: of bodies in these steps, the largest */
    int64_t fell_back;            /* steps that were solved otherwise than asked */
    double seconds;
} total;

static void count(const struct report *r)
{
    char where[40];
    snprintf(where, sizeof where, "step %lld", (long long)r->step);
    if (r->fallback && !total.fell_back++) options_warn(where, r); // of all steps, mostly
    total.sweeps += r->sweeps;
    total.safeguarded += r->safeguarded, total.gave_up += r->gave_up;
    total.seconds += r->seconds;
    if (r->converged) return;
    if (!total.missed++) total.first_missed = r->step;
    double error = err_of(&r->err, r->criterion);
    if (!(error <= total.worst)) total.worst = error; // also where it is not a number
    total.criterion = r->criterion, total.eps = r->eps;
    if (!(error <= r->eps)) return;
    total.growing++, total.approach = fmax(total.approach, r->err.max_penetration_true);
}

static void summary(int64_t made)
{
    warn("%lld steps, %lld sweeps, %.3g s in the solver", (long long)made, (long long)total.sweeps,
         total.seconds);
    if (total.safeguarded || total.gave_up)
        warn("%lld local solves safeguarded, %lld given up", (long long)total.safeguarded,
             (long long)total.gave_up);
    if (total.fell_back)
        warn("%lld steps were solved by sweeps alone, not as asked", (long long)total.fell_back);
    if (total.missed)
        warn("%lld steps NOT CONVERGED, the first is step %lld; the largest %s is %.3g, not %g",
             (long long)total.missed, (long long)total.first_missed, options_error(total.criterion),
             total.worst, total.eps);
    if (total.growing)
        warn("in %lld of them reactions grow without end, and bodies still approach at up to %.3g "
             "m/s",
             (long long)total.growing, total.approach);
}

/* Makes one step of f; false where its solve has diverged, and f has not moved. */
static bool advance(struct frame *f, struct neighbours *near, const struct step_opt *o)
{
    struct why why = { 0 };
    struct report *r = &f->report;
    if (step_advance(&f->packing, &f->contacts, near, o, r, &why)) die_why(&why);
    f->reported = f->moved = true;
    count(r);
    options_log(r);
    double error = err_of(&r->err, r->criterion);
    progress("step %lld: %lld contacts, %d sweeps, %s %.2g", (long long)r->step,
             (long long)r->err.contacts, r->sweeps, options_error(r->criterion), error);
    return isfinite(r->err.paper.eps_glob);
}

/* Writes the last step that could be made, the k-th, without its contacts, unless it is written. */
static void keep_last(struct frame *f, struct writer *out, int64_t k)
{
    struct why why = { 0 };
    if (k && k % every == 0) return;
    f->reported = f->detected = false;
    if (writer_frame(out, f, &why)) die_why(&why);
}

/* Makes the steps, writes every K-th and the last, and returns how many were made. */
static int64_t run(struct frame *f, struct writer *out)
{
    struct why why = { 0 };
    struct step_opt o = options_step(f->packing.dt, false);
    struct neighbours near = { 0 };
    if (steps) {
        report_free(&f->report);
        f->report.options = options_json(&o);
        f->detected = contacts;
        f->stale = true;
    }
    for (int64_t k = 1; k <= steps; k++) {
        if (!advance(f, &near, &o)) {
            warn("step %lld: the solve diverged, the run ends before it",
                 (long long)f->report.step);
            keep_last(f, out, k - 1);
            neighbours_free(&near);
            return k - 1;
        }
        if ((k % every == 0 || k == steps) && writer_frame(out, f, &why)) die_why(&why);
    }
    if (!steps && writer_frame(out, f, &why)) die_why(&why);
    neighbours_free(&near);
    return steps;
}

int tool_main(int argc, char **argv)
{
    struct reader *in;
    struct writer *out;
    struct frame f = { 0 };
    struct why why = { 0 };
    bool more;
    options_check();
    if (reader_open(&in, argc, argv, &why)) die_why(&why);
    reader_copies(in);
    if (output && reader_reads(argc, argv, output)) die_usage("%s: is also the input", output);
    if (reader_last(in, &f, &more, &why)) die_why(&why);
    if (!more) die(EX_DATAERR, "%s: no frame to start from", reader_where(in));
    tool_wants_packing(&f, reader_where(in));
    options_theta(&f.packing, false);
    if (writer_open(&out, output, WRITER_TRAJECTORY, &why)) die_why(&why);
    options_log_open(argc, argv, output);
    if (frame_note(&f, cli_history(), &why)) die_why(&why);
    int64_t made = run(&f, out);
    if (writer_close(out, &why)) die_why(&why);
    options_log_close();
    summary(made);
    frame_free(&f);
    reader_close(in);
    return made < steps || (options.strict && total.missed);
}
