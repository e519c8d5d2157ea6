/*
 * tests/support/frames.h: a solved frame of each scene of tests/support/failing_library_calls.h and a problem from elsewhere, in memory
 * and in files.
 */
#ifndef NSD_FRAMES_H
#define NSD_FRAMES_H

#include "failing_library_calls.h"

#include "file/reader.h"
#include "file/source.h"
#include "file/writer.h"
#include "scene/inlet.h"
#include "step/step.h"

static struct frame frame[SCENES + 1]; /* one of each, solved; and a foreign problem, also solved */
static char *document[SCENES + 1]; /* files that have them, with things that nsd does not know */
static struct problem problem[SCENES]; /* of their contacts */

static struct step_opt options(const struct solver *solver)
{
    return (struct step_opt){ .solve = { .global = solver,
                                         .method = &local_exact,
                                         .criterion = CRITERION_NATURAL,
                                         .eps = 1e-10,
                                         .max_sweeps = 200,
                                         .history = true,
                                         .threads = 1,
                                         .local = { .newton_eps = 1e-13, .newton_max = 100 } } };
}

static int step(struct packing *p, struct contacts *s, const struct solver *solver,
                struct report *rep, struct failure *failure)
{
    struct flow flow;
    struct step_memory memory = { 0 };
    struct step_opt o = options(solver);
    bool changed;
    if (flow_read(&flow, p, failure)) return failure->status;
    if (!flow_step(&flow, p, s, &changed, failure)) step_advance(p, s, &memory, &o, rep, failure);
    step_forget(&memory), flow_free(&flow);
    return failure->status;
}

/* ---- the documents ---- */

/* The document without its header, as a file from elsewhere, with some things more in it */
static char *foreign(const char *path, const char *to)
{
    static unsigned char bytes[1 << 22];
    struct failure failure = { 0 };
    const hsize_t shape[2] = { 2, 3 }, one = 1;
    const double six[6] = { 1, 2, 3, 4, 5, 6 };
    const int32_t whole = 7;
    FILE *f = fopen(path, "r");
    size_t n = f ? fread(bytes, 1, sizeof bytes, f) : 0;
    if (f) fclose(f);
    unlink(path);
    if (n <= DOCUMENT_USERBLOCK || !(f = fopen(to, "w"))) exit(1);
    fwrite(bytes + DOCUMENT_USERBLOCK, 1, n - DOCUMENT_USERBLOCK, f);
    fclose(f);
    hid_t file = H5Fopen(to, H5F_ACC_RDWR, H5P_DEFAULT);
    must(
        h5_write(file, "/mine/six", h5_array(H5T_NATIVE_DOUBLE, 2, shape, six), "m", &failure) ||
            h5_write(file, "/mine/one", h5_vector(H5T_NATIVE_INT32, one, &whole), NULL, &failure) ||
            h5_write_text(file, "/mine/text", "some words", &failure) ||
            h5_attr(file, "/mine", "six", h5_vector(H5T_NATIVE_DOUBLE, 6, six), &failure) ||
            h5_attr_text(file, "/mine/six", "by", "hand", &failure),
        &failure);
    H5Fclose(file);
    return (char *)to;
}

static void make_frame(int k)
{
    struct failure failure = { 0 };
    struct frame *f = &frame[k];
    must(build(&f->packing, k, &failure), &failure);
    for (int i = 0; i < 3; i++) {
        report_free(&f->report);
        must(step(&f->packing, &f->contacts, &solver_nlgs, &f->report, &failure), &failure);
    }
    f->report.options = strdup("{}");
    f->packed = f->detected = f->reported = f->moved = f->forces = true;
    f->history = strdup("{\"command\": \"a test\"}\n");
    must(problem_prepare(&problem[k], &f->packing, &f->contacts,
                         &(struct prepare_opt){ .rho_factor = 1 }, &failure),
         &failure);
    now = k;
    const char *path = fresh(".h5");
    struct writer *w;
    // as if a program had acted on it: tables of /nsd/outside
    struct external_force *o = &f->packing.outside;
    const char words[] = "{\"step\":1,\"answer\":{}}\n";
    must(external_force_alloc(&o->force, f->packing.n, &failure) ||
             external_force_alloc(&o->torque, f->packing.n, &failure) ||
             external_force_alloc_push(o, f->packing.walls, &failure) ||
             external_force_say(o, words, sizeof words - 1, &failure),
         &failure);
    o->steered = true;
    o->force[0].x = 1e-3, o->torque[0].z = 1e-4;
    must(external_force_alloc(&o->lasts.force, f->packing.n, &failure), &failure);
    o->lasts.force[0].y = 2e-3;
    if (f->packing.walls) o->push[0] = 0.25;
    must(writer_open(&w, path, WRITER_STREAM, &failure) || writer_frame(w, f, &failure) ||
             writer_close(w, &failure),
         &failure);
    document[k] = foreign(path, fresh(".hdf5"));
}

/* The problem of the first frame, as a global one from elsewhere, with a solution */
static void make_foreign(void)
{
    struct failure failure = { 0 };
    struct reader *r;
    bool more;
    char *path = (char *)fresh(".hdf5");
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    must(file < 0 || fclib_write_problem(&problem[0], true, file, &failure), &failure);
    H5Fclose(file);
    must(reader_open(&r, 1, &path, &failure), &failure);
    reader_copies(r);
    must(reader_next(r, NULL, &frame[SCENES], &more, &failure), &failure);
    frame[SCENES].u = calloc((size_t)(frame[SCENES].problem.W.n * 3) + 1, sizeof(double));
    reader_close(r);
    unlink(path);
    struct writer *w;
    path = (char *)fresh(".h5");
    must(writer_open(&w, path, WRITER_STREAM, &failure) ||
             writer_frame(w, &frame[SCENES], &failure) || writer_close(w, &failure),
         &failure);
    document[SCENES] = foreign(path, fresh(".hdf5"));
}

/* A copy in memory; what is changed there stays there. */
static hid_t open_copy(const char *path)
{
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, 1 << 16, false);
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, access);
    H5Pclose(access);
    return file;
}

static void make_frames(void)
{
    for (int k = 0; k < SCENES; k++) make_frame(k);
    make_foreign();
}

#endif
