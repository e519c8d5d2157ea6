/*
 * Every field of the tables of state/field_tables.c, in frames of several scenes: a copy has it, and is a copy; a document that is
 * written and read has it, with random numbers that are legal; and where all frames of a trajectory share it, a frame with
 * another number is refused by its name.
 */
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): asprintf
#include "file/reader.h"
#include "file/writer.h"
#include "state/fields.h"
#include "state/part.h"
#include "tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const scenes[] = { "press",  "bonded",    "pour",  "bricks", "silo",
                                      "piston", "isotropic", "shear", "rest" };
enum { SCENES = sizeof scenes / sizeof *scenes, WITHOUT_WALLS = 6, ALL = 8, TRIES = 12 };
/* What none of them has: signals of walls and loads, forces on bodies, a mesh, names, bonds of shapes, rolling */
static const char rest[] =
    "{ \"kinds\": { \"glass\": { \"breaks\": { \"by\": \"energy\", \"strength\": 10, \"smallest\": "
    "1e-3, "
    "\"size\": 2e-3, \"modulus\": 3, \"least\": 0.1, \"damage\": \"tavares\", \"into\": \"balls\", "
    "\"dust\": 1e-4 } } }, \"dt\": 1e-3, \"mu\": 0.3, \"e_n\": 0.1, \"overlap\": true, \"shapes\": "
    "{ \"pill\": { "
    "\"capsule\": { \"length\": 1, \"radius\": 0.5 } } },"
    "\"pairs\": [{ \"pair\": [\"ball\", \"ball\"], \"adhesion\": { \"c_n\": 1e4, \"c_t\": "
    "1e4, \"w\": 0.2, \"eta\": 1e-4 }, \"rolling\": { \"mu_r\": 1e-3 }, \"stiffness\": \"auto\" },"
    "{ \"pair\": [\"ball\", \"wall\"], \"stiffness\": 1e6 }],"
    "\"walls\": [{ \"name\": \"floor\", \"point\": [0, 0, -1], \"normal\": [0, 0, 1], "
    "\"drives\": [{ \"along\": [0, 0, 1], \"amplitude\": 1e-3, \"frequency\": 2 },"
    "{ \"along\": [1, 0, 0], \"table\": [[0, 0], [1, 1e-3], [2, 0]] }] },"
    "{ \"name\": \"lid\", \"point\": [0, 0, 9], \"normal\": [0, 0, -1],"
    "\"load\": { \"along\": [0, 0, 1], \"mass\": 2, \"force\": { \"table\": [[0, 1], [1, "
    "2]], \"mean\": 3 } } },"
    "{ \"mesh\": { \"file\": \"mesh.obj\" } }],"
    "\"forces\": [{ \"bodies\": [0, 1], \"force\": { \"amplitude\": 1, \"frequency\": 3 }, "
    "\"along\": [1, 0, 0] }, { \"bodies\": [1], \"torque\": 2, \"about\": [0, 0, 1] }],"
    "\"bodies\": [{ \"x\": [0, 0, 0], \"radius\": 1, \"name\": \"charge\", \"shape\": "
    "\"pill\" }, { \"x\": [0, 0.99, 0], \"radius\": 1, \"shape\": \"pill\" }, { \"x\": [4, "
    "0, 0], \"radius\": 1, \"mass\": 3 }] }";
static char folder[] = "/tmp/fields_test.XXXXXX";
static unsigned state = 7;

static double uniform(void)
{
    state = state * 1664525u + 1013904223u;
    return (double)(state >> 8) / (1 << 24);
}

static bool get(struct frame *f, const char *path)
{
    struct failure failure = { 0 };
    struct reader *r;
    bool more = false;
    char *name = (char *)path;
    int e = reader_open(&r, 1, &name, &failure) || reader_last(r, f, &more, &failure) || !more;
    reader_close(r);
    return !e && f->packed;
}

/* Is it as it was when it has been written and read? */
static bool goes_around(struct frame *f, struct frame *back)
{
    struct failure failure = { 0 };
    struct writer *w = NULL;
    char path[80];
    snprintf(path, sizeof path, "%s/around.h5", folder);
    bool written = !writer_open(&w, path, WRITER_STREAM, &failure) && !writer_frame(w, f, &failure);
    if (!written) return writer_drop(w), false;
    return !writer_close(w, &failure) && get(back, path);
}

