/* A run in a program (run/nsd.h): closed forms of what acts on it, documents, threads, bad input, calls at random. */
#include "run/nsd.h"
#include "tap.h"

#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[] = "/tmp/nsd_api.XXXXXX";

static const char *path_of(const char *name)
{
    static char path[8][100];
    static int k;
    snprintf(path[++k % 8], sizeof path[0], "%s/%s", folder, name);
    return path[k % 8];
}

static void must(int failed, const struct nsd_run *r)
{
    if (!failed) return;
    printf("Bail out! %s\n", nsd_error(r));
    exit(1);
}

static struct nsd_run *scene(const char *text)
{
    struct nsd_run *r;
    must(nsd_from_scene(&r, text, NULL), NULL);
    return r;
}

/* The numbers of an array; n: of rows */
static const double *array(struct nsd_run *r, const char *name, int64_t *n)
{
    struct nsd_array a = { .size = sizeof a };
    must(nsd_read(r, name, &a), r);
    if (n) *n = a.shape[0];
    return a.data;
}

static double number(struct nsd_run *r, const char *name)
{
    double x = NAN;
    must(nsd_number(r, name, &x), r);
    return x;
}

static bool close_to(double x, double y)
{
    return fabs(x - y) <= 1e-12 * (1 + fabs(y));
}

/* ---- closed forms ---- */

static const char free_bodies[] =
    "{\"dt\":1e-3,\"gravity\":[0,0,-2],\"density\":1000,\"shapes\":{\"brick\":{\"box\":[1,2,3]}},"
    "\"bodies\":[{\"x\":[0,0,0],\"radius\":0.1},{\"x\":[9,0,0],\"shape\":\"brick\",\"size\":0.1},"
    "{\"x\":[18,0,0],\"radius\":0.1,\"fixed\":true}]}";

static void test_forces(void)
{
    struct nsd_run *r = scene(free_bodies);
    const double *x = array(r, "position", NULL), *v = array(r, "velocity", NULL);
    const double *w = array(r, "angular_velocity", NULL);
    const double *m = array(r, "mass", NULL), *I = array(r, "inertia", NULL);
    const double f[3] = { 3, 0, 1 }, torque[3] = { 0, 0, 0.5 }, t = 0.1;
    must(nsd_force(r, 0, f, torque, NSD_LASTING) || nsd_force(r, 2, f, torque, NSD_LASTING) ||
             nsd_force(r, 1, f, NULL, NSD_ONCE) || nsd_step(r, 100),
         r);
    ok(close_to(v[0], f[0] / m[0] * t) && close_to(v[2], (f[2] / m[0] - 2) * t) &&
           close_to(x[0], f[0] / m[0] * t * t / 2) && close_to(w[2], torque[2] / I[0] * t),
       "a force and a torque that last: x = F t^2/(2 m), w = T t/I");
    ok(close_to(v[3], f[0] / m[1] * 1e-3) && close_to(v[5], f[2] / m[1] * 1e-3 - 2 * t),
       "a force that acts once: v = F dt/m");
    ok(v[6] == 0 && w[8] == 0 && x[6] == 18, "a fixed body feels none");
    ok(x == array(r, "position", NULL) && v == array(r, "velocity", NULL),
       "arrays of bodies stay where they are");
    double *force = (double *)(uintptr_t)array(r, "force", NULL);
    must(force[0] != f[0] || force[1] != 0 || force[2] != f[2], r);
    const double before = v[0];
    memset(force, 0, 9 * sizeof *force);
    force[1] = 7;
    must(nsd_step(r, 1), r);
    ok(v[0] == before && close_to(v[1], 7 / m[0] * 1e-3),
       "what is written into the array force acts");
    double kinetic = 0, loads;
    kinetic = number(r, "kinetic_energy");
    must(nsd_step(r, 1), r);
    const char *json;
    must(nsd_report(r, &json), r);
    const char *at = strstr(json, "\"loads\":"), *gravity = strstr(json, "\"gravity\":");
    loads = at && gravity ? atof(at + 8) + atof(gravity + 10) : NAN;
    ok(fabs(number(r, "kinetic_energy") - kinetic - loads) < 1e-12 * (1 + kinetic),
       "the balance has the work of forces");
    nsd_close(&r);
}

/* A brick with three moments of inertia, turned about a principal axis */
static void test_top(void)
{
    struct nsd_run *r = scene("{\"dt\":1e-3,\"gravity\":[0,0,0],\"density\":1000,\"shapes\":{"
                              "\"brick\":{\"box\":[1,2,3]}},"
                              "\"bodies\":[{\"x\":[0,0,0],\"shape\":\"brick\",\"size\":0.1}]}");
    const double *w = array(r, "angular_velocity", NULL), *m = array(r, "mass", NULL);
    const double torque[3] = { 1e-3, 0, 0 };
    const double I = m[0] / 12 * 0.01 * (4 + 9) / 1; // sides 0.1, 0.2, 0.3 m
    must(nsd_force(r, 0, NULL, torque, NSD_LASTING) || nsd_step(r, 100), r);
    double unit = 12 * 1e-3 * 0.1 / (w[0] * m[0] * 13); // the square of its size
    ok(fabs(w[1]) < 1e-15 && fabs(w[2]) < 1e-15 && w[0] > 0 &&
           (close_to(w[0], 1e-3 * 0.1 / I) || close_to(unit, 0.01)),
       "a torque about a principal axis of a brick: w = T t/I");
    nsd_close(&r);
}

static void test_velocities(void)
{
    struct nsd_run *r = scene(free_bodies);
    const double *x = array(r, "position", NULL), *v = array(r, "velocity", NULL);
    const double *w = array(r, "angular_velocity", NULL);
    const double u[3] = { 3, 0, 1 }, spin[3] = { 0, 0, 5 }, bad[3] = { 0, NAN, 0 };
    must(nsd_step(r, 50) || nsd_velocity(r, 0, u, spin) || nsd_velocity(r, 2, u, NULL) ||
             nsd_step(r, 100),
         r);
    ok(close_to(v[0], 3) && close_to(v[2], 1 - 2 * 0.1) && close_to(x[0], 0.3) && close_to(w[2], 5),
       "a velocity that is given: v = u + g t");
    ok(v[6] == 3 && close_to(x[6], 18.3), "a fixed body keeps it");
    ok(nsd_velocity(r, 0, spin, bad) == NSD_DATA && v[0] == 3 && w[2] == 5 &&
           nsd_velocity(r, 9, u, NULL) == NSD_DATA && nsd_velocity(NULL, 0, u, u) == NSD_USAGE,
       "one that is not finite, or of no body, leaves all as it was");
    nsd_close(&r);
}

static void test_walls(void)
{
    struct nsd_run *r =
        scene("{\"dt\":1e-3,\"gravity\":[0,0,0],\"bodies\":[{\"x\":[0,0,5],\"radius\":0.1}],"
              "\"walls\":[{\"point\":[0,0,0],\"normal\":[0,0,1],\"velocity\":[0,0,0.5]},"
              "{\"point\":[0,0,9],\"normal\":[0,0,-1],\"load\":{\"along\":[0,0,1],\"mass\":2,"
              "\"force\":1}}]}");
    const double v[3] = { 0, 0, -0.25 };
    must(nsd_step(r, 100) || nsd_wall_velocity(r, 0, v) || nsd_wall_force(r, 1, 3, NSD_LASTING) ||
             nsd_step(r, 100),
         r);
    const double *x = array(r, "wall_position", NULL), *u = array(r, "wall_velocity", NULL);
    ok(close_to(x[2], 0.5 * 0.1 - 0.25 * 0.1) && close_to(u[2], -0.25),
       "a boundary goes on from where it is with another velocity");
    ok(close_to(u[5], (1 * 0.2 + 3 * 0.1) / 2), "a force on a boundary adds to that of its load");
    nsd_close(&r);
}

