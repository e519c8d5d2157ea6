/*
 * FCLIB problems: the input is taken apart into the numbers of a problem, which is made in memory and
 * read again, so that what is fuzzed is not HDF5 but our checks of matrices and vectors. A problem
 * that passes them is solved for some sweeps.
 */
#include "file/fclib.h"
#include "file/source.h"
#include "fuzz.h"
#include "step/step.h"

#include <stdlib.h>
#include <string.h>

struct input {
    const uint8_t *data;
    size_t size;
};

static void take(struct input *in, void *out, size_t size)
{
    size_t n = size < in->size ? size : in->size;
    memset(out, 0, size);
    memcpy(out, in->data, n);
    in->data += n, in->size -= n;
}

static uint8_t byte(struct input *in)
{
    uint8_t b;
    take(in, &b, 1);
    return b;
}

/* Mostly small whole numbers, now and then any bits. */
static double real(struct input *in)
{
    double x;
    uint8_t b = byte(in);
    if (b == 255) return take(in, &x, sizeof x), x;
    return ((int)b - 100) / 8.0;
}

static int32_t integer(struct input *in)
{
    int32_t i;
    uint8_t b = byte(in);
    if (b == 255) return take(in, &i, sizeof i), i;
    return (int32_t)b - 4;
}

static void put_integers(hid_t file, const char *group, const char *name, int count,
                         struct input *in)
{
    int32_t x[256];
    char path[80];
    hsize_t n = (hsize_t)count;
    for (int k = 0; k < count; k++) x[k] = integer(in);
    snprintf(path, sizeof path, "%s/%s", group, name);
    h5_write(file, path, h5_vector(H5T_NATIVE_INT32, n, x), NULL, &(struct failure){ 0 });
}

static void put_reals(hid_t file, const char *group, const char *name, int count, struct input *in)
{
    double x[256];
    char path[80];
    hsize_t n = (hsize_t)count;
    for (int k = 0; k < count; k++) x[k] = real(in);
    snprintf(path, sizeof path, "%s/%s", group, name);
    h5_write(file, path, h5_vector(H5T_NATIVE_DOUBLE, n, x), NULL, &(struct failure){ 0 });
}

static void put_matrix(hid_t file, const char *group, struct input *in)
{
    static const char *const number[] = { "m", "n", "nz", "nzmax" };
    for (int k = 0; k < 4; k++) put_integers(file, group, number[k], 1, in);
    put_integers(file, group, "p", byte(in) % 64, in);
    int entries = byte(in) % 128;
    put_integers(file, group, "i", entries, in);
    put_reals(file, group, "x", byte(in) % 8 ? entries : byte(in) % 128, in);
}

static void solve(struct fclib *F)
{
    struct failure failure = { 0 };
    struct step_opt o = { .solve = { .global = &solver_nlgs,
                                     .method = &local_exact,
                                     .local = { .newton_eps = 1e-12, .newton_max = 20 },
                                     .criterion = CRITERION_NATURAL,
                                     .eps = 1e-8,
                                     .max_sweeps = 3,
                                     .relax = 1,
                                     .threads = 1 } };
    struct report report = { 0 };
    double *u = calloc((size_t)(F->W.n * F->W.d) + 1, sizeof *u);
    if (u && F->W.n < 64) step_solve_delassus(&F->W, u, &o, &report, &failure);
    report_free(&report);
    free(u);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct input in = { data, size };
    struct fclib F = { 0 };
    struct source *s = NULL;
    struct failure failure = { 0 };
    h5_start();
    hid_t plist = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(plist, 1 << 16, 0);
    hid_t file = H5Fcreate("memory", H5F_ACC_TRUNC, H5P_DEFAULT, plist);
    H5Pclose(plist);
    bool global = byte(&in) & 1;
    const char *group = global ? "/fclib_global" : "/fclib_local";
    put_integers(file, group, "spacedim", 1, &in);
    int contacts = byte(&in) % 16;
    put_reals(file, group, "vectors/mu", contacts, &in);
    put_reals(file, group, global ? "vectors/w" : "vectors/q", byte(&in) % 64, &in);
    if (global) {
        put_reals(file, group, "vectors/f", byte(&in) % 64, &in);
        put_matrix(file, "/fclib_global/M", &in);
        put_matrix(file, "/fclib_global/H", &in);
        if (byte(&in) & 1) put_matrix(file, "/fclib_global/G", &in);
        put_reals(file, group, "vectors/b", byte(&in) % 16, &in);
    } else {
        put_matrix(file, "/fclib_local/W", &in);
    }
    if (!source_of_own(&s, file, &failure) && !fclib_read(&F, s, &failure)) solve(&F);
    if (failure.status && !failure.text[0]) abort();
    source_close(s);
    fclib_free(&F);
    H5Fclose(file);
    return 0;
}
