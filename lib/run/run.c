/* run/run.c: a run: made, set, stepped and closed. */
#include "run/run.h"

#include "base/nearest.h"
#include "base/renamed.h"
#include "base/team.h"
#include "base/text.h"
#include "convert/scene_file.h"
#include "run/document.h"
#include "scene/scene_build.h"
#include "scene/stiffness.h"
#include "solve/err.h"

#include <errno.h>
#include <float.h>
#include <gsl/gsl_errno.h>
#include <jansson.h>
#include <libgen.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- reasons ---- */

static _Thread_local struct failure of_thread;

struct failure *run_why_of_thread(void)
{
    of_thread = (struct failure){ 0 };
    return &of_thread;
}

struct failure *run_why(struct nsd_run *r)
{
    if (!r) {
        failure_set(run_why_of_thread(), NSD_USAGE,
                    "there is no run: it was closed, or never made");
        return NULL;
    }
    r->failure = (struct failure){ 0 };
    if (!process_owns(r->maker)) {
        failure_set(&r->failure, NSD_USAGE,
                    "the run belongs to process %lld, of which this one is a copy by fork(): make "
                    "another run here",
                    (long long)r->maker);
        return NULL;
    }
    team_set_size((int)r->options.threads);
    return &r->failure;
}

const char *nsd_error(const struct nsd_run *r)
{
    return r ? r->failure.text : of_thread.text;
}

const char *nsd_version(void)
{
    return NSD_VERSION;
}

/* ---- made ---- */

static struct nsd_run *new_run(struct failure *failure)
{
    struct nsd_run *r = calloc(1, sizeof *r);
    const pid_t maker = process_begin();
    if (!r) return failure_set(failure, NSD_SOFTWARE, "no memory for a run"), NULL;
    r->maker = maker;
    r->f.packed = true;
    r->options.threads = 1;
    r->asked = (struct asked)ASKED_DEFAULT;
    return r;
}

/* The run with its packing: what it needs before the first step */
static int run_begin(struct nsd_run *r, struct failure *failure)
{
    struct packing *p = &r->f.packing;
    p->events.n = 0; // they belong to the frame that was read
    if (control_take(&r->driver.acts, p, failure)) return failure->status;
    external_force_forget(&p->outside);
    if (flow_read(&r->driver.flow, p, failure))
        return r->driver.flow = (struct flow){ 0 }, failure->status;
    for (int64_t i = 0; i < p->n; i++)
        if (p->id[i] >= r->next_id) r->next_id = p->id[i] < INT32_MAX ? p->id[i] + 1 : INT32_MAX;
    if (p->first_id > r->next_id) r->next_id = p->first_id;
    return packing_check(p, failure);
}

/* What all constructors begin with: what it is to put its reason into; NULL: there is no place for the run, which is said. */
static struct failure *place_for(struct nsd_run **run)
{
    struct failure *failure = run_why_of_thread();
    if (run) return *run = NULL, failure;
    failure_set(failure, NSD_USAGE, "there is no place for the run");
    return NULL;
}

/* What all constructors end with */
static int run_done(struct nsd_run **out, struct nsd_run *r, struct failure *failure)
{
    if (r && !failure->status) run_begin(r, failure);
    if (failure->status) nsd_close(&r);
    *out = r;
    return failure->status;
}

static int build(struct nsd_run *r, const char *text, size_t n, const char *name,
                 const char *folder, struct failure *failure)
{
    struct scene scene;
    process_lock(); // a scene may take bodies from documents
    if (!scene_file_parse(&scene, text, n, name, folder, failure)) {
        if (scene_build(&r->f.packing, &scene, folder, failure))
            r->f.packing = (struct packing){ 0 };
        scene_free(&scene);
    }
    process_unlock();
    return failure->status;
}

int nsd_from_scene(struct nsd_run **run, const char *text, const char *folder)
{
    struct failure *failure = place_for(run);
    if (!failure) return NSD_USAGE;
    if (!text) return failure_set(failure, NSD_USAGE, "there is no text of a scene");
    struct nsd_run *r = new_run(failure);
    if (r) build(r, text, strlen(text), NULL, folder, failure);
    return run_done(run, r, failure); // NOLINT(clang-analyzer-unix.Malloc): nsd_close()
}