/* Arrays of bodies stay where they are, also where a step fails in which bonds might have broken. */
static void test_places(void)
{
    struct nsd_run *r = scene(
        "{\"dt\":1e-3,\"cohesion\":{\"force\":1,\"range\":1e-5},\"density\":1000,\"bodies\":[{"
        "\"x\":[0,0,0.1],\"radius\":"
        "0.1},{\"x\":[1,0,0.1],\"radius\":0.1}],\"walls\":[{\"point\":[0,0,0],\"normal\":[0,0,1]}]"
        "}");
    must(nsd_step(r, 5), r);
    const double *x = array(r, "position", NULL), *v = array(r, "velocity", NULL);
    double *f = (double *)(uintptr_t)array(r, "force", NULL), was[6];
    memcpy(was, x, sizeof was);
    f[3] = NAN;
    int failed = nsd_step(r, 1);
    ok(failed == NSD_DATA && x == array(r, "position", NULL) && v == array(r, "velocity", NULL) &&
           f == array(r, "force", NULL) && isnan(f[3]) && !memcmp(x, was, sizeof was),
       "arrays stay where they are when a step of a scene with cohesion fails");
    f[3] = 0, f[0] = 1;
    must(nsd_step(r, 1), r);
    ok(v[0] > 0 && x[0] > 0 && v[3] == 0, "and the run goes on in them");
    nsd_close(&r);
}

/* ---- documents ---- */

static const char heap[] =
    "{\"dt\":1e-4,\"mu\":0.3,\"bodies\":[{\"count\":40,\"radius\":{\"uniform\":[4e-4,5e-4]},"
    "\"box\":{\"x\":[0,5e-3],\"y\":[0,5e-3],\"z\":[0,4e-3]}}],"
    "\"walls\":[{\"box\":{\"x\":[0,5e-3],\"y\":[0,5e-3],\"z\":[0,null]}},"
    "{\"point\":[0,0,6e-3],\"normal\":[0,0,-1],\"load\":{\"along\":[0,0,1],\"mass\":1e-4,\"force\":"
    "-0.02}}]}";

/* Acts on the run as a function of its step, n times */
static int act(struct nsd_run *r, int n)
{
    int64_t bodies;
    struct nsd_array a = { .size = sizeof a };
    for (int k = 0; k < n; k++) {
        if (nsd_read(r, "force", &a)) return 1;
        bodies = a.shape[0];
        const double step = number(r, "step"), *v = array(r, "velocity", NULL);
        double *f = a.data;
        for (int64_t i = 0; i < 3 * bodies; i++) f[i] = -1e-4 * v[i] * (1 + sin(step));
        const double g[3] = { sin(0.1 * step), 0, -9.81 }, up[3] = { 0, 0, 0.01 * cos(step) };
        if (nsd_gravity(r, g) || nsd_wall_velocity(r, 5, up) ||
            nsd_friction(r, "ball", "wall", step < 20 ? 0.3 : 0.1) || nsd_step(r, 1))
            return 1;
    }
    return 0;
}

static bool same(struct nsd_run *a, struct nsd_run *b)
{
    static const char *const names[] = { "position",         "velocity",      "orientation",
                                         "angular_velocity", "wall_position", "wall_velocity" };
    bool equal = number(a, "time") == number(b, "time");
    for (int k = 0; k < 6; k++) {
        int64_t n, m;
        const double *x = array(a, names[k], &n), *y = array(b, names[k], &m);
        equal = equal && n == m && !memcmp(x, y, (size_t)n * (k == 2 ? 4 : 3) * sizeof *x);
    }
    return equal;
}

static void test_resume(void)
{
    struct nsd_run *whole = scene(heap), *half = scene(heap), *rest, *frames;
    const char *path = path_of("half.h5"), *trajectory = path_of("frames.h5");
    must(act(whole, 40), whole);
    must(act(half, 23) || nsd_save(half, path), half);
    must(nsd_append(half, trajectory) || act(half, 2) || nsd_append(half, trajectory) ||
             nsd_finish(half),
         half);
    must(nsd_from_document(&rest, path) || nsd_from_document(&frames, trajectory), NULL);
    must(act(rest, 17), rest);
    must(act(frames, 15), frames);
    ok(same(whole, rest), "a run that was acted on resumes from a document bit for bit");
    ok(same(whole, frames), "and from the last frame of a trajectory");
    FILE *f = fopen(path, "r");
    static char bytes[1 << 22];
    size_t n = f ? fread(bytes, 1, sizeof bytes, f) : 0;
    if (f) fclose(f);
    struct nsd_run *memory;
    must(nsd_from_memory(&memory, bytes, n), NULL);
    must(act(memory, 17), memory);
    ok(same(whole, memory), "and from a document in memory");
    nsd_close(&whole), nsd_close(&half), nsd_close(&rest), nsd_close(&frames), nsd_close(&memory);
}

/* All bytes of a file, to be freed */
static char *bytes_of(const char *path, size_t *n)
{
    FILE *f = fopen(path, "r");
    char *bytes = malloc(1 << 22);
    *n = f && bytes ? fread(bytes, 1, 1 << 22, f) : 0;
    if (f) fclose(f);
    return bytes;
}

static bool same_files(const char *a, const char *b)
{
    size_t n, m;
    char *x = bytes_of(a, &n), *y = bytes_of(b, &m);
    bool same = n && n == m && !memcmp(x, y, n);
    free(x), free(y);
    return same;
}

/* Forces that last go with documents, and those of one step do not. */
static void test_lasting(void)
{
    static const char light[] =
        "{\"dt\":1e-3,\"gravity\":[0,0,0],\"density\":1000,\"bodies\":[{\"x\":[0,0,1],\"radius\":"
        "0.1},{\"x\":[5,0,1],\"radius\":0.1}],\"walls\":[{\"point\":[0,0,0],\"normal\":[0,0,1],"
        "\"load\":{\"along\":[0,0,1],\"mass\":2}}]}";
    const double f[3] = { 3, 0, 1 }, torque[3] = { 0, 0, 0.5 }, none[3] = { 0 };
    struct nsd_run *r = scene(light), *twin = scene(light), *rest;
    const char *path = path_of("lasting.h5"), *a = path_of("all.h5"), *b = path_of("rest.h5");
    must(nsd_append(r, path) || nsd_force(r, 1, f, torque, NSD_LASTING) ||
             nsd_wall_force(r, 0, -4, NSD_LASTING) || nsd_step(r, 10) ||
             nsd_force(r, 0, f, torque, NSD_ONCE) || nsd_append(r, path) || nsd_finish(r),
         r);
    must(nsd_from_document(&rest, path) || nsd_step(rest, 10) || nsd_save(rest, b), rest);
    must(nsd_force(r, 0, none, none, NSD_ONCE) || nsd_step(r, 10) || nsd_save(r, a), r);
    const double *m = array(rest, "mass", NULL), *v = array(rest, "velocity", NULL);
    const double *u = array(rest, "wall_velocity", NULL);
    ok(close_to(v[3], f[0] / m[1] * 0.02) && close_to(v[5], f[2] / m[1] * 0.02) && v[0] == 0 &&
           close_to(u[2], -4 * 0.02 / 2),
       "a run that is resumed goes on with the forces that last: v = F t/m");
    ok(same(r, rest), "and that is what the run itself does, bit for bit");
    nsd_close(&rest);
    must(nsd_from_document(&rest, a), NULL);
    must(nsd_force(rest, 1, none, none, NSD_LASTING) || nsd_wall_force(rest, 0, 0, NSD_LASTING) ||
             nsd_save(rest, b),
         rest);
    nsd_close(&rest), nsd_close(&r);
    must(nsd_from_document(&rest, b), NULL);
    const double before = array(rest, "velocity", NULL)[3];
    must(nsd_step(rest, 3), rest);
    ok(array(rest, "velocity", NULL)[3] == before, "what was taken back does not go with them");
    r = scene(light);
    must(nsd_force(r, 1, f, torque, NSD_LASTING) || nsd_force(r, 1, none, none, NSD_LASTING) ||
             nsd_save(r, a) || nsd_save(twin, b),
         r);
    ok(same_files(a, b), "a document without them keeps its bytes");
    nsd_close(&r), nsd_close(&rest), nsd_close(&twin);
}

