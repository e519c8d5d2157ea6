#include "run/loop.h"

#include "base/array.h"
#include "base/text.h"
#include "file/reader.h"
#include "file/report_json.h"
#include "measure/measures.h"
#include "run/document.h"
#include "run/partner.h"
#include "run/reply.h"
#include "state/selection.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    ANSWER_LEAST = 1 << 20,     /* bytes that an answer may have, at least, */
    ANSWER_BODY = 512,          /* and for each body: four vectors with all their digits have 320 */
    FRAME_MEMORY_MOST = 1 << 30 /* bytes of answers between two frames, which are kept in memory */
};

static const char *command, *replay, *walls, *measures;
static int64_t every = 1;
static double timeout = 60; /* s: a program that computes for a minute before a step is not meant */
static bool document;

const struct cli_option options_loop[] = {
    { CLI_TEXT, 0, "with", &command, "CMD", .silent = true,
      .help = "ask CMD, by lines of JSON, for forces and changes [none]" },
    { CLI_INT, 0, "with-every", &every, "K", .min = 1, .max = 1e15, .silent = true,
      .help = "ask before the first and then every K-th step [1]" },
    { CLI_TEXT, 0, "with-walls", &walls, "all|NAME,...", .silent = true,
      .help = "send these walls, by name or number [none]" },
    { CLI_TEXT, 0, "with-measures", &measures, "A,B,...", .silent = true,
      .help = "send these measures of nsd-stat [none]" },
    { CLI_FLAG, 0, "with-document", &document, .silent = true,
      .help = "send a whole document after each line" },
    { CLI_TIME, 0, "with-timeout", &timeout, "T", .max = 1e9, .silent = true,
      .help = "end the run if CMD takes longer than T: 90 or 90s, 10min [60s]" },
    { CLI_TEXT, 0, "replay", &replay, "FILE", .silent = true,
      .help = "apply the answers stored in FILE, without a program [none]" },
    { 0 },
};

/* An answer of a run before */
struct said {
    int64_t step; /* before which */
    char *
        line; /* as JSON: it is read again when its step comes, for in memory JSON takes many times the room */
};

static struct {
    struct partner *partner;
    const struct measure *chosen[MOST_MEASURES + 1];
    struct asked asked;
    struct selection told; /* walls; none: all */
    struct frame_memory first, before;
    bool remembers;
    struct said *said;
    int64_t n, room;                   /* of them */
    int64_t begin, last;               /* steps of the first and the last frame of the run before */
    int64_t most;                      /* bodies in one of its frames */
    const volatile sig_atomic_t *stop; /* other than 0: the run is to end */
    bool failed;
} loop = { .asked = ASKED_DEFAULT };

bool loop_asks(void)
{
    return command || replay;
}

void loop_check(void)
{
    struct failure failure = { 0 };
    if (command && replay) die_usage("--with and --replay exclude each other");
    for (const struct cli_option *o = options_loop + 1; o->kind && o->to != &replay; o++)
        if (cli_given(o->to) && !command) die_usage("--%s: needs --with", o->name);
    if (measures && measured_choose(loop.chosen, measures, &failure))
        die_usage("--with-measures: %s", strchr(failure.text, ' ') + 1);
}

/* ---- answers of a run before ---- */

/* Bytes that the answer of a program may have that acts on n bodies */
static size_t answer_most(int64_t n)
{
    return ANSWER_LEAST + (size_t)n * ANSWER_BODY;
}

/* {"step": N, "answer": {...}} of a trajectory: the answer, and before which step; NULL: it is none. */
static json_t *stored_answer(const char *line, size_t length, int64_t *step)
{
    json_t *j = json_loadb(line, length, JSON_REJECT_DUPLICATES, NULL);
    json_t *answer = json_object_get(j, "answer"), *before = json_object_get(j, "step");
    bool good = json_is_integer(before) && json_integer_value(before) > 0 && json_is_object(answer);
    *step = good ? json_integer_value(before) : 0;
    answer = good ? json_incref(answer) : NULL;
    json_decref(j);
    return answer;
}

