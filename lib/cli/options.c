#include "cli/options.h"

#include "io/reader.h"
#include "io/report_json.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define MOST 1e300

/* ---- the words that options take, from the tables of what there is ---- */

static struct cli_choice method_choice(int k)
{
    if (k == 0) return (struct cli_choice){ "auto", "no method of its own: as --global auto" };
    const struct method *m = methods[k - 1];
    return m ? (struct cli_choice){ m->name, m->help } : (struct cli_choice){ NULL, NULL };
}

static struct cli_choice solver_choice(int k)
{
    return (struct cli_choice){ solvers[k] ? solvers[k]->name : NULL, NULL };
}

static struct cli_choice criterion_choice(int k)
{
    return (struct cli_choice){ k < CRITERION_COUNT ? criterion_name[k] : NULL, NULL };
}

static struct cli_choice order_choice(int k)
{
    return (struct cli_choice){ k < ORDER_COUNT ? order_name[k] : NULL, NULL };
}

enum newton_steps { NEWTON_PLAIN, NEWTON_LINESEARCH, NEWTON_COUNT };
static const char *const newton_name[NEWTON_COUNT] = { "plain", "linesearch" };

static struct cli_choice newton_choice(int k)
{
    return (struct cli_choice){ k < NEWTON_COUNT ? newton_name[k] : NULL, NULL };
}

/* ---- the options ---- */

struct options options = { .global = -1,
                           .criterion = -1,
                           .eps = 1e-10,
                           .newton = NEWTON_LINESEARCH,
                           .newton_eps = 1e-13,
                           .newton_max = 100,
                           .theta = -1,
                           .max_sweeps = -1,
                           .order = -1,
                           .threads = 1 };

const struct cli_option options_solve[] = {
    { CLI_CHOICE, 'm', "method", &options.method, .choice = method_choice,
      .help = "the local method of Gauss-Seidel, which then solves [auto]" },
    { CLI_CHOICE, 0, "global", &options.global, .choice = solver_choice,
      .help = "the solver of all contacts together [nlgs with -m, else auto]" },
    { CLI_REAL, 0, "eps", &options.eps, "EPS", .max = MOST,
      .help = "stop when the criterion is at most this [1e-10]" },
    { CLI_CHOICE, 0, "criterion", &options.criterion, .choice = criterion_choice,
      .help = "what is compared with EPS [glob; natural for FCLIB]" },
    { CLI_INT, 0, "max-sweeps", &options.max_sweeps, "N", .max = 2e9,
      .help = "give up after N sweeps [5000 for nlgs, else 1000000]" },
    { CLI_ABOVE, 0, "max-seconds", &options.max_seconds, "S", .max = MOST,
      .help = "give up after S seconds, with the best so far" },
    { CLI_ABOVE, 0, "alpha", &options.alpha, "A", .max = MOST,
      .help = "rho = A m_red [1.75 (sbp, sal) or 1 (ebp, eal) over lambda_max]" },
    { CLI_CHOICE, 0, "newton", &options.newton, .choice = newton_choice,
      .help = "Newton's steps in ebp and eal; plain is the paper's [linesearch]" },
    { CLI_ABOVE, 0, "newton-eps", &options.newton_eps, "EPS", .max = 1,
      .help = "stop them when |Z| is at most EPS |(r, rho b)| [1e-13]" },
    { CLI_ABOVE, 0, "newton-abs", &options.newton_abs, "EPS", .max = MOST,
      .help = "stop them as the paper does, when |Z| is at most EPS, with r in N" },
    { CLI_INT, 0, "newton-max", &options.newton_max, "N", .min = 1, .max = 1e6,
      .help = "make at most N of them for a contact in a sweep [100]" },
    { CLI_BETWEEN, 0, "relax", &options.relax, "OMEGA", .max = 2,
      .help = "relaxation, between 0 and 2 [1 for nlgs, else the solver's]" },
    { CLI_CHOICE, 0, "order", &options.order, .choice = order_choice,
      .help = "of the sweep; natural is the paper's [natural for nlgs, else colour]" },
    { CLI_FLAG, 0, "every-sweep", &options.every_sweep,
      .help = "evaluate the criterion after every sweep [when it may be met]" },
    { 0 },
};

const struct cli_option options_run[] = {
    { CLI_INT, 'j', "threads", &options.threads, "N", .min = 1, .max = 1024, .silent = true,
      .help = "threads; they never change a result [1]" },
    { CLI_TEXT, 0, "log", &options.log, "FILE", .silent = true,
      .help = "write one JSON line for each solve, with its seconds" },
    { CLI_FLAG, 'e', "strict", &options.strict, .silent = true,
      .help = "exit with 1 when a solve has not converged" },
    { 0 },
};

const struct cli_option options_detect[] = {
    { CLI_REAL, 0, "gap", &options.gap, "G", .max = MOST,
      .help = "a contact is a pair with a predicted gap of at most G m [0]" },
    { CLI_REAL, 0, "theta", &options.theta, "T", .max = 1,
      .help = "predict the position q + (1 - T) dt qdot [the document's; 0.5]" },
    { 0 },
};

/* A method that is named stands for the paper's Gauss-Seidel with it. */
static const struct solver *global(void)
{
    int named = options.method ? 1 : 0;
    return solvers[options.global < 0 ? named : options.global];
}