/* n steps, a frame every fifth */
static void append(struct nsd_run *r, const char *path, int n)
{
    for (int k = 5; k <= n; k += 5) must(act(r, 5) || nsd_append(r, path), r);
}

static void write_file(const char *path, const char *bytes, size_t n)
{
    FILE *f = fopen(path, "w");
    if (!f || fwrite(bytes, 1, n, f) != n || fclose(f)) exit(1);
}

/* A trajectory in two parts is that of one run. */
static void test_append(const char *name, const char *text, const char *option, bool killed)
{
    const char *whole = path_of("whole.h5"), *parts = path_of("parts.h5");
    remove(whole), remove(parts);
    struct nsd_run *r = scene(text);
    must(nsd_set(r, option, "true"), r);
    append(r, whole, 40);
    must(nsd_finish(r), r);
    nsd_close(&r);
    pid_t child = killed ? fork() : 0;
    if (!child) {
        r = scene(text);
        must(nsd_set(r, option, "true"), r);
        append(r, parts, 20);
        if (killed) _exit(0); // its trajectory is not finished
        nsd_close(&r);
    }
    if (killed) waitpid(child, NULL, 0);
    must(nsd_from_document(&r, parts), NULL);
    must(nsd_set(r, option, "true"), r);
    append(r, parts, 20);
    nsd_close(&r);
    ok(same_files(whole, parts), "%s: a trajectory that goes on has the bytes of one in one piece",
       name);
}

static void refuse(struct nsd_run *r, const char *path, int status, const char *words)
{
    size_t n, m;
    char *before = bytes_of(path, &n);
    int got = nsd_append(r, path);
    bool said = strstr(nsd_error(r), words);
    char *after = bytes_of(path, &m);
    ok(got == status && said && n == m && !memcmp(before, after, n),
       "not gone on with, and left as it is: %s", nsd_error(r));
    free(before), free(after);
}

static void test_appends(void)
{
    static const char few[] = "{\"dt\":1e-3,\"mu\":0.3,\"bodies\":[{\"count\":9,\"radius\":0.1,"
                              "\"box\":{\"x\":[0,1],\"y\":[0,"
                              "1],\"z\":[0,1]}}],\"walls\":[{\"box\":{\"x\":[0,1],\"y\":[0,1],"
                              "\"z\":[0,null]}},{\"point\":"
                              "[0,0,3],\"normal\":[0,0,-1]}]}";
    test_append("a heap", heap, "warm", false);
    test_append("with forces", heap, "forces", false);
    test_append("a run that was killed", few, "contacts", true);
    const char *path = path_of("parts.h5"), *other = path_of("other.h5"), *cut = path_of("cut.h5");
    struct nsd_run *r = scene(few), *twin;
    refuse(r, path, NSD_DATA, "has step 5 already, and the run is at step 0: remove it");
    must(nsd_from_document(&twin, path), NULL);
    refuse(twin, path, NSD_DATA, "has step 40 already, and the run is at step 40");
    must(nsd_step(twin, 5), twin);
    remove(other);
    struct nsd_run *stranger = scene(heap);
    must(nsd_append(stranger, other), stranger);
    refuse(twin, other, NSD_OUTPUT, "is writing it");
    must(nsd_finish(stranger), stranger);
    refuse(twin, other, NSD_DATA, "belongs to another scene");
    size_t n;
    char *bytes = bytes_of(path, &n);
    write_file(cut, bytes, n / 2);
    refuse(twin, cut, NSD_DATA, "cut.h5");
    for (size_t k = n / 2; k < n / 2 + 64; k++) bytes[k] = (char)(bytes[k] ^ 0x5a);
    write_file(cut, bytes, n);
    refuse(twin, cut, NSD_DATA, "cut.h5");
    free(bytes);
    write_file(cut, "my notes\n", 9);
    refuse(twin, cut, NSD_DATA, "cut.h5");
    const int32_t gone = 3;
    must(nsd_remove(twin, 1, &gone), twin);
    refuse(twin, path, NSD_DATA, "8 bodies, and the trajectory has 9");
    must(nsd_append(stranger, path_of("fresh.h5")) || nsd_finish(stranger), stranger);
    nsd_close(&r), nsd_close(&twin), nsd_close(&stranger);
}

/* A body falls, is taken out, or both, as a function of the step. */
static void come_and_go(struct nsd_run *r, int n, const char *path)
{
    for (int k = 0; k < n; k++) {
        const int step = (int)number(r, "step");
        const double x[3] = { -2, 0, 2.5 }, radius = 0.05;
        const struct nsd_bodies one = {
            .size = sizeof one, .n = 1, .position = x, .radius = &radius, .density = 1000
        };
        int32_t id;
        if (step % 20 == 3) must(nsd_add(r, &one, &id), r);
        if (step % 20 == 13) {
            struct nsd_array ids = { .size = sizeof ids };
            must(nsd_read(r, "id", &ids), r);
            must(nsd_remove(r, 1, (const int32_t *)ids.data + ids.shape[0] / 2), r);
        }
        must(nsd_step(r, 1), r);
        if (path && step % 5 == 4) must(nsd_append(r, path), r);
    }
}