static void keep_line(const char *line, size_t length)
{
    static const char where[] = "/nsd/outside/answer";
    struct failure failure = { 0 };
    int64_t step, before = loop.n ? loop.said[loop.n - 1].step : 0;
    if (length > answer_most(loop.most))
        die(EX_DATAERR, "--replay: %s: %s: an answer of %zu bytes: %zu are allowed", replay, where,
            length, answer_most(loop.most));
    json_t *answer = stored_answer(line, length, &step);
    if (!answer)
        die(EX_DATAERR, "--replay: %s: %s: line %lld is not a step above 0 and an answer", replay,
            where, (long long)loop.n + 1);
    if (reply_check(answer, &failure))
        die(EX_DATAERR, "--replay: %s: %s: line %lld: %s", replay, where, (long long)loop.n + 1,
            failure.text);
    json_decref(answer);
    if (step <= before)
        die(EX_DATAERR, "--replay: %s: %s: line %lld is of step %lld, and the one before of %lld",
            replay, where, (long long)loop.n + 1, (long long)step, (long long)before);
    if (!array_grow(&loop.said, &loop.room, loop.n + 1, sizeof *loop.said))
        die(EX_SOFTWARE, "no memory for answers");
    loop.said[loop.n] = (struct said){ step, strndup(line, length) };
    if (!loop.said[loop.n++].line) die(EX_SOFTWARE, "no memory for answers");
}

static void keep_lines(const struct external_force *o)
{
    for (int64_t at = 0; at < o->length;) {
        const char *line = o->words + at, *end = memchr(line, '\n', (size_t)(o->length - at));
        size_t length = end ? (size_t)(end - line) : (size_t)(o->length - at);
        keep_line(line, length);
        at += (int64_t)length + 1;
    }
}

static void read_answers(void)
{
    struct reader *in;
    struct frame f = { 0 };
    struct failure failure = { 0 };
    bool more;
    char *path = strdup(replay);
    if (!path) die(EX_SOFTWARE, "no memory for a path");
    if (reader_open(&in, 1, &path, &failure)) die_why(&failure);
    for (loop.begin = INT64_MAX; !reader_next(in, NULL, &f, &more, &failure) && more;) {
        const struct packing *p = &f.packing;
        if (!f.packed) continue;
        if (loop.begin == INT64_MAX) loop.begin = p->step;
        if (p->n > loop.most) loop.most = p->n;
        keep_lines(&p->outside), loop.last = p->step;
    }
    if (failure.status) die_why(&failure);
    frame_free(&f);
    reader_close(in);
    free(path);
}

/* Are the answers those of a run that went on from this packing? */
static void check_answers(const struct packing *p)
{
    if (!loop.n) die(EX_DATAERR, "--replay: %s has no answers", replay);
    const int64_t first = loop.said[0].step, last = loop.said[loop.n - 1].step;
    if (last > loop.last + 1)
        die(EX_DATAERR, "--replay: %s: an answer is of step %lld, and the last frame of step %lld",
            replay, (long long)last, (long long)loop.last);
    if (p->step >= loop.last)
        die(EX_DATAERR, "--replay: %s ends with step %lld, and the run begins after step %lld",
            replay, (long long)loop.last, (long long)p->step);
    if (p->step < loop.begin && p->step + 1 < first)
        die(EX_DATAERR,
            "--replay: %s: the first answer is of step %lld, and the run begins after step %lld",
            replay, (long long)first, (long long)p->step);
}

void loop_choose_walls(const struct packing *p)
{
    struct failure failure = { 0 };
    if (!walls || !strcmp(walls, "all")) return;
    if (selection_init(&loop.told, p, "--with-walls", walls, &failure)) die_why(&failure);
    if (!loop.told.walls) die(EX_DATAERR, "--with-walls: '%s' names no wall", walls);
}

void loop_open(const struct packing *p, const volatile sig_atomic_t *stop)
{
    struct failure failure = { 0 };
    loop.stop = stop;
    if (replay) read_answers(), check_answers(p);
    if (command && partner_start(&loop.partner, command, stop, &failure))
        die(failure.status, "--with: %s", failure.text);
}