int nsd_from_scene_file(struct nsd_run **run, const char *path)
{
    struct failure *failure = place_for(run);
    size_t n = 0;
    if (!failure) return NSD_USAGE;
    if (!path) return failure_set(failure, NSD_USAGE, "there is no path of a scene");
    FILE *f = fopen(path, "re");
    if (!f) return failure_set(failure, NSD_NO_INPUT, "%.200s: %s", path, strerror(errno));
    char *text = scene_file_slurp(f, path, &n, failure), *copy = strdup(path);
    fclose(f);
    struct nsd_run *r = NULL;
    if (text && !copy) failure_set(failure, NSD_SOFTWARE, "%.200s: no memory", path);
    if (text && copy && (r = new_run(failure))) build(r, text, n, path, dirname(copy), failure);
    free(text), free(copy);
    return run_done(run, r, failure);
}

int nsd_from_document(struct nsd_run **run, const char *path)
{
    struct failure *failure = place_for(run);
    if (!failure) return NSD_USAGE;
    if (!path || !strcmp(path, "-"))
        return failure_set(failure, NSD_USAGE,
                           "a document has a path; standard input is the program's");
    struct nsd_run *r = new_run(failure);
    process_lock();
    if (r) document_read_file(&r->f, path, failure);
    process_unlock();
    return run_done(run, r, failure);
}

int nsd_from_memory(struct nsd_run **run, const void *document, size_t size)
{
    struct failure *failure = place_for(run);
    if (!failure) return NSD_USAGE;
    if (!document) return failure_set(failure, NSD_USAGE, "there is no document");
    struct nsd_run *r = new_run(failure);
    process_lock();
    if (r) document_read(&r->f, document, size, failure);
    process_unlock();
    return run_done(run, r, failure);
}

int nsd_from_arrays(struct nsd_run **run, const char *scene, const char *folder,
                    const struct nsd_bodies *bodies)
{
    struct failure *failure = place_for(run);
    struct nsd_run *r = NULL;
    if (!failure) return NSD_USAGE;
    if (nsd_from_scene(&r, scene, folder) || !r) return failure->status;
    if (r->f.packing.n)
        failure_set(failure, NSD_DATA,
                    "the scene has bodies of its own: arrays are for one without");
    else
        run_add(r, bodies, NULL, failure);
    r->other_bodies = false;
    if (failure->status) nsd_close(&r);
    *run = r;
    return failure->status;
}

void nsd_close(struct nsd_run **run)
{
    struct nsd_run *r = run ? *run : NULL;
    if (!r) return;
    *run = NULL;
    if (!process_owns(r->maker))
        return; // another thread may have been changing it as this process began
    nsd_finish(r);
    if (r->solved) r->f.report.options = NULL;
    free(r->option_json);
    process_lock();
    frame_free(&r->f);
    process_unlock();
    contacts_free(&r->spare);
    driver_free(&r->driver);
    rollback_free(&r->undo), external_force_free(&r->last);
    frame_memory_free(&r->first), frame_memory_free(&r->before);
    for (int k = 0; k < MADE_MOST; k++) free(r->made[k]);
    free(r->text);
    free(r);
}

/* ---- options ---- */

static const struct cli_option run_options[] = {
    { CLI_INT, .name = "threads", .to = &options.threads, .min = 1, .max = 1024 },
    { CLI_FLAG, .name = "warm", .to = &options.warm },
    { CLI_REAL, .name = "small-steps", .to = &options.small, .min = 0, .max = 0.1 },
    { CLI_REAL, .name = "missing-impulse", .to = &options.bound, .min = 0, .max = 1 },
    { 0 },
};
static const struct cli_option *const run_tables[] = { run_options, options_solve, options_detect,
                                                       NULL };

static const struct cli_option *option_named(const char *name)
{
    for (const struct cli_option *const *t = run_tables; *t; t++)
        for (const struct cli_option *o = *t; o->kind; o++)
            if (!strcmp(o->name, name)) return o;
    return NULL;
}

