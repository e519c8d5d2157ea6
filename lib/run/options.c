#include "run/options.h"

#include "base/team.h"
#include "file/reader.h"
#include "file/report_json.h"
#include "scene/stiffness.h"
#include "solve/device.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

const struct cli_option options_run[] = {
    { CLI_INT, 'j', "threads", &options.threads, "N", .min = 1, .max = 1024, .silent = true,
      .help = "use N threads; results do not depend on N [1]" },
    { CLI_TEXT, 0, "device", &options.device, "DEVICE", .silent = true,
      .help = "sweep on opencl or opencl:N; list prints the devices [the CPU]" },
    { CLI_TEXT, 0, "log", &options.log, "FILE", .silent = true,
      .help = "write one JSON line per solve, with its seconds" },
    { CLI_FLAG, 'e', "strict", &options.strict, .silent = true,
      .help = "exit with 1 if a solve or a step fails; nsd-step ends with it" },
    { 0 },
};

static const char *stiffness; /* --stiffness */

const struct cli_option options_contacts[] = {
    { CLI_TEXT, 0, "stiffness", &stiffness, "K|rigid|auto[:ALPHA]",
      .help = "set the stiffness of contacts, N/m [document, else rigid]" },
    { 0 },
};

bool options_end_on_failure(void)
{
    return options.strict && !options.keep_going;
}

static struct device *device; /* --device; NULL: none */

/* The members that were given on the command line */
static void mark_given(void)
{
    for (int t = 0; t < 2; t++)
        for (const struct cli_option *o = t ? options_detect : options_solve; o->kind; o++)
            if (cli_given(o->to)) options_give(&options, o->to);
    for (const void *const *other = options_others; *other; other++)
        if (cli_given(*other)) options_give(&options, *other);
}

void options_check(void)
{
    struct failure failure = { 0 };
    team_set_size((int)options.threads);
    mark_given();
    if (options_names(&options, &failure)) die_usage("%s", failure.text);
    if (!options.device) return;
    if (!strcmp(options.device, "list")) {
        begin_stdout();
        if (device_list(stdout, &failure)) die_why(&failure);
        finish_stdout();
        exit(0);
    }
    if (device_named(options.device, &failure)) die_usage("%s", failure.text);
}

/* When there is input: the processes that read it have been started, and have nothing of a driver. */
static void options_open_device(void)
{
    struct failure failure = { 0 };
    if (options.device && !device && !(device = device_open(options.device, &failure)))
        die_why(&failure);
}

static struct {
    int64_t solves, on_cpu, kernels;
    double to, from; /* bytes */
    const char *reason;
} there;

void options_warn_cpu(const char *where, const struct report *r)
{
    there.solves += r->kernels > 0, there.on_cpu += r->on_cpu != NULL;
    there.to += r->bus_to, there.from += r->bus_from, there.kernels += r->kernels;
    if (r->on_cpu && r->on_cpu != there.reason)
        warn("%s: on the CPU, not on %s: %s", where, options.device, r->on_cpu);
    if (r->on_cpu) there.reason = r->on_cpu;
}

void options_leave_device(void)
{
    double n = fmax((double)there.solves, 1);
    if (!device) return;
    warn("%s: %s: %lld of %lld solves; one: %.0f kernels, %.3g MB to it, %.3g MB from it",
         options.device, device->name, (long long)there.solves,
         (long long)(there.solves + there.on_cpu), (double)there.kernels / n, 1e-6 * there.to / n,
         1e-6 * there.from / n);
    device_close(device);
    device = NULL;
}

struct step_opt options_step(double dt, bool foreign)
{
    mark_given();
    struct step_opt o = options_step_of(&options, dt, foreign);
    options_open_device();
    o.solve.device = device;
    return o;
}

char *options_json(const struct step_opt *step)
{
    return options_json_of(&options, step);
}

void options_theta(struct packing *p, bool detected)
{
    if (!cli_given(&options.theta) || options.theta == p->theta) return;
    if (detected)
        die_usage("--theta: the contacts were detected with %g; give it to nsd-detect", p->theta);
    p->theta = options.theta;
}

void options_overlap(struct packing *p, bool detected)
{
    enum overlap was = p->overlap;
    mark_given();
    enum overlap now = options_overlap_of(&options, p, detected);
    bool others = overlap_sees_gaps(was) != overlap_sees_gaps(now) ||
                  overlap_meets(was) != overlap_meets(now);
    if (detected && others)
        die_usage(
            "--overlap-rule %s: the contacts were detected with %s: nsd-detect --overlap-rule %s",
            overlap_name[now], overlap_name[was ? was : OVERLAP_KEEP], overlap_name[now]);
    p->overlap = now;
}