/* ---- numbers ---- */

static double number_of(const struct field *f, const void *x)
{
    return f->type == COLUMN_F64   ? *(const double *)x
           : f->type == COLUMN_I64 ? (double)*(const int64_t *)x
           : f->type == COLUMN_I32 ? *(const int32_t *)x
                                   : *(const int8_t *)x;
}

static void set_number(const struct field *f, void *x, double to)
{
    if (f->type == COLUMN_F64) *(double *)x = to;
    if (f->type == COLUMN_I64) *(int64_t *)x = (int64_t)to;
    if (f->type == COLUMN_I32) *(int32_t *)x = (int32_t)to;
    if (f->type == COLUMN_I8) *(int8_t *)x = (int8_t)to;
}

/* Another number than the one at x, of the k-th kind */
static void change(const struct field *f, void *x, int k)
{
    const double now = number_of(f, x), was = isfinite(now) ? now : 2;
    const double real[] = { was * (1 + 0.1 * uniform()) + 1e-3 * uniform(), uniform(),
                            was + 1e-9 * (1 + uniform()), 0, 1 };
    const double whole[] = { was + 1, was - 1, 1 - was, 0, 1 };
    set_number(f, x, f->type == COLUMN_F64 ? real[k % 5] : whole[k % 5]);
}

/* Some number of a row of the field, in an array of rows */
static void *place(const struct field *f, void *rows, int64_t n, size_t stride)
{
    const int64_t row = (int64_t)(uniform() * (double)n);
    const int k = (int)(uniform() * f->width);
    return (char *)rows + (size_t)row * stride + f->offset + (size_t)k * field_size(f->type);
}

static bool all_equal(const struct field *f, const void *x, const void *y, int64_t n, size_t stride)
{
    bool same = x && y;
    for (int64_t i = 0; i < n && same; i++) {
        const size_t at = (size_t)i * stride + f->offset;
        same = field_equal(f, (const char *)x + at, (const char *)y + at);
    }
    return same;
}

/* ---- a copy ---- */

static bool part_is_text(const struct part *a)
{
    return a->traits & PART_TEXT;
}

static void test_copy(const char *scene, const struct packing *p)
{
    struct packing q;
    struct failure failure = { 0 };
    bool good = !packing_copy(&q, p, &failure);
    for (const struct part *a = packing_parts; a->name && good; a++) {
        const void *x = part_array(a, p), *y = part_array(a, &q);
        good = part_count(a, p) == part_count(a, &q) && !x == !y && (!x || x != y);
        for (const struct field *f = a->fields; good && x && !part_is_text(a) && f->name; f++)
            if (!all_equal(f, x, y, part_count(a, p), a->bytes))
                good = false, diag("%s: %s of %s", scene, f->name, a->name);
    }
    ok(good, "%s: a copy has all of the packing, in arrays of its own", scene);
    ok(!packing_same_settings(p, &q, &failure), "%s: its settings are the same (%s)", scene,
       failure.text);
    packing_free(&q);
}

/* ---- what is the same in all frames ---- */

/* Is a frame refused, and by the name of the field, just where all frames share it? */
static bool is_named(const struct packing *first, const struct packing *q, const struct field *f,
                     bool shared)
{
    struct failure failure = { 0 };
    const bool refused = packing_same_settings(first, q, &failure);
    const bool good = refused == shared && (!refused || strstr(failure.text, f->name));
    if (!good) diag("%s: %s", f->name, refused ? failure.text : "is not named");
    return good;
}

