/* nsd-web: a trajectory as one page that plays it in a browser. */
#include "draw/page.h"
#include "file/reader.h"
#include "measure/measures.h"
#include "run/cli.h"
#include "run/tool_filter.h"
#include "state/rotation.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct cli_every every = { 1, 0 };
static const char *title, *stat, *steps;

static const struct cli_option own[] = {
    { CLI_TEXT, 's', "frames", &steps, "A:B:K",
      .help = "process the frames of steps A to B, every K-th [all]" },
    { CLI_EVERY, 0, "every", &every, "K|T", .max = 1e15,
      .help = "show every K-th frame, or one per time T: 0.1s, 5ms [1]" },
    { CLI_TEXT, 0, "title", &title, "TEXT", .help = "set the title [that of the scene, or nsd]" },
    { CLI_TEXT, 0, "stat", &stat, "FILE", .help = "also plot the JSON lines of nsd-stat in FILE" },
    { 0 },
};
static const struct cli_option *const tables[] = { own, NULL };

const struct cli_tool tool = {
    "nsd-web", "[FILE ...]",
    "Makes one HTML page that plays a trajectory without a network. The view can be rotated,\n"
    "grains picked and forces shown. It needs a browser with WebGL 2.",
    tables,
    "  nsd-web out.h5 > out.html\n"
    "  nsd-web --every 10 --title 'A heap' -o heap.html out.h5\n"
};

/* The scene's title, if there is one; else "nsd" */
static char *title_of(const struct packing *p)
{
    json_t *scene = p->scene ? json_loads(p->scene, 0, NULL) : NULL;
    const char *text = json_string_value(json_object_get(scene, "title"));
    char *copy = strdup(text ? text : "nsd");
    json_decref(scene);
    if (!copy) die(EX_SOFTWARE, "no memory");
    return copy;
}

/* ---- curves ---- */

static void add(struct page *p, const char *name, const char *unit, double value)
{
    struct failure failure = { 0 };
    if (page_value(p, name, unit, value, &failure)) die_why(&failure);
}

static void add_energy(struct page *page, const struct packing *p)
{
    const struct energy e = energy_of(p);
    add(page, "kinetic energy", "J", e.kinetic);
    add(page, "potential energy", "J", e.potential);
    add(page, "largest speed", "m/s", e.fastest);
}

static void add_contacts(struct page *page, const struct frame *f)
{
    double push = 0, most = 0;
    for (int64_t i = 0; f->contacts.found && i < f->contacts.n; i++) {
        double r = f->contacts.found[i].r[0];
        push += r > 0, most = fmax(most, r / f->packing.dt);
    }
    if (f->detected) add(page, "contacts", "", (double)f->contacts.n);
    if (f->contacts.found) {
        add(page, "contacts that push", "", push);
        add(page, "largest normal force", "N", most);
    }
    if (f->reported) add(page, "overlap", "m", f->report.err.max_overlap);
}

/* Every number of a line of nsd-stat's, named by the keys that lead to it; of a vector its components */
static void add_numbers(struct page *page, json_t *j, const char *name)
{
    const char *key;
    json_t *value;
    bool vector = json_is_array(j) && json_array_size(j) == 3;
    if (json_is_number(j)) add(page, name, measure_unit(name, page->dim), json_number_value(j));
    for (size_t k = 0; vector && k < 3; k++) {
        char longer[200];
        value = json_array_get(j, k);
        snprintf(longer, sizeof longer, "%s.%c", name, "xyz"[k]);
        if (json_is_number(value))
            add(page, longer, measure_unit(name, page->dim), json_number_value(value));
    }
    if (!json_is_object(j)) return;
    json_object_foreach(j, key, value)
    {
        char longer[200];
        if (!*name && (!strcmp(key, "step") || !strcmp(key, "time"))) continue;
        snprintf(longer, sizeof longer, "%s%s%s", name, *name ? "." : "", key);
        add_numbers(page, value, longer);
    }
}

/* The line of nsd-stat's with this step; lines come in the frames' order. NULL: none */
static json_t *stat_line(FILE *lines, int64_t step)
{
    static json_t *next;
    static long number;
    while (lines && (!next || json_integer_value(json_object_get(next, "step")) < step)) {
        json_error_t error;
        json_decref(next);
        next = json_loadf(lines, JSON_DISABLE_EOF_CHECK, &error);
        number++;
        if (!next && feof(lines)) return NULL;
        if (!next) die(EX_DATAERR, "%s: line %ld: %s", stat, number, error.text);
    }
    return next && json_integer_value(json_object_get(next, "step")) == step ? next : NULL;
}

/* ---- frames ---- */

static void add_frame(struct page *page, const struct frame *f, FILE *lines, const char *where)
{
    struct failure failure = { 0 };
    if (page_frame(page, &f->packing, f->detected ? &f->contacts : NULL, &failure))
        die(failure.status, "%s: %s", where, failure.text);
    add_energy(page, &f->packing);
    add_contacts(page, f);
    json_t *j = stat_line(lines, f->packing.step);
    if (j) add_numbers(page, j, "");
}

static void run(struct reader *in, struct page *page, FILE *lines)
{
    struct frame f = { 0 };
    struct failure failure = { 0 };
    struct range range = { 0, INT64_MAX, 1 };
    bool more = false;
    double passed = NAN;
    if (steps && !range_parse(&range, steps)) die_usage("--frames: '%s' is not A:B:K", steps);
    for (int64_t k = 0; !reader_next(in, steps ? &range : NULL, &f, &more, &failure) && more; k++) {
        if (every.steps && k % every.steps) continue;
        tool_wants_packing(&f, reader_where(in));
        if (!every.steps && !every_passed(&every, &passed, f.packing.t)) continue;
        if (!page->out) {
            char *name = title ? strdup(title) : title_of(&f.packing);
            if (page_begin(page, stdout, cli_output() ? cli_output() : "standard output",
                           name ? name : "nsd", &failure))
                die_why(&failure);
            free(name);
        }
        add_frame(page, &f, lines, reader_where(in));
        progress("%lld frames", (long long)page->frames);
    }
    if (failure.status) die_why(&failure);
    if (!page->out) die(EX_DATAERR, "%s: no such frame", reader_where(in));
    if (page_end(page, &failure)) die_why(&failure);
    progress_end();
    frame_free(&f);
}

int tool_main(int argc, char **argv)
{
    struct reader *in;
    struct page page = { 0 };
    struct failure failure = { 0 };
    FILE *lines = stat ? fopen(stat, "r") : NULL;
    if (stat && !lines) die(EX_NOINPUT, "%s: cannot be opened", stat);
    if (reader_open(&in, argc, argv, &failure)) die_why(&failure);
    begin_stdout();
    run(in, &page, lines);
    finish_stdout();
    page_free(&page);
    if (lines) fclose(lines);
    reader_close(in);
    return 0;
}