bool options_adds_springs(void)
{
    return stiffness && strcmp(stiffness, "rigid") != 0;
}

void options_stiffness(struct frame *f, const char *fixed)
{
    struct packing *p = &f->packing;
    struct failure failure = { 0 };
    struct stiffness to;
    if (!stiffness) return;
    if (options.protocol && strcmp(stiffness, "rigid"))
        die_usage("--stiffness: contacts of the paper are rigid, and --protocol paper is given");
    if (stiffness_read(&to, stiffness, &failure)) die_usage("--stiffness: %s", failure.text);
    if (fixed && !stiffness_is(p, to))
        die_usage("--stiffness: %s has another one, and a trajectory has one", fixed);
    if (!fixed && stiffness_set(p, to, &failure))
        die(failure.status, "--stiffness: %s", failure.text);
    if (p->law && !f->contacts.law &&
        contacts_alloc_laws(&f->contacts)) // those of the last step were rigid
        die(EX_SOFTWARE, "no memory for the laws");
}

static FILE *log_file;

void options_log_open(int files, char *const *file, const char *output)
{
    struct stat log, out;
    if (!options.log) return;
    if (!strcmp(options.log, "-"))
        die_usage("--log: '-' is no file: standard output has the documents, and a file of this "
                  "name is ./-");
    if (!stat(options.log, &log) && !S_ISCHR(log.st_mode)) {
        int failed = output ? stat(output, &out) : fstat(STDOUT_FILENO, &out);
        if (!failed && out.st_dev == log.st_dev && out.st_ino == log.st_ino)
            die_usage("--log: %s is also the output", options.log);
        if (reader_reads(files, file, options.log))
            die_usage("--log: %s is also the input", options.log);
    }
}

/* With the first line, when input has been read: one that cannot be costs nobody his log. */
static void log_begin(void)
{
    if (options.log && !log_file && !(log_file = fopen(options.log, "w")))
        die(EX_IOERR, "%s: %s", options.log, strerror(errno));
}

void options_log(const struct report *rep, const struct account *account, const struct names *names)
{
    log_begin();
    if (!log_file) return;
    json_t *j = json_report(rep);
    json_object_set_new(j, "seconds", json_number(rep->seconds));
    json_object_set_new(j, "elapsed", json_number(rep->elapsed));
    json_object_set_new(j, "detection", json_number(rep->detection));
    json_object_set_new(j, "work", json_number(rep->work));
    if (device) {
        json_t *there_too = json_object();
        json_object_set_new(there_too, "name", json_string(device->name));
        json_object_set_new(there_too, "bytes_to", json_number(rep->bus_to));
        json_object_set_new(there_too, "bytes_from", json_number(rep->bus_from));
        json_object_set_new(there_too, "kernels", json_integer(rep->kernels));
        if (rep->on_cpu) json_object_set_new(there_too, "on_cpu", json_string(rep->on_cpu));
        json_object_set_new(j, "device", there_too);
    }
    if (account) json_object_set_new(j, "account", json_account(account, names));
    int failed = json_write(log_file, j) || fputc('\n', log_file) == EOF || fflush(log_file);
    json_decref(j);
    if (failed) die(EX_IOERR, "%s: %s", options.log, strerror(errno));
}

void options_log_close(void)
{
    log_begin();
    if (log_file && fclose(log_file)) die(EX_IOERR, "%s: %s", options.log, strerror(errno));
    log_file = NULL;
}

const char *options_error(enum criterion criterion)
{
    return criterion == CRITERION_GLOB ? "eps_glob" : criterion_name[criterion];
}

void options_warn(const char *where, const struct report *r)
{
    if (r->given_up) warn("%s: given up: %s", where, r->given_up);
}

void options_summary(const char *where, const struct report *r)
{
    char trouble[120] = "", newton[40] = "", missed[60] = "", growing[60] = "";
    double error = err_of(&r->err, r->criterion);
    options_warn(where, r);
    if (r->newton) snprintf(newton, sizeof newton, ", %lld Newton steps", (long long)r->newton);
    if (r->safeguarded || r->gave_up)
        snprintf(trouble, sizeof trouble, ", %lld local solves safeguarded, %lld given up",
                 (long long)r->safeguarded, (long long)r->gave_up);
    if (!r->converged) snprintf(missed, sizeof missed, ": NOT CONVERGED to %g", r->eps);
    if (err_no_solution(r))
        snprintf(growing, sizeof growing, ", bodies still approach at %.3g m/s",
                 r->err.max_penetration_true);
    warn("%s: %lld contacts, %s: %d sweeps%s, %s %.3g%s%s, %.3g s%s", where,
         (long long)r->err.contacts, r->method, r->sweeps, newton, options_error(r->criterion),
         error, growing, trouble, r->seconds, missed);
}