/* Scenes that pour and remove take bodies, and give them, too. */
static void test_flow(void)
{
    static const char pours[] =
        "{\"dt\":5e-3,\"walls\":[{\"point\":[0,0,-1],\"normal\":[0,0,1]}],\"density\":1000,"
        "\"pour\":[{\"rate\":40,\"radius\":0.1,\"density\":1000,\"count\":30,\"opening\":{\"disc\":"
        "{"
        "\"center\":[0,0,3],\"normal\":[0,0,1],\"radius\":1}}}],"
        "\"remove\":[{\"below\":{\"point\":[0,0,-0.5],\"normal\":[0,0,1]}}]}";
    const char *whole = path_of("flow.h5"), *parts = path_of("flows.h5");
    const char *a = path_of("flow_a.h5"), *b = path_of("flow_b.h5");
    struct nsd_run *r = scene(pours), *half = scene(pours);
    come_and_go(r, 200, whole);
    must(nsd_save(r, a) || nsd_finish(r), r);
    come_and_go(half, 90, parts);
    must(nsd_finish(half), half);
    nsd_close(&half);
    must(nsd_from_document(&half, parts), NULL);
    come_and_go(half, 110, parts);
    must(nsd_save(half, b) || nsd_finish(half), half);
    ok(same(r, half) && same_files(whole, parts),
       "bodies that a program adds and removes where others are poured and removed: a trajectory "
       "that goes on has the same bytes");
    int64_t n;
    struct nsd_array ids = { .size = sizeof ids };
    must(nsd_read(r, "id", &ids), r);
    n = ids.shape[0];
    const int32_t *id = ids.data;
    bool rising = n > 1;
    for (int64_t i = 1; i < n; i++) rising = rising && id[i] > id[i - 1];
    // 30 are poured, and 10 are added; 10 are taken out, and the scene removes what falls through
    ok(rising && id[n - 1] < 40 && id[n - 1] >= 35, "each has a number of its own, in order");
    struct nsd_run *plain = scene(pours), *gone = scene(pours);
    const double x[3] = { -5, 0, 2.5 }, radius = 0.1;
    const struct nsd_bodies one = {
        .size = sizeof one, .n = 1, .position = x, .radius = &radius, .density = 1000
    };
    int32_t new;
    // the list of small steps serves as long as the fastest body of all permits
    must(nsd_set(plain, "small-steps", "0") || nsd_step(plain, 30), plain);
    must(nsd_set(gone, "small-steps", "0") || nsd_step(gone, 10) || nsd_add(gone, &one, &new) ||
             nsd_step(gone, 10) || nsd_remove(gone, 1, &new) || nsd_step(gone, 10),
         gone);
    ok(same(plain, gone),
       "a body that comes and goes far away leaves the others' motion as it was");
    nsd_close(&r), nsd_close(&half), nsd_close(&plain), nsd_close(&gone);
}

/* Bodies as arrays are those of the scene. */
static void test_arrays(void)
{
    struct nsd_run *a = scene(heap), *b;
    struct nsd_bodies all = { .size = sizeof all };
    all.position = array(a, "position", &all.n), all.radius = array(a, "radius", NULL);
    all.velocity = array(a, "velocity", NULL), all.mass = array(a, "mass", NULL);
    all.orientation = array(a, "orientation", NULL), all.inertia = array(a, "inertia", NULL);
    char text[sizeof heap];
    const char *from = strstr(heap, "\"bodies\""), *to = strstr(heap, "\"walls\"");
    snprintf(text, sizeof text, "%.*s%s", (int)(from - heap), heap, to);
    must(nsd_from_arrays(&b, text, NULL, &all), NULL);
    must(nsd_step(a, 60), a), must(nsd_step(b, 60), b);
    ok(same(a, b), "a run from arrays is that of the scene that has these bodies");
    const int32_t gone[2] = { 3, 17 };
    must(nsd_remove(b, 2, gone), b);
    int64_t n;
    const double *x = array(b, "position", &n), *y = array(a, "position", NULL);
    bool kept =
        n == 38 && !memcmp(x, y, 9 * sizeof *x) && !memcmp(x + 9, y + 12, 13 * 3 * sizeof *x);
    int32_t id = -1;
    const double at[3] = { 2.5e-3, 2.5e-3, 5e-3 }, radius = 2e-4;
    const struct nsd_bodies one = {
        .size = sizeof one, .n = 1, .position = at, .radius = &radius, .density = 2500
    };
    must(nsd_add(b, &one, &id) || nsd_step(b, 5), b);
    ok(kept && id == 40 && number(b, "bodies") == 39,
       "bodies go, others keep their numbers, and a new one gets a new number");
    nsd_close(&a), nsd_close(&b);
}

/* ---- threads ---- */

static void *one_run(void *arg)
{
    struct nsd_run *r = scene(heap);
    must(nsd_set(r, "threads", "2") || act(r, 40) || nsd_save(r, path_of(arg)), r);
    return r;
}

static void test_threads(void)
{
    pthread_t t[2];
    void *r[3] = { one_run("a.h5") };
    static char names[2][8] = { "b.h5", "c.h5" };
    for (int k = 0; k < 2; k++)
        if (pthread_create(&t[k], NULL, one_run, names[k])) exit(1);
    for (int k = 0; k < 2; k++) pthread_join(t[k], &r[k + 1]);
    ok(same(r[0], r[1]) && same(r[0], r[2]), "two runs in two threads are what one alone is");
    for (int k = 0; k < 3; k++) {
        struct nsd_run *one = r[k];
        nsd_close(&one);
    }
}

/* ---- bad input ---- */

/* A ball between the floor and a plate that comes down: no step has a solution. */
static void test_failure(void)
{
    static const char scene[] =
        "{\"dt\": 1e-3, \"mu\": 1, \"bodies\": [{\"x\": [0, 0, 0], \"radius\": 0.1, \"mass\": 1}], "
        "\"walls\": ["
        "{\"point\": [0, 0, -0.1], \"normal\": [0, 0, 1], \"name\": \"floor\"},"
        "{\"point\": [0, 0, 0.1], \"normal\": [0, 0, -1], \"velocity\": [0, 0, -0.1]}]}";
    struct nsd_run *r;
    const char *text;
    double converged;
    must(nsd_from_scene(&r, scene, NULL), NULL);
    must(nsd_failure(r, &text), r);
    ok(!*text, "before the first step none has failed");
    must(nsd_set(r, "solver", "auto"), r);
    must(nsd_step(r, 2) || nsd_failure(r, &text), r);
    ok(strstr(text, "2 steps not converged (first step 1, wall ") && strstr(text, " and body 0)"),
       "steps that fail are known, with who is concerned: %s", text);
    must(nsd_number(r, "converged", &converged) || nsd_report(r, &text), r);
    ok(converged == 0 && strstr(text, "\"account\":{\"steps\":2,"), "the report has the account");
    nsd_close(&r);
}

/* What would be infinite after a step, which is then not made */
static void test_endless(void)
{
    static const char scene[] =
        "{\"dt\": 1e-3, \"bodies\": [{\"x\": [0, 0, 1], \"radius\": 1e-3}]}";
    const double push[3] = { 1e308, 0, 0 }, fast[3] = { 1e160, 0, 0 };
    struct nsd_run *r;
    struct nsd_array x = { .size = sizeof x };
    double step;
    must(nsd_from_scene(&r, scene, NULL), NULL);
    must(nsd_step(r, 3) || nsd_read(r, "position", &x), r);
    const double z = ((double *)x.data)[2];
    nsd_force(r, 0, push, NULL, NSD_LASTING);
    ok(nsd_step(r, 1) == NSD_DIVERGED &&
           strstr(nsd_error(r), "step 4: the energy of body 0 would not be finite"),
       "a step whose velocity is infinite is not made: %s", nsd_error(r));
    must(nsd_number(r, "step", &step), r);
    ok(step == 3 && ((double *)x.data)[2] == z, "and the run is as it was");
    nsd_force(r, 0, NULL, NULL, NSD_LASTING);
    must(nsd_step(r, 1), r);
    must(nsd_velocity(r, 0, fast, NULL), r);
    ok(nsd_step(r, 1) == NSD_DIVERGED && strstr(nsd_error(r), "step 5: the energy of body 0"),
       "nor one whose energy is: %s", nsd_error(r));
    nsd_close(&r);
}