void loop_close(struct failure *failure)
{
    struct failure trouble = { 0 };
    partner_end(loop.partner, loop.failed ? 0 : timeout, &trouble);
    if (trouble.status && !loop.failed && !*loop.stop)
        failure_set(failure, trouble.status, "--with: %s", trouble.text);
    loop.partner = NULL;
    for (int64_t k = 0; k < loop.n; k++) free(loop.said[k].line);
    free(loop.said);
    frame_memory_free(&loop.first), frame_memory_free(&loop.before), selection_free(&loop.told);
}

/* ---- what is told ---- */

static void put_vector(FILE *out, const char *name, vec3 x)
{
    fprintf(out, ",\"%s\":[", name);
    print_number(out, x.x, "null"), fputc(',', out);
    print_number(out, x.y, "null"), fputc(',', out);
    print_number(out, x.z, "null"), fputc(']', out);
}

/* N: what the bodies do to the wall; found: of solved contacts */
static vec3 force_on(const struct packing *p, const struct contacts *s, int32_t wall)
{
    vec3 sum = v3(0, 0, 0);
    for (int64_t i = 0; i < s->n && s->c[i].a < 0; i++)
        if (s->c[i].a == -1 - wall)
            sum = v3_axpy(sum, -1 / p->dt, contact_in_space(&s->c[i], s->found[i].r));
    return sum;
}

static void loop_put_walls(FILE *out, const struct packing *p, const struct contacts *s)
{
    const char *mark = "";
    const bool formerly = cli_given_formerly(&walls); // --with-boundaries, and so its keys
    fprintf(out, ",\"%s\":[", formerly ? "boundaries" : "walls");
    for (int32_t w = 0; w < p->walls; w++) {
        if (!selection_wall(&loop.told, p, w)) continue;
        vec3 x = wall_at(p, &p->wall[w], p->t);
        fprintf(out, "%s{\"%s\":%d", mark, formerly ? "boundary" : "wall", w);
        if (names_of_wall(&p->names, w))
            fprintf(out, ",\"name\":\"%s\"", names_of_wall(&p->names, w));
        put_vector(out, "position", x);
        put_vector(out, "velocity", wall_velocity(p, &p->wall[w], x));
        if (s && s->found)
            put_vector(out, "force", force_on(p, s, w));
        else
            fputs(",\"force\":null", out);
        fputc('}', out), mark = ",";
    }
    fputc(']', out);
}

/* Of the step before; f NULL: there is none. "account" is that of all steps. */
static void put_report(FILE *out, const struct frame *f)
{
    fprintf(out, ",\"converged\":%s", !f ? "null" : f->report.converged ? "true" : "false");
    fputs(",\"account\":", out);
    json_t *j = f ? json_account(&f->account, &f->packing.names) : json_null();
    json_write(out, j);
    json_decref(j);
}

static int put_measures(FILE *out, const struct frame *f, const struct contacts *s,
                        struct failure *failure)
{
    struct snapshot look;
    struct table t[MOST_MEASURES];
    const struct packing *p = &f->packing;
    snapshot_init(&look, p, s, f->moved, &loop.asked, failure);
    look.report = f->reported ? &f->report : NULL;
    if (loop.remembers) look.first = &loop.first, look.before = &loop.before;
    if (!measured_run(t, loop.chosen, &look, failure)) {
        fputs(",\"measures\":", out);
        measured_json(out, &look, loop.chosen, t);
    }
    measured_free(t);
    if (!failure->status && measured_remember(loop.chosen)) {
        loop.remembers = true;
        measured_keep(loop.chosen, &look, &loop.first, &loop.before, failure);
    }
    snapshot_free(&look);
    return failure->status;
}