static void test_compare(const char *scene, const struct packing *p)
{
    struct packing q;
    struct failure failure = { 0 };
    bool good = !packing_copy(&q, p, &failure);
    int fields = 0;
    q.outside.steered = false;
    for (const struct part *a = packing_parts; a->name && good; a++)
        for (const struct field *f = a->fields; !part_is_text(a) && f->name; f++) {
            const int64_t n = part_count(a, p);
            if (!part_array(a, &q) || !n) continue;
            char was[8], *x = place(f, part_array(a, &q), n, a->bytes);
            memcpy(was, x, field_size(f->type));
            change(f, x, 0);
            good &= is_named(p, &q, f, a->traits & PART_SETTING && f->traits & FIELD_SAME);
            if (f->traits & FIELD_STEERED) {
                q.outside.steered = true;
                good &= is_named(p, &q, f, false);
                q.outside.steered = false;
            }
            memcpy(x, was, field_size(f->type));
            fields++;
        }
    const struct field *const tables[] = { packing_fields, cell_fields };
    for (int k = 0; k < 2; k++)
        for (const struct field *f = tables[k]; f->name; f++, fields++) {
            char was[8], *x = place(f, &q, 1, 0);
            memcpy(was, x, field_size(f->type));
            change(f, x, 0);
            good &= is_named(p, &q, f, true);
            memcpy(x, was, field_size(f->type));
        }
    ok(good && fields > 20, "%s: each of %d fields, changed, is named where all frames share it",
       scene, fields);
    packing_free(&q);
}

/* ---- documents ---- */

static bool done[100][60]; /* fields that have gone around: of a table, its row */
static int around, not_legal;

/* Numbers of the field that are legal, if any are, go around. x, y: where the rows are, and where their array is read to */
static bool around_with(struct frame *f, const struct field *field, void *x, int64_t n,
                        size_t stride, const void *(*find)(const struct frame *, int), int table)
{
    const size_t size = field_size(field->type);
    struct frame back = { 0 };
    bool good = true, legal = false;
    for (int k = 0; k < TRIES && !legal; k++) {
        char was[8], *at = place(field, x, n, stride);
        memcpy(was, at, size);
        change(field, at, k);
        if (memcmp(was, at, size) != 0 && goes_around(f, &back)) {
            legal = true, around++;
            good = all_equal(field, x, find(&back, table), n, stride);
            if (!good) diag("%s is lost", field->name);
        }
        memcpy(at, was, size);
    }
    not_legal += !legal;
    if (!legal) diag("no other number of %s was found that is legal", field->name);
    frame_free(&back);
    return good;
}

static const void *find_part(const struct frame *f, int k)
{
    return part_array(&packing_parts[k], &f->packing);
}

static const void *find_in_frame(const struct frame *f, int k)
{
    const void *const at[] = { &f->report, f->contacts.c, f->contacts.found, f->contacts.law };
    return at[k];
}

static void test_parts(const char *scene, struct frame *f)
{
    bool good = true;
    int fields = 0;
    for (int k = 0; packing_parts[k].name; k++) {
        const struct part *a = &packing_parts[k];
        for (int j = 0; !part_is_text(a) && a->fields[j].name; j++) {
            if (!part_array(a, &f->packing) || !part_count(a, &f->packing) || done[k][j]) continue;
            if (a->fields[j].when && !a->fields[j].when(&f->packing)) continue;
            good &= around_with(f, &a->fields[j], part_array(a, &f->packing),
                                part_count(a, &f->packing), a->bytes, find_part, k);
            done[k][j] = true, fields++;
        }
    }
    ok(good, "%s: %d more fields of the packing are read as they were written", scene, fields);
}