/* A ball that rests sinks by m g/k as soon as its contact has a stiffness, and rises where it is rigid again. */
static void test_stiffness(void)
{
    struct nsd_run *r =
        scene("{\"dt\": 1e-3, \"walls\": [{\"point\": [0, 0, 0], \"normal\": [0, 0, 1]}], "
              "\"bodies\": [{\"x\": [0, 0, 0.01], \"radius\": 0.01, \"mass\": 0.02}]}");
    must(nsd_set(r, "tolerance", "1e-9") || nsd_step(r, 20) || nsd_set(r, "stiffness", "1e5") ||
             nsd_step(r, 400),
         r);
    const double sunk = 0.01 - array(r, "position", NULL)[2], wanted = 0.02 * 9.81 / 1e5;
    ok(fabs(sunk - wanted) < 1e-5 * wanted, "a ball sinks by m g/k: %.6g m", sunk);
    must(nsd_append(r, path_of("soft.h5")), r);
    ok(nsd_set(r, "stiffness", "rigid") == NSD_USAGE, "a trajectory has one stiffness: %s",
       nsd_error(r));
    must(nsd_finish(r) || nsd_set(r, "stiffness", "rigid") || nsd_step(r, 5), r);
    nsd_close(&r);
}

/* A ball falls from 0.1 m onto a floor with e_n 0.5: in small steps it keeps a quarter of its energy. Contacts with springs that are too
   stiff are made at once, and the number of small steps says so. */
static void test_small_steps(void)
{
    struct nsd_run *r = scene(
        "{\"dt\": 1e-3, \"e_n\": 0.5, \"walls\": [{\"point\": [0, 0, 0], \"normal\": [0, 0, 1]}], "
        "\"bodies\": [{\"x\": [0, 0, 0.11], \"radius\": 0.01, \"mass\": 0.02}]}");
    double n = 0;
    must(nsd_set(r, "small-steps", "0.01") || nsd_step(r, 200) || nsd_number(r, "small_steps", &n),
         r);
    const double v = array(r, "velocity", NULL)[2], z = array(r, "position", NULL)[2];
    ok(n >= 1, "a step is made in %g small ones", n);
    ok(fabs((v * v / 2 + 9.81 * (z - 0.01)) / 0.981 - 0.25) < 2e-3, "which keep Newton's law");
    must(nsd_set(r, "stiffness", "1e5") || nsd_step(r, 1) || nsd_number(r, "small_steps", &n), r);
    ok(n > 1, "so is a step with a stiffness");
    must(nsd_set(r, "stiffness", "1e12") || nsd_step(r, 1) || nsd_number(r, "small_steps", &n), r);
    ok(n == 0, "a step with springs that are too stiff is made at once, and the run says so");
    must(nsd_set(r, "stiffness", "rigid") || nsd_set(r, "small-steps", "0") || nsd_step(r, 1) ||
             nsd_number(r, "small_steps", &n),
         r);
    ok(n == 0, "small steps are switched off");
    ok(nsd_set(r, "small-steps", "2") == NSD_USAGE, "at most 0.1: %s", nsd_error(r));
    nsd_close(&r);
}

static void test_errors(void)
{
    struct nsd_run *r = scene(heap), *none = NULL, *twin = scene(heap);
    struct nsd_array a = { .size = sizeof a }, small = { .size = 3 };
    const double bad[3] = { NAN, 0, 0 }, f[3] = { 0, 0, 1 };
    const int32_t ids[2] = { 3, 3 };
    struct nsd_bodies b = { .size = sizeof b, .n = 1 }, negative = { .size = sizeof b, .n = -1 };
    const struct {
        int got, want;
        const char *what;
    } calls[] = {
        { nsd_step(none, 1), NSD_USAGE, "no run" },
        { nsd_step(r, -1), NSD_USAGE, "steps back" },
        { nsd_until(r, INFINITY), NSD_USAGE, "until never" },
        { nsd_until(r, 1e300), NSD_USAGE, "too many steps" },
        { nsd_set(r, "tolerance", "small"), NSD_USAGE, "no number" },
        { nsd_set(r, "epsilon", "1"), NSD_USAGE, "no option" },
        { nsd_set(r, NULL, "1"), NSD_USAGE, "no name" },
        { nsd_set(r, "dt", "-1"), NSD_USAGE, "no time step" },
        { nsd_set(r, "stiffness", "soft"), NSD_USAGE, "no stiffness" },
        { nsd_read(r, "speed", &a), NSD_USAGE, "no array" },
        { nsd_read(r, "position", &small), NSD_USAGE, "an array of another version" },
        { nsd_force(r, 99, f, NULL, NSD_ONCE), NSD_DATA, "no body" },
        { nsd_force(r, -1, f, NULL, NSD_ONCE), NSD_DATA, "a negative body" },
        { nsd_force(r, 0, bad, NULL, NSD_ONCE), NSD_DATA, "a force that is nan" },
        { nsd_force(r, 0, f, NULL, (enum nsd_term)7), NSD_USAGE, "a force of no term" },
        { nsd_gravity(r, bad), NSD_DATA, "gravity that is nan" },
        { nsd_wall_force(r, 0, 1, NSD_ONCE), NSD_DATA, "a boundary without a load" },
        { nsd_wall_force(r, 77, 1, NSD_ONCE), NSD_DATA, "no boundary" },
        { nsd_wall_velocity(r, -1, f), NSD_DATA, "a negative boundary" },
        { nsd_friction(r, "ball", "cheese", 0.1), NSD_DATA, "no kind" },
        { nsd_friction(r, "ball", "wall", -1), NSD_DATA, "negative friction" },
        { nsd_add(r, &b, NULL), NSD_USAGE, "bodies without a place" },
        { nsd_add(r, &negative, NULL), NSD_DATA, "less than no bodies" },
        { nsd_remove(r, 2, ids), NSD_DATA, "a body twice" },
        { nsd_measure(r, "beauty", &(const char *){ NULL }), NSD_USAGE, "no measure" },
        { nsd_report(r, &(const char *){ NULL }), NSD_USAGE, "no report yet" },
        { nsd_save(r, "/nowhere/a.h5"), NSD_OUTPUT, "no folder" },
        { nsd_note(r, "no JSON"), NSD_DATA, "history that is no JSON" },
        { nsd_from_scene(&none, "{", NULL), NSD_DATA, "half a scene" },
        { nsd_from_scene(NULL, "{}", NULL), NSD_USAGE, "no place for the run of a scene" },
        { nsd_from_scene_file(NULL, "/nowhere"), NSD_USAGE, "of a file" },
        { nsd_from_document(NULL, "/nowhere.h5"), NSD_USAGE, "of a document" },
        { nsd_from_memory(NULL, "hello", 5), NSD_USAGE, "of memory" },
        { nsd_from_arrays(NULL, "{}", NULL, &b), NSD_USAGE, "of arrays" },
        { nsd_from_document(&none, "/nowhere.h5"), NSD_NO_INPUT, "no document" },
        { nsd_from_memory(&none, "hello", 5), NSD_DATA, "another document" },
    };
    for (size_t k = 0; k < sizeof calls / sizeof calls[0]; k++)
        ok(calls[k].got == calls[k].want, "%s: status %d", calls[k].what, calls[k].want);
    must(nsd_read(r, "force", &a), r);
    ((double *)a.data)[4] = NAN;
    ok(nsd_step(r, 1) == NSD_DATA && strstr(nsd_error(r), "body 1 is not finite"),
       "nan in the array force: %s", nsd_error(r));
    ((double *)a.data)[4] = 0;
    must(nsd_step(r, 20), r), must(nsd_step(twin, 20), twin);
    ok(same(r, twin), "and the run goes on as if nothing had been asked");
    nsd_close(&r), nsd_close(&twin), nsd_close(&none), nsd_close(NULL);
}