static int no_such_option(const char *name, struct failure *failure)
{
    static const char *const others[] = {
        "dt", "stiffness", "contacts", "forces", "compare", NULL
    };
    struct nearest near = { 0 };
    const size_t n = strlen(name);
    const struct renamed *renamed = renamed_find("nsd_set", name, n);
    const char *cure = gone_find("nsd_set", name, n);
    if (cure)
        return failure_set(failure, NSD_USAGE, "%.60s is no longer available: %s", name, cure);
    if (renamed)
        return failure_set(failure, NSD_USAGE, "%s: now called %s", renamed->was, renamed->is);
    for (int k = 0; others[k]; k++) nearest_look(&near, name, n, others[k]);
    for (int k = 0; asked_name(k); k++) nearest_look(&near, name, n, asked_name(k));
    for (const struct cli_option *const *t = run_tables; *t; t++)
        for (const struct cli_option *o = *t; o->kind; o++) nearest_look(&near, name, n, o->name);
    return failure_set(failure, NSD_USAGE, "%.60s: no such option%s%s%s", name,
                       near.name ? "; did you mean " : "", near.name ? near.name : "",
                       near.name ? "?" : "");
}

/* "1e-4" */
static int run_set_dt(struct nsd_run *r, const char *text, struct failure *failure)
{
    struct packing *p = &r->f.packing;
    struct failure why = { 0 };
    double x;
    if (driver_read_dt(text, &x, &why))
        return failure_set(failure, NSD_USAGE, "dt: %.300s", why.text);
    if (r->out)
        return failure_set(failure, NSD_USAGE, "dt: a trajectory has one: nsd_finish() ends it");
    if (driver_set_dt(p, x, failure)) return failure->status;
    options_give(&r->options, &options.dt);
    r->chosen = false;
    return 0;
}

static int run_set_flag(bool *to, const char *name, const char *value, struct failure *failure)
{
    const struct cli_option o = { CLI_FLAG, .name = name };
    return option_set(&o, to, value, failure);
}

static int run_set_stiffness(struct nsd_run *r, const char *text, struct failure *failure)
{
    struct stiffness to;
    struct failure why = { 0 };
    struct packing *p = &r->f.packing;
    if (stiffness_read(&to, text, &why))
        return failure_set(failure, why.status, "stiffness: %s", why.text);
    if (r->out && !stiffness_is(p, to))
        return failure_set(failure, NSD_USAGE,
                           "stiffness: a trajectory has one: nsd_finish() ends it");
    r->chosen = false;
    if (stiffness_set(p, to, failure)) return failure->status;
    if (p->law && !r->f.contacts.law && contacts_alloc_laws(&r->f.contacts))
        return failure_set(failure, NSD_SOFTWARE, "no memory for the laws");
    return 0;
}

static int set_option(struct nsd_run *r, const char *name, const char *value,
                      struct failure *failure)
{
    if (!strcmp(name, "dt")) return run_set_dt(r, value, failure);
    if (!strcmp(name, "stiffness")) return run_set_stiffness(r, value, failure);
    if (!strcmp(name, "contacts")) return run_set_flag(&r->contacts, name, value, failure);
    if (!strcmp(name, "forces")) return run_set_flag(&r->forces, name, value, failure);
    if (!strcmp(name, "compare")) return run_set_flag(&r->compares, name, value, failure);
    if (asked_has(name)) return asked_set(&r->asked, name, value, failure);
    const struct cli_option *o = option_named(name);
    if (!o) return no_such_option(name, failure);
    struct options asked = r->options;
    if (option_set(o, options_member(&asked, o->to), value, failure)) return failure->status;
    options_give(&asked, o->to);
    if (!strcmp(name, "theta") && r->out && asked.theta != r->f.packing.theta)
        return failure_set(failure, NSD_USAGE, "theta: a trajectory has one: nsd_finish() ends it");
    r->options = asked;
    r->chosen = false;
    return 0;
}

int nsd_set(struct nsd_run *r, const char *option, const char *value)
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (!option || !value)
        return failure_set(failure, NSD_USAGE, "an option has a name and a value");
    if (set_option(r, option, value, failure) && !strncmp(failure->text, "--", 2))
        memmove(failure->text, failure->text + 2, strlen(failure->text + 2) + 1);
    return failure->status;
}