static void test_frame(const char *scene, struct frame *f)
{
    struct contacts *s = &f->contacts;
    static bool read[12];
    struct {
        const struct field *fields;
        int where; /* find_in_frame() */
        int64_t n;
        size_t stride;
    } tables[] = { { report_fields, 0, 1, 0 },
                   { velocity_fields, 0, 1, 0 },
                   { balance_fields, 0, 1, 0 },
                   { bond_balance_fields, 0, 1, 0 },
                   { spring_balance_fields, 0, 1, 0 },
                   { gain_balance_fields, 0, 1, 0 },
                   { peculiar_balance_fields, 0, 1, 0 },
                   { projection_balance_fields, 0, 1, 0 },
                   { contact_fields, 1, s->n, sizeof *s->c },
                   { contact_key_fields, 1, s->n, sizeof *s->c },
                   { found_fields, 2, s->found ? s->n : 0, sizeof *s->found },
                   { contact_law_fields, 3, s->law ? s->n : 0, sizeof *s->law } };
    bool good = true;
    f->report.criterion = CRITERION_VELOCITY, f->report.balanced = f->report.tied = true;
    f->report.may_gain = f->report.projected = f->report.sheared = f->report.soft = true;
    for (size_t k = 0; k < sizeof tables / sizeof *tables; k++)
        for (const struct field *j = tables[k].fields; j->name && tables[k].n && !read[k]; j++) {
            if (j->when && !j->when(&f->packing)) continue;
            good &= around_with(f, j, (void *)find_in_frame(f, tables[k].where), tables[k].n,
                                tables[k].stride, find_in_frame, tables[k].where);
        }
    for (size_t k = 0; k < sizeof tables / sizeof *tables; k++) read[k] |= tables[k].n > 0;
    ok(good, "%s: fields of contacts and reports are read as they were written", scene);
}

static void put_file(const char *name, const char *text)
{
    char path[80];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "w");
    if (!f || fputs(text, f) < 0 || fclose(f)) exit(1);
}

/* As if a program acted on it */
static void push(struct packing *p)
{
    struct failure failure = { 0 };
    struct external_force *o = &p->outside;
    if (external_force_alloc(&o->force, p->n, &failure) ||
        external_force_alloc(&o->torque, p->n, &failure) ||
        external_force_alloc(&o->lasts.force, p->n, &failure) ||
        external_force_alloc(&o->lasts.torque, p->n, &failure) ||
        external_force_alloc_push(o, p->walls, &failure) ||
        external_force_say(o, "{}\n", 3, &failure))
        exit(1);
    o->lasts.push = calloc((size_t)p->walls + 1, sizeof *o->lasts.push);
}

/* A frame after three steps of the scene */
static bool run(struct frame *f, int k)
{
    char *command, *path;
    const char *sums = k < WITHOUT_WALLS || k == ALL ? "--wall-loads" : "";
    if (asprintf(&path, "%s/out.h5", folder) < 0 ||
        asprintf(&command,
                 "nsd-gen %s/%s.json | nsd-step -n 3 --every 3 --contacts --warm %s -o %s "
                 "2>%s/said",
                 k < ALL ? "scenes" : folder, scenes[k], sums, path, folder) < 0)
        exit(1);
    unlink(path);
    bool there = !system(command) && get(f, path); // NOLINT(cert-env33-c)
    free(command), free(path);
    return there;
}

/* Each field is in one of the scenes, but for the factor of a cell's load. */
static void test_all_done(void)
{
    int missed = 0;
    for (const struct part *a = packing_parts; a->name; a++)
        for (int j = 0; a->fields[j].name && !part_is_text(a); j++) {
            if (done[a - packing_parts][j]) continue;
            missed++, diag("no scene has %s of a %s", a->fields[j].name, a->name);
        }
    ok(missed <= 1, "each field of a packing is in one of the scenes");
}

int main(void)
{
    if (!mkdtemp(folder)) return 1;
    put_file("rest.json", rest);
    put_file("mesh.obj", "v -9 -9 -3\nv 9 -9 -3\nv 0 9 -3\nf 1 2 3\n");
    for (int k = 0; k < SCENES; k++) {
        struct frame f = { 0 };
        if (ok(run(&f, k), "%s: three steps", scenes[k])) {
            if (k == ALL) push(&f.packing);
            test_copy(scenes[k], &f.packing);
            test_compare(scenes[k], &f.packing);
            test_parts(scenes[k], &f);
            if (f.detected) test_frame(scenes[k], &f);
        }
        frame_free(&f);
    }
    test_all_done();
    ok(around > 120 && not_legal < around / 5,
       "%d fields have gone around, of %d no other number was legal", around, not_legal);
    const char *const names[] = { "said", "out.h5", "around.h5", "rest.json", "mesh.obj" };
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char path[80];
        snprintf(path, sizeof path, "%s/%s", folder, names[k]), unlink(path);
    }
    rmdir(folder);
    return tap_done();
}
