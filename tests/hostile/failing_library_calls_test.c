/* What reads, writes, builds, solves, measures and exports when it does not get what it asks for: tests/support/failing_library_calls.h */
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): asprintf
#include "frames.h"

#include "convert/fields_file.h"
#include "convert/format.h"
#include "file/frame_read.h"
#include "measure/measures.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- the runs: each returns a status, and what it made, as a checksum, in *crc ---- */

static int write_to(const char *path, enum writer_kind kind, int frames, uint32_t *crc,
                    struct failure *failure)
{
    struct writer *w = NULL;
    struct frame f = frame[now];
    if (!writer_open(&w, path, kind, failure))
        for (int k = 0; k < frames && !writer_frame(w, &f, failure); k++)
            f.packing.step++, f.packing.t += f.packing.dt;
    if (w) writer_close(w, failure);
    *crc = crc_of(path);
    return failure->status;
}

static int write_stream(uint32_t *crc, struct failure *failure)
{
    return write_to(fresh(".h5"), WRITER_STREAM, 1, crc, failure);
}

static int write_trajectory(uint32_t *crc, struct failure *failure)
{
    return write_to(fresh(".h5"), WRITER_TRAJECTORY, 2, crc, failure);
}

static int write_problem(bool global, uint32_t *crc, struct failure *failure)
{
    struct frame was = frame[now];
    frame[now].export = &problem[now], frame[now].export_global = global;
    frame[now].write_export = fclib_write_problem;
    write_stream(crc, failure);
    frame[now] = was;
    return failure->status;
}

static int write_local(uint32_t *crc, struct failure *failure)
{
    return write_problem(false, crc, failure);
}

static int write_global(uint32_t *crc, struct failure *failure)
{
    return write_problem(true, crc, failure);
}

static int write_over(uint32_t *crc, struct failure *failure)
{
    struct writer *w = NULL;
    const char *path = fresh(".h5");
    close(open(path, O_WRONLY | O_CREAT, 0666));
    if (!writer_open(&w, path, WRITER_IN_PLACE, failure) && !writer_frame(w, &frame[now], failure))
        writer_take_place(w, failure);
    if (w) writer_close(w, failure);
    *crc = crc_of(path);
    return failure->status;
}

/* What was read is written again, where nothing fails. */
static int rewritten(const struct frame *f, uint32_t *crc, struct failure *failure)
{
    struct writer *w = NULL;
    const char *path = fresh(".h5");
    bool was = armed;
    armed = false;
    if (!failure->status && !writer_open(&w, path, WRITER_STREAM, failure))
        writer_frame(w, f, failure);
    if (w) writer_close(w, failure);
    *crc = crc_of(path);
    armed = was;
    return failure->status;
}

/* By a process of its own, as tools do */
static int read_apart(uint32_t *crc, struct failure *failure)
{
    struct reader *r = NULL;
    struct frame f = { 0 };
    bool more = false;
    if (!reader_open(&r, 1, &document[now], failure)) {
        reader_copies(r);
        reader_next(r, NULL, &f, &more, failure);
    }
    rewritten(&f, crc, failure);
    frame_free(&f);
    reader_close(r);
    return failure->status;
}

/* The same by this process: a hundred times as fast, so that every call may fail */
static int read_document(uint32_t *crc, struct failure *failure)
{
    struct source *s = NULL;
    struct frame_read doc = { 0 };
    struct frame f = { 0 };
    bool was = armed;
    armed = false;
    hid_t file = open_copy(document[now]);
    armed = was;
    if (!source_of_own(&s, file, failure) && !frame_read_open(&doc, s, failure) &&
        !frame_read_moment(&doc, 0, &f, failure))
        unknown_read(&f.unknown, s, true, failure);
    rewritten(&f, crc, failure);
    frame_free(&f), frame_read_close(&doc), source_close(s);
    armed = false;
    H5Fclose(file);
    armed = was;
    return failure->status;
}

/* The same problem, written into memory, read back, and its solution stored and loaded */
static int problem_in_memory(bool global, uint32_t *crc, struct failure *failure)
{
    struct fclib F = { 0 };
    struct source *s = NULL;
    double *u = NULL, *r = NULL;
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, 1 << 16, false);
    hid_t file = H5Fcreate("memory", H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    if (file < 0) return failure_set(failure, EX_SOFTWARE, "no file in memory");
    if (fclib_write_problem(&problem[now], global, file, failure) ||
        source_of_own(&s, file, failure) || fclib_read(&F, s, failure))
        goto end;
    source_close(s), s = NULL;
    u = calloc((size_t)(F.W.n * F.W.d) + 1, sizeof *u),
    r = calloc((size_t)(F.W.n * F.W.d) + 1, sizeof *r);
    if (!u || !r) failure_set(failure, EX_SOFTWARE, "no memory of the test's");
    for (int64_t k = 0; u && r && k < F.W.n * F.W.d; k++) u[k] = r[k] = (double)k;
    if (failure->status || fclib_store_solution(&F, file, u, r, failure) ||
        source_of_own(&s, file, failure) || fclib_load_solution(&F, s, u, failure))
        goto end;
    *crc = document_crc(0, u, (size_t)(F.W.n * F.W.d) * sizeof *u);
    *crc = document_crc(*crc, F.W.q, (size_t)(F.W.n * F.W.d) * sizeof *u);
end:
    source_close(s), fclib_free(&F);
    free(u), free(r);
    bool was = armed;
    armed = false;
    H5Fclose(file);
    armed = was;
    return failure->status;
}

static int local_in_memory(uint32_t *crc, struct failure *failure)
{
    return problem_in_memory(false, crc, failure);
}