int run_choose(struct nsd_run *r, struct failure *failure)
{
    struct packing *p = &r->f.packing;
    if (r->chosen) return 0;
    if (options_names(&r->options, failure)) return failure->status;
    struct step_opt o = options_step_of(&r->options, p->dt, false);
    o.small = options_small_of(&r->options, p);
    char *text = options_json_of(&r->options, &o);
    if (!text) return failure_set(failure, NSD_SOFTWARE, "no memory for the options");
    if (options_has(&r->options, &options.theta)) p->theta = r->options.theta;
    p->overlap = options_overlap_of(&r->options, p, false);
    free(r->option_json);
    r->option_json = text, r->driver.o = o;
    if (r->solved) r->f.report.options = text;
    r->chosen = r->f.stale = true;
    return 0;
}

/* ---- steps ---- */

static void swap_forces(struct external_force *a, struct external_force *b)
{
    const struct external_force was = *a;
    a->force = b->force, a->torque = b->torque, a->push = b->push, a->most = b->most;
    b->force = was.force, b->torque = was.torque, b->push = was.push, b->most = was.most;
}

/* Its contacts are r->spare, its report *rep. */
static int run_advance(struct nsd_run *r, struct report *rep, struct failure *failure)
{
    struct packing *p = &r->f.packing;
    struct driver *d = &r->driver;
    d->o.compare = r->compares;
    if (driver_begin(d, p, NULL, failure) ||
        step_advance(p, &r->spare, &d->memory, &d->o, rep, failure))
        return failure->status;
    if (report_made(rep)) return 0;
    char text[160];
    report_says_end(rep, text, sizeof text);
    return failure_set(failure, NSD_DIVERGED, "%s: the bodies have not moved", text);
}

/* Puts the step in front of the reason, unless it is there. */
static void name_step(int64_t step, struct failure *failure)
{
    char text[sizeof failure->text];
    if (!strncmp(failure->text, "step ", 5)) return;
    memcpy(text, failure->text, sizeof text);
    snprintf(failure->text, sizeof failure->text, "step %lld: %.360s", (long long)step, text);
}

static int step_once(struct nsd_run *r, struct failure *failure)
{
    struct packing *p = &r->f.packing;
    struct report rep = { 0 };
    const struct step_opt o = r->driver.o;
    if (r->solved) rep = r->f.report;
    rep.options = r->option_json;
    if (rollback_take(&r->undo, p, &r->driver.acts, failure)) return failure->status;
    bool whole = r->undo.whole;
    if (!whole) swap_forces(&p->outside, &r->last);
    if (run_advance(r, &rep, failure)) {
        name_step(r->undo.was.step + 1, failure);
        if (!whole) swap_forces(&p->outside, &r->last);
        rollback_back(&r->undo, p, &r->driver.acts);
        driver_forget(&r->driver);
        r->driver.o = o;
        return failure->status;
    }
    struct contacts had = r->f.contacts;
    r->f.contacts = r->spare, r->spare = had;
    if (!r->solved) report_free(&r->f.report);
    r->f.report = rep, r->solved = true;
    r->f.detected = r->f.reported = r->f.moved = true;
    account_add(&r->f.account, &rep), account_add(&r->account, &rep);
    control_end(&r->driver.acts, p->walls);
    return 0;
}

int nsd_step(struct nsd_run *r, int64_t n)
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (n < 0) return failure_set(failure, NSD_USAGE, "%lld steps cannot be made", (long long)n);
    if (n && run_choose(r, failure)) return failure->status;
    for (int64_t k = 0; k < n && !failure->status; k++) step_once(r, failure);
    return failure->status;
}

int nsd_until(struct nsd_run *r, double t)
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    const struct packing *p = &r->f.packing;
    if (!isfinite(t)) return failure_set(failure, NSD_USAGE, "a time of %g s is never reached", t);
    if (!((t - p->t) / p->dt < 1e15))
        return failure_set(failure, NSD_USAGE, "until %g s: more than 1e15 steps of %g s", t,
                           p->dt);
    if (run_choose(r, failure)) return failure->status;
    while (!failure->status && p->t < t - driver_slack(p, t)) step_once(r, failure);
    return failure->status;
}

int nsd_resizes(const struct nsd_run *r)
{
    return r && packing_varies(&r->f.packing);
}

void run_replace(struct nsd_run *r, struct packing *p, struct contacts *s)
{
    packing_free(&r->f.packing), contacts_free(&r->f.contacts);
    r->f.packing = *p, r->f.contacts = *s;
    driver_forget(&r->driver);
    external_force_free(&r->last);
    r->other_bodies = true;
}