struct step_opt options_step(double dt, bool foreign)
{
    const struct solver *solver = global();
    bool nlgs = solver == &solver_nlgs;
    enum criterion usual = foreign ? CRITERION_NATURAL : CRITERION_GLOB;
    const struct options *o = &options;
    return (struct step_opt){
        .gap = o->gap,
        .alpha = o->alpha,
        .order = o->order >= 0 ? (enum order)o->order
                 : nlgs        ? ORDER_NATURAL
                               : ORDER_COLOUR,
        .warm = o->warm,
        .solve = { .global = solver,
                   .method = o->method ? methods[o->method - 1] : &local_exact,
                   .local = { .plain = o->newton == NEWTON_PLAIN,
                              .newton_eps = o->newton_eps,
                              .newton_abs = o->newton_abs * dt, // forces there, impulses here
                              .newton_max = (int)o->newton_max },
                   .criterion = o->criterion < 0 ? usual : (enum criterion)o->criterion,
                   .eps = o->eps,
                   .max_sweeps = (int32_t)(o->max_sweeps >= 0 ? o->max_sweeps
                                           : nlgs             ? 5000
                                                              : 1000000),
                   .max_seconds = o->max_seconds,
                   .relax = o->relax > 0 ? o->relax : solver->relax,
                   .threads = (int)o->threads,
                   .every_sweep = o->every_sweep,
                   .history = o->history },
    };
}

const char *options_solver(const struct step_opt *o)
{
    const struct solve_opt *s = &o->solve;
    return s->global == &solver_nlgs ? s->method->name : s->global->name;
}

char *options_json(const struct step_opt *o)
{
    const struct solve_opt *n = &o->solve;
    json_t *j = json_object();
    json_object_set_new(j, "method", json_string(n->method->name));
    json_object_set_new(j, "global", json_string(n->global->name));
    json_object_set_new(j, "eps", json_real(n->eps));
    json_object_set_new(j, "criterion", json_string(criterion_name[n->criterion]));
    json_object_set_new(j, "max_sweeps", json_integer(n->max_sweeps));
    if (n->max_seconds > 0) json_object_set_new(j, "max_seconds", json_real(n->max_seconds));
    if (o->alpha > 0)
        json_object_set_new(j, "alpha", json_real(o->alpha));
    else
        json_object_set_new(j, "rho_lambda_max", json_real(n->method->rho));
    json_object_set_new(
        j, "newton", json_string(newton_name[n->local.plain ? NEWTON_PLAIN : NEWTON_LINESEARCH]));
    if (n->local.newton_abs > 0)
        json_object_set_new(j, "newton_abs", json_real(options.newton_abs));
    else
        json_object_set_new(j, "newton_eps", json_real(n->local.newton_eps));
    json_object_set_new(j, "newton_max", json_integer(n->local.newton_max));
    if (n->relax > 0) json_object_set_new(j, "relax", json_real(n->relax));
    json_object_set_new(j, "order", json_string(order_name[o->order]));
    json_object_set_new(j, "warm", json_boolean(o->warm));
    char *text = json_dumps(j, JSON_COMPACT);
    json_decref(j);
    return text;
}

void options_theta(struct packing *p, bool detected)
{
    if (options.theta < 0 || options.theta == p->theta) return;
    if (detected)
        die_usage("--theta: the contacts were detected with %g; give it to nsd-detect", p->theta);
    p->theta = options.theta;
}

static FILE *log_file;

void options_log_open(int files, char *const *file, const char *output)
{
    struct stat log, out;
    if (!options.log) return;
    if (!stat(options.log, &log) && S_ISREG(log.st_mode)) {
        int failed = output ? stat(output, &out) : fstat(STDOUT_FILENO, &out);
        if (!failed && out.st_dev == log.st_dev && out.st_ino == log.st_ino)
            die_usage("--log: %s is also the output", options.log);
        if (reader_reads(files, file, options.log))
            die_usage("--log: %s is also the input", options.log);
    }
    log_file = fopen(options.log, "w");
    if (!log_file) die(EX_IOERR, "%s: %s", options.log, strerror(errno));
}

void options_log(const struct report *rep)
{
    if (!log_file) return;
    json_t *j = json_report(rep);
    json_object_set_new(j, "seconds", json_number(rep->seconds));
    json_object_set_new(j, "elapsed", json_number(rep->elapsed));
    json_object_set_new(j, "detection", json_number(rep->detection));
    int failed =
        json_dumpf(j, log_file, JSON_COMPACT) || fputc('\n', log_file) == EOF || fflush(log_file);
    json_decref(j);
    if (failed) die(EX_IOERR, "%s: %s", options.log, strerror(errno));
}

void options_log_close(void)
{
    if (log_file && fclose(log_file)) die(EX_IOERR, "%s: %s", options.log, strerror(errno));
    log_file = NULL;
}

void options_summary(const char *where, const struct report *r)
{
    char trouble[120] = "", newton[40] = "";
    if (r->newton) snprintf(newton, sizeof newton, ", %lld Newton steps", (long long)r->newton);
    if (r->safeguarded || r->gave_up)
        snprintf(trouble, sizeof trouble, ", %lld local solves safeguarded, %lld given up",
                 (long long)r->safeguarded, (long long)r->gave_up);
    warn("%s: %lld contacts, %s: %d sweeps%s, %s %.3g%s, %.3g s%s", where,
         (long long)r->err.contacts, r->method, r->sweeps, newton,
         r->criterion == CRITERION_GLOB ? "eps_glob" : criterion_name[r->criterion],
         err_of(&r->err, r->criterion), trouble, r->seconds, r->converged ? "" : ": NOT CONVERGED");
}