/* ---- calls at random ---- */

static uint64_t seed = 20260101;

static uint32_t draw(uint32_t n)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(seed >> 33) % n;
}

/* Small numbers, and now and then one that is none */
static double some(void)
{
    static const double odd[] = { 0, -0.0, 1e308, -1e308, 1e-320, NAN, INFINITY, -1 };
    return draw(20) ? 1e-3 * ((double)draw(2001) - 1000) : odd[draw(8)];
}

static const char *const words[] = {
    "tolerance",     "local",      "threads",      "warm",      "dt",      "contacts",   "forces",
    "layers",        "box",        "overlap-rule", "theta",     "1e-6",    "sbp",        "2",
    "true",          "false",      "1e-3",         "auto:0.01", "z:3",     "0,1,0,1",    "gap",
    "keep",          "project",    "0.5",          "position",  "force",   "force_once", "torque",
    "contact_force", "wall_force", "contact_body", "id",        "ball",    "wall",       "stress",
    "energy",        "all",        "displacement", "step",      "natural", "",           NULL
};
enum { WORDS = sizeof words / sizeof words[0] };

static const char *const scenes[] = {
    "{\"dt\":1e-3,\"mu\":0.3,\"bodies\":[{\"count\":4,\"radius\":0.1,\"box\":{\"x\":[-1,1],\"y\":[-"
    "1,1],\"z\":[0,null]}}],"
    "\"walls\":[{\"point\":[0,0,0],\"normal\":[0,0,1]},{\"point\":[0,0,4],\"normal\":[0,0,-1],"
    "\"load\":{\"along\":[0,0,1],\"mass\":1}}]}",
    "{\"dim\":2,\"dt\":1e-3,\"cell\":{\"lengths\":[2,2]},\"bodies\":[{\"x\":[0,0],\"radius\":0.4},{"
    "\"x\":[1,1],\"radius\":0.4}]}",
    "{\"dt\":1e-3,\"walls\":[{\"point\":[0,0,-1],\"normal\":[0,0,1]}],\"pour\":[{\"rate\":300,"
    "\"radius\":0.1,\"count\":5,"
    "\"opening\":{\"disc\":{\"center\":[0,0,3],\"normal\":[0,0,1],\"radius\":2}}}]}",
    "{\"dt\":1e-3}",
    "{",
    "{\"dt\":0}"
};

static void call(struct nsd_run **run)
{
    struct nsd_run *r = *run;
    const double x[12] = { some(), some(), some(), some(), some(), some(),
                           some(), some(), some(), some(), some(), some() };
    const int32_t id[2] = { (int32_t)draw(9) - 1, (int32_t)draw(9) - 1 };
    const char *word = words[draw(WORDS)], *other = words[draw(WORDS)], *json;
    struct nsd_array a = { .size = draw(9) ? sizeof a : draw(99) };
    double number;
    int32_t new[2];
    struct nsd_bodies b = { .size = draw(9) ? sizeof b : draw(99),
                            .n = draw(3),
                            .position = x,
                            .radius = x + 6,
                            .velocity = draw(2) ? x + 3 : NULL,
                            .mass = draw(3) ? NULL : x + 2,
                            .density = some(),
                            .material = draw(3) ? NULL : id };
    switch (draw(21)) {
    case 19:
        nsd_velocity(r, id[0], draw(3) ? x : NULL, draw(3) ? x + 3 : NULL);
        break;
    case 0:
        nsd_step(r, draw(4));
        break;
    case 1:
        nsd_step(r, (int64_t)draw(3) - 1);
        break;
    case 2:
        nsd_set(r, word, other);
        break;
    case 3:
        if (!nsd_read(r, word, &a) && a.writable && a.shape[0])
            ((double *)a.data)[draw((uint32_t)(3 * a.shape[0]))] = some();
        break;
    case 4:
        nsd_force(r, id[0], x, draw(2) ? x + 3 : NULL, (enum nsd_term)draw(3));
        break;
    case 5:
        nsd_wall_force(r, id[0], x[0], (enum nsd_term)draw(3));
        break;
    case 6:
        nsd_wall_velocity(r, id[0], x);
        break;
    case 7:
        nsd_gravity(r, draw(9) ? x : NULL);
        break;
    case 8:
        nsd_friction(r, word, other, x[0]);
        break;
    case 9:
        nsd_add(r, draw(9) ? &b : NULL, draw(2) ? new : NULL);
        break;
    case 10:
        nsd_remove(r, (int64_t)draw(4) - 1 > 2 ? 2 : draw(3), id);
        break;
    case 11:
        nsd_measure(r, word, &json);
        break;
    case 12:
        nsd_report(r, &json);
        break;
    case 13:
        nsd_number(r, word, &number);
        break;
    case 14:
        nsd_until(r, draw(2) ? x[0] * 1e-2 : x[0]);
        break;
    case 15:
        if (!draw(12)) {
            const char *path = path_of(draw(2) ? "x.h5" : "y.h5");
            if (draw(2)) remove(path);
            nsd_append(r, path);
        }
        break;
    case 16:
        if (!draw(12)) nsd_save(r, path_of("z.h5"));
        break;
    case 17:
        if (!draw(8)) nsd_finish(r);
        break;
    case 18:
        if (!draw(12)) nsd_close(run);
        break;
    default:
        if (draw(12)) break;
        nsd_close(run);
        draw(4) ? nsd_from_scene(run, scenes[draw(6)], NULL)
                : nsd_from_document(run, path_of("z.h5"));
    }
}

static void test_random(void)
{
    const int sequences = getenv("NSD_DEEP") ? 100000 : getenv("NSD_THIN") ? 100 : 2000;
    int64_t made = 0, failed = 0;
    for (int k = 0; k < sequences; k++) {
        struct nsd_run *run = NULL;
        made += !nsd_from_scene(&run, scenes[draw(6)], NULL);
        for (int calls = (int)draw(40); calls > 0; calls--) {
            call(&run);
            failed += *nsd_error(run) != 0;
        }
        nsd_close(&run);
    }
    ok(made > sequences / 2 && failed > sequences,
       "%d sequences of calls at random end in statuses", sequences);
}

/* ---- what is missing, or no number ---- */