/* The line, and the document behind it; to be freed */
static char *loop_message(const struct frame *f, const struct contacts *s, struct control *acts,
                          size_t *length, struct failure *failure)
{
    const struct packing *p = &f->packing;
    struct text written;
    char *text, *bytes = NULL;
    size_t size = 0;
    struct frame all = *f;
    all.detected = s != NULL;
    if (document && acts->id && control_arrays(acts, p, failure)) return NULL;
    if (document) all.packing.outside.lasts = control_lend(acts, p->walls);
    if (document && !(bytes = document_write(&all, &size, failure))) return NULL;
    FILE *out = text_open(&written);
    if (out) {
        fprintf(out, "{\"step\":%" PRId64 ",\"time\":", p->step);
        print_number(out, p->t, "null");
        fputs(",\"dt\":", out), print_number(out, p->dt, "null");
        fprintf(out, ",\"bodies\":%" PRId64, p->n);
        put_report(out, s ? f : NULL);
        if (walls) loop_put_walls(out, p, s);
        if (measures) put_measures(out, f, s, failure);
        if (document) fprintf(out, ",\"document\":%zu", size);
        fputs("}\n", out);
        if (size) fwrite(bytes, 1, size, out);
    }
    if (!(text = text_close(&written, out, length)))
        failure_set(failure, EX_SOFTWARE, "no memory for a line");
    free(bytes);
    return text;
}

/* ---- a step ---- */

/* For whoever repeats the run */
static int loop_keep(struct packing *p, const json_t *answer, struct failure *failure)
{
    json_t *j = json_pack("{s:I, s:O}", "step", (json_int_t)p->step + 1, "answer", answer);
    char *text = j ? json_dumps(j, JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
    json_decref(j);
    if (!text) return failure_set(failure, EX_SOFTWARE, "no memory for an answer");
    size_t n = strlen(text);
    text[n] = '\n'; // in place of its end
    if (p->outside.length + (int64_t)n > FRAME_MEMORY_MOST)
        failure_set(failure, EX_UNAVAILABLE,
                    "more than %d MiB of answers since the last frame: keep more frames (--every)",
                    FRAME_MEMORY_MOST >> 20);
    else
        external_force_say(&p->outside, text, (int64_t)n + 1, failure);
    free(text);
    return failure->status;
}

static json_t *loop_ask(const struct frame *f, struct control *acts, bool first,
                        struct failure *failure)
{
    size_t n, length = 0;
    char *line, *text = loop_message(f, first ? NULL : &f->contacts, acts, &length, failure);
    json_t *answer = NULL;
    if (!failure->status && (first || !partner_check_silent(loop.partner, failure)) &&
        !partner_write(loop.partner, text, length, timeout, failure)) {
        partner_expect(loop.partner, timeout);
        if (!partner_line(loop.partner, &line, &n, answer_most(f->packing.n), failure))
            answer = reply_parse(line, n, failure);
    }
    free(text);
    return answer;
}

/* The last answer until the step: before the first one of a run what acts since then, later its own */
static json_t *replayed(int64_t step, bool first, struct failure *failure)
{
    int64_t lo = 0, hi = loop.n; // in the order of their steps
    while (lo < hi) {
        int64_t middle = lo + (hi - lo) / 2;
        *(loop.said[middle].step <= step ? &lo : &hi) =
            loop.said[middle].step <= step ? middle + 1 : middle;
    }
    if (!lo || (!first && loop.said[lo - 1].step != step)) return NULL;
    const char *line = loop.said[lo - 1].line;
    json_t *answer = stored_answer(line, strlen(line), &step);
    if (!answer) failure_set(failure, EX_SOFTWARE, "no memory for an answer");
    return answer;
}

bool loop_before_step(struct frame *f, struct control *acts, bool first, struct failure *failure)
{
    struct packing *p = &f->packing;
    struct failure trouble = { 0 };
    p->outside.steered = true; // from the first frame on: later answers may move what rests
    bool stop = *loop.stop, due = first || p->step % every == 0;
    if (stop) return false;
    json_t *answer = NULL;
    if (replay) answer = replayed(p->step + 1, first, &trouble);
    if (command && due) answer = loop_ask(f, acts, first, &trouble);
    if (answer && !trouble.status && !reply_apply(answer, acts, p, &stop, &trouble))
        loop_keep(p, answer, &trouble);
    if (replay && !answer) stop = p->step >= loop.last;
    json_decref(answer);
    if (!trouble.status) return !stop;
    loop.failed = !*loop.stop;
    if (*loop.stop) return false;
    failure_set(failure, trouble.status == EX_SOFTWARE ? EX_SOFTWARE : EX_UNAVAILABLE,
                "step %lld: --%s: %s", (long long)p->step + 1, command ? "with" : "replay",
                trouble.text);
    return false;
}
