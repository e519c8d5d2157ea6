/* nsd-step: many steps. */
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
    { CLI_INT, 'n', "steps", &steps, "N", "steps to make [1]", 0, 1e15, 0 },
    { CLI_INT, 0, "every", &every, "K", "keep every K-th step, and the last [1]", 1, 1e15, 0 },
    { CLI_FLAG, 0, "contacts", &contacts, NULL, "keep the contacts of each frame", 0, 0, 0 },
    { CLI_FLAG, 'w', "warm", &options.warm, NULL, "start each solve from the last step's reactions",
      0, 0, 0 },
    { CLI_UNFLAG, 0, "cold", &options.warm, NULL, "start each solve from 0, as the paper [cold]", 0,
      0, 0 },
    { CLI_TEXT, 'o', "output", &output, "FILE", "where to [standard output]", 0, 0, true },
    { 0 },
};
static const struct cli_option *const tables[] = { own, options_solve, options_detect, options_run,
                                                   NULL };

const struct cli_tool tool = { "nsd-step", "[FILE ...]",
                               "Makes N time steps from the last frame that it reads. To a file: "
                               "one trajectory, each frame on\n"
                               "disk as soon as it is made; to a pipe: one document a frame.",
                               tables,
                               "  nsd-gen 500 | nsd-step -m ebp -n 1000 > out.h5\n"
                               "  nsd-step -n 1000 -o more.h5 out.h5\n" };

static struct {
    int64_t sweeps, failed, first_failed, safeguarded, gave_up;
    double seconds;
} total;

static void count(const struct report *r)
{
    total.sweeps += r->sweeps;
    total.safeguarded += r->safeguarded, total.gave_up += r->gave_up;
    total.seconds += r->seconds;
    if (r->converged) return;
    if (!total.failed++) total.first_failed = r->step;
}

static void summary(int64_t made)
{
    warn("%lld steps, %lld sweeps, %.3g s in the solver", (long long)made, (long long)total.sweeps,
         total.seconds);
    if (total.safeguarded || total.gave_up)
        warn("%lld local solves safeguarded, %lld given up", (long long)total.safeguarded,
             (long long)total.gave_up);
    if (total.failed)
        warn("%lld steps NOT CONVERGED, the first is step %lld", (long long)total.failed,
             (long long)total.first_failed);
}

/* One step of f; false when its solve has diverged. */
static bool advance(struct frame *f, struct neighbours *near, const struct step_opt *o)
{
    struct why why = { 0 };
    struct report *r = &f->report;
    if (step_advance(&f->packing, &f->contacts, near, o, r, &why)) die_why(&why);
    f->reported = f->moved = true;
    count(r);
    options_log(r);
    progress("step %lld: %lld contacts, %d sweeps, eps_glob %.2g", (long long)r->step,
             (long long)r->err.contacts, r->sweeps, r->err.paper.eps_glob);
    return isfinite(r->err.paper.eps_glob);
}

/* The packing alone, of the last step that could be made, unless it has been kept. */
static void keep_last(struct frame *f, struct writer *out, int64_t k)
{
    struct why why = { 0 };
    if (k && k % every == 0) return;
    f->reported = f->detected = false;
    if (writer_frame(out, f, &why)) die_why(&why);
}

/* N steps, those asked for into the sink; returns how many were made. */
static int64_t run(struct frame *f, struct writer *out)
{
    struct why why = { 0 };
    struct step_opt o = options_step(f->packing.dt, false);
    struct neighbours near = { 0 };
    if (steps) {
        report_free(&f->report);
        snprintf(f->report.method, sizeof f->report.method, "%s", options_solver(&o));
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
    return made < steps || (options.strict && total.failed);
}