static void test_missing(void)
{
    struct nsd_run *none = NULL, *r = scene(scenes[0]), *fresh = scene(scenes[0]);
    struct nsd_document *d = NULL, *shut = NULL;
    struct nsd_array a = { .size = sizeof a };
    const char *json;
    const double x[3] = { 0 };
    int32_t id[9] = { 0, 1, 2, 3, 0, 1, 2, 3, 0 };
    double number;
    int more;
    must(nsd_save(r, path_of("missing.h5")), r);
    must(nsd_open(&d, path_of("missing.h5")) || nsd_next(d, &more), NULL);
    const struct {
        int got, want;
        const char *what;
    } calls[] = {
        { nsd_from_scene(NULL, scenes[0], NULL), NSD_USAGE, "no place: nsd_from_scene" },
        { nsd_from_scene_file(NULL, "a"), NSD_USAGE, "no place: nsd_from_scene_file" },
        { nsd_from_document(NULL, "a"), NSD_USAGE, "no place: nsd_from_document" },
        { nsd_from_memory(NULL, "a", 1), NSD_USAGE, "no place: nsd_from_memory" },
        { nsd_from_arrays(NULL, scenes[3], NULL, NULL), NSD_USAGE, "no place: nsd_from_arrays" },
        { nsd_from_arrays(&none, NULL, NULL, NULL), NSD_USAGE, "no scene: nsd_from_arrays" },
        { nsd_from_arrays(&none, scenes[3], NULL, NULL), NSD_USAGE, "no bodies: nsd_from_arrays" },
        { nsd_set(NULL, "eps", "1"), NSD_USAGE, "no run: nsd_set" },
        { nsd_step(NULL, 1), NSD_USAGE, "no run: nsd_step" },
        { nsd_until(NULL, 1), NSD_USAGE, "no run: nsd_until" },
        { nsd_read(NULL, "force", &a), NSD_USAGE, "no run: nsd_read" },
        { nsd_number(NULL, "time", &number), NSD_USAGE, "no run: nsd_number" },
        { nsd_report(NULL, &json), NSD_USAGE, "no run: nsd_report" },
        { nsd_names(NULL, &json), NSD_USAGE, "no run: nsd_names" },
        { nsd_measure(NULL, "all", &json), NSD_USAGE, "no run: nsd_measure" },
        { nsd_force(NULL, 0, x, x, NSD_ONCE), NSD_USAGE, "no run: nsd_force" },
        { nsd_wall_force(NULL, 0, 1, NSD_ONCE), NSD_USAGE, "no run: nsd_wall_force" },
        { nsd_wall_velocity(NULL, 0, x), NSD_USAGE, "no run: nsd_wall_velocity" },
        { nsd_velocity(NULL, 0, x, x), NSD_USAGE, "no run: nsd_velocity" },
        { nsd_gravity(NULL, x), NSD_USAGE, "no run: nsd_gravity" },
        { nsd_friction(NULL, "ball", "ball", 0), NSD_USAGE, "no run: nsd_friction" },
        { nsd_add(NULL, NULL, NULL), NSD_USAGE, "no run: nsd_add" },
        { nsd_remove(NULL, 1, id), NSD_USAGE, "no run: nsd_remove" },
        { nsd_note(NULL, "{}"), NSD_USAGE, "no run: nsd_note" },
        { nsd_save(NULL, "a"), NSD_USAGE, "no run: nsd_save" },
        { nsd_append(NULL, "a"), NSD_USAGE, "no run: nsd_append" },
        { nsd_finish(NULL), NSD_USAGE, "no run: nsd_finish" },
        { nsd_report(r, NULL), NSD_USAGE, "no place for JSON: nsd_report" },
        { nsd_names(r, NULL), NSD_USAGE, "no place for JSON: nsd_names" },
        { nsd_measure(r, "all", NULL), NSD_USAGE, "no place for JSON: nsd_measure" },
        { nsd_note(r, NULL), NSD_USAGE, "no line" },
        { nsd_note(fresh, "[1]"), NSD_DATA, "a line of the history that is an array" },
        { nsd_note(fresh, "1"), NSD_DATA, "a line that is a number" },
        { nsd_note(fresh, "{\"a\":1,\"a\":2}"), NSD_DATA, "a line with a key twice" },
        { nsd_note(fresh, "{} {}"), NSD_DATA, "two objects in a line" },
        { nsd_append(r, "-"), NSD_USAGE, "a trajectory on standard output" },
        { nsd_save(r, "-"), NSD_USAGE, "a document on standard output" },
        { nsd_save(r, ""), NSD_USAGE, "a document without a path" },
        { nsd_remove(r, 9, id), NSD_DATA, "more bodies removed than there are" },
        { nsd_remove(r, INT64_MAX, id), NSD_DATA, "all numbers of bodies removed" },
        { nsd_remove(r, -1, id), NSD_USAGE, "fewer than none" },
        { nsd_open(NULL, "a"), NSD_USAGE, "no place: nsd_open" },
        { nsd_open(&shut, NULL), NSD_USAGE, "no path: nsd_open" },
        { nsd_open(&shut, "-"), NSD_USAGE, "standard input: nsd_open" },
        { nsd_next(NULL, &more), NSD_USAGE, "no document: nsd_next" },
        { nsd_next(d, NULL), NSD_USAGE, "no place: nsd_next" },
        { nsd_objects(NULL, &json), NSD_USAGE, "no document: nsd_objects" },
        { nsd_objects(d, NULL), NSD_USAGE, "no place: nsd_objects" },
        { nsd_attributes(d, NULL, &json), NSD_USAGE, "no path: nsd_attributes" },
        { nsd_attributes(d, "/none", &json), NSD_USAGE, "no such object: nsd_attributes" },
        { nsd_text(d, "/none", &json), NSD_USAGE, "no such text" },
        { nsd_text(d, "/particles/all/mass", &json), NSD_DATA, "numbers as a text" },
        { nsd_rows(d, "/particles/all/mass", 0, 5, &a), NSD_DATA, "rows beyond the last" },
        { nsd_rows(d, "/particles/all/mass", -1, 1, &a), NSD_DATA, "rows before the first" },
        { nsd_rows(d, "/particles/all/mass", INT64_MAX, 2, &a), NSD_DATA, "rows of any number" },
        { nsd_rows(d, "/particles", 0, 1, &a), NSD_USAGE, "rows of a group" },
        { nsd_rows(d, "/particles/all/mass", 0, 1, NULL), NSD_USAGE, "no array: nsd_rows" },
    };
    for (size_t k = 0; k < sizeof calls / sizeof calls[0]; k++)
        ok(calls[k].got == calls[k].want, "%s: status %d", calls[k].what, calls[k].want);
    ok(!nsd_resizes(NULL) && !none && !shut, "and there is no run, and no document");
    nsd_shut(&d), nsd_shut(&d), nsd_shut(NULL), nsd_close(&r), nsd_close(&fresh);
}

/* ---- documents as objects ---- */