static int global_in_memory(uint32_t *crc, struct failure *failure)
{
    return problem_in_memory(true, crc, failure);
}

static int build_scene(uint32_t *crc, struct failure *failure)
{
    struct packing p = { 0 };
    if (build(&p, now, failure)) return failure->status;
    *crc = document_crc(0, p.x, (size_t)p.n * sizeof *p.x);
    packing_free(&p);
    return 0;
}

static int copy_packing(uint32_t *crc, struct failure *failure)
{
    struct packing p = { 0 };
    if (packing_copy(&p, &frame[now].packing, failure)) return failure->status;
    *crc = document_crc(0, p.x, (size_t)p.n * sizeof *p.x);
    packing_free(&p);
    return 0;
}

/* A step of a solver; one that finds no memory for what it can do without has another solution. */
static const struct solver *solver_now;
static int make_step(uint32_t *crc, struct failure *failure)
{
    struct packing p = { 0 };
    struct contacts s = { 0 };
    struct report rep = { 0 };
    bool was = armed;
    armed = false;
    must(packing_copy(&p, &frame[now].packing, failure), failure);
    if (contacts_copy(&s, &frame[now].contacts)) exit(1);
    armed = was;
    step(&p, &s, solver_now, &rep, failure);
    *crc = 0;
    report_free(&rep), contacts_free(&s), packing_free(&p);
    return failure->status;
}

static int measure(uint32_t *crc, struct failure *failure)
{
    static struct asked with = { .axis = -1, .layers = 3, .bins = 5, .radius = INFINITY };
    struct snapshot s;
    struct frame_memory first = { 0 };
    const char *path = fresh(".json");
    FILE *out = fopen(path, "w");
    if (!out) return failure_set(failure, EX_SOFTWARE, "no file of the test's");
    with.normal = v3(1, 0, 0);
    snapshot_init(&s, &frame[now].packing, &frame[now].contacts, true, &with, failure);
    if (!failure->status && !frame_memory_set(&first, &frame[now].packing, failure))
        s.first = s.before = &first;
    for (int k = 0; !failure->status && measure_at(k); k++) {
        struct table t = { 0 };
        if (!measure_run(&t, measure_at(k), &s, failure)) table_json(out, &t, measure_at(k)->list);
        table_free(&t);
    }
    frame_memory_free(&first), snapshot_free(&s);
    fclose(out);
    *crc = crc_of(path);
    return failure->status;
}

static int coarse(uint32_t *crc, struct failure *failure)
{
    static const struct asked with = { .axis = -1, .layers = 3, .bins = 5, .radius = INFINITY };
    struct snapshot s;
    struct fields f = { 0 };
    struct fields_file *file = NULL;
    const char *path = fresh(".h5"), *image = fresh(".vti");
    snapshot_init(&s, &frame[now].packing, &frame[now].contacts, true, &with, failure);
    if (!failure->status && !fields_init(&f, &s, 0, 0, failure)) {
        (void)fields_set(&f, &s, failure);
        if (!fields_file_open(&file, path, &f, "", failure))
            for (int k = 0; k < 2 && !fields_file_add(file, &f, k, k, failure); k++) continue;
        FILE *out = fopen(image, "w");
        if (out) vti_write(out, &f, 3, 0.1), fclose(out);
    }
    if (file) fields_file_close(file, failure);
    fields_free(&f);
    *crc = crc_of(path) ^ crc_of(image);
    return failure->status;
}

static int export_all(uint32_t *crc, struct failure *failure)
{
    void *kept = NULL;
    const struct export_frame m = {
        &frame[now].packing, &frame[now].contacts, 1, &kept, NULL, NULL
    };
    *crc = 0;
    for (int k = 0; !failure->status && format_at(k); k++)
        for (int part = 0; part < PART_COUNT; part++) {
            bool triangles = part == PART_GRAINS || part == PART_WALLS;
            if (format_at(k) == &format_stl ? !triangles : part && !format_at(k)->parts) continue;
            const char *path = fresh(".out");
            FILE *out = fopen(path, "w");
            if (!out) return failure_set(failure, EX_SOFTWARE, "no file of the test's");
            struct failure one = { 0 }; // what a format has not is no failure
            format_at(k)->write(out, &m, (enum part)part, true, &one);
            if (one.status && one.status != EX_DATAERR) *failure = one;
            if (kept && format_at(k)->end) format_at(k)->end(out, kept, failure);
            kept = NULL;
            fclose(out);
            uint32_t bytes = crc_of(path); // walls that find no memory are left out
            if (part != PART_WALLS && format_at(k) != &format_stl) *crc ^= bytes;
        }
    return failure->status;
}

int main(void)
{
    failing_begin();
    h5_start();
    make_frames();
    for (now = 0; now < SCENES; now++) {
        each_fails("a stream", write_stream);
        each_fails("a trajectory", write_trajectory);
        each_fails("a document", read_document);
        each_fails("a scene", build_scene);
        each_fails("a copy", copy_packing);
        each_fails("measures", measure);
        each_fails("fields", coarse);
        each_fails("exports", export_all);
        for (int k = 0; (solver_now = solvers[k]); k++) each_fails(solver_now->name, make_step);
    }
    now = 0;
    each_fails("a file's place", write_over);
    most_failures = 16;
    each_fails("a process that reads", read_apart);
    most_failures = LONG_MAX;
    each_fails("with a local problem", write_local);
    each_fails("with a global problem", write_global);
    each_fails("a local problem", local_in_memory);
    each_fails("a global problem", global_in_memory);
    now = SCENES;
    each_fails("a problem from elsewhere", write_stream);
    each_fails("its document", read_document);
    for (int k = 0; k <= SCENES; k++) unlink(document[k]);
    return failing_done();
}