static void test_documents(void)
{
    struct nsd_run *r = scene(scenes[0]);
    struct nsd_document *d;
    struct nsd_array a = { .size = sizeof a }, x = { .size = sizeof x };
    const char *path = path_of("objects.h5"), *json;
    int more = 0;
    remove(path);
    for (int k = 0; k < 3; k++) must(nsd_step(r, 5) || nsd_append(r, path), r);
    must(nsd_finish(r) || nsd_read(r, "position", &x), r);
    must(nsd_open(&d, path), NULL);
    ok(nsd_objects(d, &json) == NSD_USAGE && strstr(nsd_error(NULL), "nsd_next() comes first"),
       "nsd_open() finds no document by itself");
    must(nsd_next(d, &more) || nsd_objects(d, &json), NULL);
    ok(more &&
           strstr(json, "\"/particles/all/position/value\":{\"type\":\"f8\",\"shape\":[3,4,3]}"),
       "nsd_objects(): types and shapes");
    must(nsd_rows(d, "/particles/all/position/value", 2, 1, &a), NULL);
    ok(a.type == 'd' && a.shape[0] == 1 && a.shape[1] == 12 &&
           !memcmp(a.data, x.data, 12 * sizeof(double)),
       "nsd_rows(): a row is a frame's, and the run's own numbers");
    must(nsd_rows(d, "/particles/all/id", 1, 3, &a), NULL);
    ok(a.type == 'i' && a.rank == 1 && ((int32_t *)a.data)[2] == 3, "and numbers of 32 bits");
    must(nsd_rows(d, "/particles/all/position/step", 0, 3, &a), NULL);
    const bool wide = a.type == 'l';
    ok((wide ? ((int64_t *)a.data)[1] : ((int32_t *)a.data)[1]) == 10, "and steps");
    must(nsd_attributes(d, "/nsd", &json), NULL);
    ok(strstr(json, "\"dt\":0.001") && strstr(json, "\"gravity\":[0.0,0.0,-9.81"),
       "nsd_attributes(): numbers and lists of them");
    must(nsd_text(d, "/nsd/history", &json), NULL);
    ok(strstr(json, "\"command\":\"libnsd\"") && strchr(json, '\n'), "nsd_text(): a list of texts");
    must(nsd_next(d, &more), NULL);
    ok(!more && nsd_rows(d, "/particles/all/id", 1, 3, &a) == NSD_USAGE,
       "and there is one document");
    nsd_shut(&d);
    ok(!d && nsd_open(&d, path_of("nothing")) == 0 && nsd_next(d, &more) == NSD_NO_INPUT,
       "a file that is missing");
    nsd_shut(&d), nsd_close(&r);
}

/* ---- a step that fails ---- */

static void test_undone(void)
{
    static const char text[] =
        "{\"dt\":1e-3,\"mu\":0.3,\"bodies\":[{\"count\":4,\"radius\":0.1,\"box\":{\"x\":[-1,1],"
        "\"y\":[-1,1],\"z\":[0,null]}}],\"walls\":[{\"point\":[0,0,0],\"normal\":[0,0,1]}]}";
    struct nsd_run *r = scene(text), *twin = scene(text);
    const double huge[3] = { 1e308, 0, 0 };
    must(nsd_step(r, 50), r), must(nsd_step(twin, 50), twin);
    must(nsd_force(r, 1, huge, NULL, NSD_ONCE), r);
    const int got = nsd_step(r, 3);
    ok(got == NSD_DIVERGED && strstr(nsd_error(r), "step 51: "), "a step to infinity fails: %d, %s",
       got, nsd_error(r));
    must(nsd_force(r, 1, NULL, NULL, NSD_ONCE), r);
    const char *one = path_of("undone.h5"), *other = path_of("twin.h5");
    must(nsd_save(r, one), r), must(nsd_save(twin, other), twin);
    ok(same_files(one, other), "the run is what it was, and its document too");
    must(nsd_step(r, 50), r), must(nsd_step(twin, 50), twin);
    ok(same(r, twin), "and it goes on as its twin does");
    nsd_close(&r), nsd_close(&twin);
}

/* ---- fork() ---- */

static int status_of(pid_t child)
{
    int status = -1;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 100;
}

/* What a child does to runs and documents of its parent: 0, all is refused; and it makes its own */
static int in_child(struct nsd_run *r, struct nsd_document *d, const char *path)
{
    struct nsd_run *own;
    struct nsd_array a = { .size = sizeof a };
    alarm(60);
    if (nsd_append(r, path) != NSD_USAGE || !strstr(nsd_error(r), "copy by fork()")) return 1;
    if (nsd_step(r, 1) != NSD_USAGE || nsd_save(r, path) != NSD_USAGE) return 2;
    if (nsd_finish(r) != NSD_USAGE) return 3;
    if (d && nsd_rows(d, "/particles/all/id", 0, 1, &a) != NSD_USAGE) return 4;
    nsd_close(&r), nsd_shut(&d);
    if (nsd_from_document(&own, path_of("forked.start.h5"))) return 5;
    for (int k = 0; k < 3; k++)
        if (nsd_step(own, 1) || nsd_append(own, path_of("forked.own.h5"))) return 6;
    nsd_close(&own);
    return 0;
}

/* A trajectory that is forked between its frames; the children end as programs do, and as multiprocessing does. */
static void trajectory(const char *path, bool forks)
{
    struct nsd_run *r = scene(scenes[0]);
    struct nsd_document *d;
    struct nsd_array a = { .size = sizeof a };
    int more;
    remove(path);
    must(nsd_save(r, path_of("forked.start.h5")) || nsd_step(r, 1) || nsd_append(r, path), r);
    must(nsd_open(&d, path_of("forked.start.h5")) || nsd_next(d, &more), NULL);
    for (int k = 0; forks && k < 2; k++) {
        remove(path_of("forked.own.h5"));
        fflush(stdout);
        const pid_t child = fork();
        if (!child) {
            const int got = in_child(r, d, path);
            if (k) _exit(got);
            exit(got);
        }
        must(nsd_step(r, 1) || nsd_append(r, path), r);
        const int got = status_of(child);
        ok(!got, "a child of fork() is refused all of its parent's, and makes runs of its own: %d",
           got);
        ok(!nsd_rows(d, "/particles/all/id", 0, 1, &a), "the parent reads on");
    }
    for (int k = 0; !forks && k < 2; k++) must(nsd_step(r, 1) || nsd_append(r, path), r);
    const pid_t lives = forks ? fork() : 0;
    if (forks && !lives) pause(), _exit(0);
    must(nsd_step(r, 1) || nsd_append(r, path) || nsd_finish(r) || nsd_step(r, 1), r);
    ok(!nsd_append(r, path), "a trajectory is resumed%s: %s",
       forks ? " while a child lives that was made before its end" : "", nsd_error(r));
    if (forks) kill(lives, SIGKILL), status_of(lives);
    nsd_close(&r), nsd_shut(&d);
}

static void *saves(void *stop)
{
    struct nsd_run *r = scene(scenes[0]);
    while (!*(_Atomic int *)stop) must(nsd_save(r, path_of("busy.h5")), r);
    nsd_close(&r);
    return NULL;
}

static void test_fork(void)
{
    char one[100], other[100];
    snprintf(one, sizeof one, "%s", path_of("forked.h5"));
    snprintf(other, sizeof other, "%s", path_of("alone.h5"));
    trajectory(one, true), trajectory(other, false);
    ok(same_files(one, other), "the file has the bytes of a run that nobody forks");
    _Atomic int stop = 0;
    pthread_t thread;
    struct nsd_run *r = scene(scenes[0]);
    int bad = 0;
    pthread_create(&thread, NULL, saves, (void *)&stop);
    for (int k = 0; k < 10; k++) {
        remove(path_of("forked.own.h5"));
        fflush(stdout);
        const pid_t child = fork();
        if (!child) _exit(in_child(r, NULL, other));
        bad += status_of(child) != 0;
    }
    stop = 1;
    pthread_join(thread, NULL);
    ok(!bad, "children of a program one of whose threads is in libhdf5 make runs of their own");
    nsd_close(&r);
}

int main(void)
{
    if (!mkdtemp(folder)) return 1;
    test_forces(), test_velocities(), test_top(), test_walls(), test_places();
    test_resume(), test_lasting(), test_appends(), test_flow(), test_arrays(), test_threads(),
        test_failure(), test_endless(), test_stiffness(), test_small_steps(), test_errors(),
        test_random(), test_missing(), test_documents(), test_undone(), test_fork();
    char command[100];
    snprintf(command, sizeof command, "rm -r %s", folder);
    if (system(command)) return 1;
    return tap_done();
}
