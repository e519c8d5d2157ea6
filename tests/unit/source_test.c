/*
 * What the tool believes of the process that reads for it: a list of objects however it is cut or
 * changed, numbers of every type, and the end of that process, whichever it dies of.
 */
#include "file/child.h"
#include "file/source.h"
#include "tap.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* H5LTopen_file_image itself leaks (tap.sh); the name is LeakSanitizer's. */
const char *__lsan_default_suppressions(void); // NOLINT(bugprone-reserved-identifier)
const char *__lsan_default_suppressions(void)  // NOLINT(bugprone-reserved-identifier)
{
    return "leak:H5LTopen_file_image";
}

/* ---- lists ---- */

static const uint64_t shape[2] = { 2, 3 };
static const double six[6] = { 1, 2, 3, 4, 5, 6 };

/* A group, its attribute, a table and a text */
static struct objects make_list(void)
{
    struct objects s = { 0 };
    struct failure failure = { 0 };
    const struct object o[] = {
        { .kind = OBJECT_GROUP, .name = 3 },
        { .kind = OBJECT_NUMBERS,
          .class = 'f',
          .size = 8,
          .name = 5,
          .attribute = true,
          .data = 8 },
        { .kind = OBJECT_NUMBERS, .class = 'f', .size = 8, .rank = 2, .name = 5, .data = 48 },
        { .kind = OBJECT_TEXT, .class = 's', .size = 6, .name = 5, .data = 5 },
        { .kind = OBJECT_OTHER, .rank = OBJECT_RANK + 1, .name = 5 },
    };
    static const char *const name[] = { "/g", "/g@a", "/g/x", "/g/t", "/g/o" };
    const void *data[] = { NULL, six, six, "words", NULL };
    for (int k = 0; k < 5; k++) objects_add(&s, &o[k], shape, name[k], data[k], &failure);
    return s;
}

static bool round_trip(const struct objects *s)
{
    struct list l;
    struct failure failure = { 0 };
    unsigned char *copy = malloc(s->size);
    if (!copy) return false;
    memcpy(copy, s->bytes, s->size);
    bool good = !list_open(&l, copy, s->size, &failure) && l.count == 5;
    double x[6] = { 0 };
    const struct listed *t = list_find(&l, "/g/x"), *a = list_attribute(&l, "/g", "a");
    good = good && t && a && t->object.rank == 2 && t->shape[0] == 2 && t->shape[1] == 3 &&
           listed_numbers(t, 0, 6, COLUMN_F64, x) && !memcmp(x, six, sizeof x) &&
           listed_numbers(a, 0, 1, COLUMN_F64, x + 5) && x[5] == 1 &&
           !listed_numbers(t, 3, 4, COLUMN_F64, x) &&
           !listed_numbers(t, UINT64_MAX / 8, 1, COLUMN_F64, x) &&
           !listed_numbers(t, 0, 1, COLUMN_I32, x) && !list_find(&l, "/g@a") &&
           !list_find(&l, "/g/y") && !list_attribute(&l, "/g", "b") &&
           !list_attribute(&l, "/", "a");
    list_free(&l);
    return good;
}

/* Are all objects of these bytes within them? They lie at the end of what is allocated. */
static bool within(const unsigned char *bytes, size_t size)
{
    unsigned char *copy = malloc(size + 1);
    struct listed l;
    bool good = copy != NULL;
    if (!copy) return false;
    memcpy(copy, bytes, size);
    for (uint64_t at = 0; good && at < size;) {
        uint64_t before = at;
        if (!object_unpack(copy, size, &at, &l)) break;
        const struct object o = l.object;
        const unsigned char *d = l.data, *n = (const unsigned char *)l.path;
        good = at > before && at <= size && d >= copy && d + o.data <= copy + size && n >= copy &&
               n + o.name <= copy + size && strlen(l.path) < o.name &&
               (o.kind != OBJECT_NUMBERS || o.size <= 8);
    }
    free(copy);
    return good;
}

static void test_lists(void)
{
    struct objects s = make_list();
    ok(round_trip(&s), "a list of objects is what it was");
    bool good = true, cut = true;
    for (size_t n = 0; n <= s.size; n++) {
        struct list l;
        struct failure failure = { 0 };
        unsigned char *copy = malloc(n + 1);
        if (!copy) return;
        memcpy(copy, s.bytes, n);
        good &= within(s.bytes, n);
        if (!list_open(&l, copy, n, &failure)) cut &= l.count < 5 || n == s.size;
        list_free(&l);
    }
    ok(good && cut, "cut off anywhere, it has what is there, or is refused");
    static const unsigned char other[] = { 0, 1, 2, 3, 7, 8, 9, 16, 127, 128, 255 };
    for (size_t k = 0; k < s.size; k++)
        for (size_t i = 0; i < sizeof other; i++) {
            unsigned char was = s.bytes[k];
            s.bytes[k] = other[i];
            good &= within(s.bytes, s.size);
            s.bytes[k] = was;
        }
    ok(good, "with any byte changed, nothing of it lies elsewhere");
    free(s.bytes);
}

/* ---- numbers ---- */

__extension__ typedef __int128 whole; // holds every number of 64 bits, with sign or without

static whole least(char class, int bytes)
{
    return class == 'u' ? 0 : -((whole)1 << (8 * bytes - 1));
}

static whole most(char class, int bytes)
{
    return class == 'u' ? ((whole)1 << 8 * bytes) - 1 : ((whole)1 << (8 * bytes - 1)) - 1;
}

/* v, as an integer of this kind, read as each type: itself, or refused where it does not fit */
static bool converts(char class, int bytes, whole v)
{
    int64_t low = (int64_t)v;
    struct listed l = { .object = { .kind = OBJECT_NUMBERS,
                                    .class = class,
                                    .size = (uint32_t)bytes,
                                    .data = (uint64_t)bytes },
                        .data = &low };
    double x = 0;
    bool good = listed_numbers(&l, 0, 1, COLUMN_F64, &x) && x == (double)v;
    static const enum column_type type[] = { COLUMN_I64, COLUMN_I32, COLUMN_I8 };
    for (int k = 0; k < 3; k++) {
        int64_t i = 0;
        int size = (int)field_size(type[k]);
        bool fits = v >= least('i', size) && v <= most('i', size);
        good &= listed_numbers(&l, 0, 1, type[k], &i) == fits;
        int64_t mask = size == 8 ? -1 : ((int64_t)1 << 8 * size) - 1;
        if (fits) good &= (i & mask) == ((int64_t)v & mask);
    }
    return good;
}

static void test_numbers(void)
{
    for (int c = 0; c < 2; c++)
        for (int bytes = 1; bytes <= 8; bytes *= 2) {
            char class = "iu"[c];
            bool good = true;
            whole lo = least(class, bytes), hi = most(class, bytes);
            for (int power = 0; power < 64; power++)
                for (int d = -2; d <= 2; d++)
                    for (int sign = -1; sign <= 1; sign += 2) {
                        whole v = sign * ((whole)1 << power) + d;
                        if (v >= lo && v <= hi) good &= converts(class, bytes, v);
                    }
            good &= converts(class, bytes, lo) && converts(class, bytes, hi);
            ok(good, "%c%d: itself in every type, or refused", class, 8 * bytes);
        }
    float f[2] = { -0.25F, INFINITY };
    struct listed l = { .object = { .kind = OBJECT_NUMBERS, .class = 'f', .size = 4, .data = 8 },
                        .data = f };
    double x[2];
    int64_t i;
    ok(listed_numbers(&l, 0, 2, COLUMN_F64, x) && x[0] == -0.25 && isinf(x[1]) &&
           !listed_numbers(&l, 0, 1, COLUMN_I64, &i),
       "f32: itself as a real, refused as an integer");
}

/* ---- the process ---- */

static char path[] = "/tmp/source_test.XXXXXX";

/* The only child there is, or 0 */
static pid_t only_child(void)
{
    char name[80];
    int pid = 0;
    snprintf(name, sizeof name, "/proc/self/task/%d/children", (int)getpid());
    FILE *f = fopen(name, "r");
    if (!f) return 0;
    if (fscanf(f, "%d", &pid) != 1) pid = 0;
    fclose(f);
    return pid;
}

static void test_death(int signal, int status, const char *words)
{
    char *const file[] = { path };
    struct source *s = NULL;
    struct source_document d;
    struct failure failure = { 0 }, after = { 0 };
    bool more = false;
    bool begun =
        !source_open(&s, 1, file, &failure) && !source_next(s, &d, &more, &failure) && more;
    if (!begun) {
        ok(false, "a document is opened: %s", failure.text);
        source_close(s);
        return;
    }
    pid_t child = only_child();
    if (child <= 0) {
        printf("ok %d - death of signal %d # SKIP no list of children in /proc\n", ++tap_count,
               signal);
        source_close(s);
        return;
    }
    kill(child, signal);
    char *text = source_text(s, "", "no such attribute", &failure);
    ok(!text && failure.status == status && strstr(failure.text, words), "killed by %s: %d, %s",
       strsignal(signal), failure.status, failure.text);
    source_next(s, &d, &more, &after);
    ok(after.status == EX_DATAERR && !more, "and no longer asked: %s", after.text);
    source_close(s);
    ok(waitpid(-1, NULL, WNOHANG) < 0, "and nothing is left of it");
}

/* Two at once, closed in either order: neither waits for the other. */
static void test_two(void)
{
    char *const file[] = { path };
    for (int k = 0; k < 2; k++) {
        struct source *s[2] = { NULL, NULL };
        struct source_document d;
        struct failure failure = { 0 };
        bool more, good = true;
        for (int i = 0; i < 2; i++)
            good &= !source_open(&s[i], 1, file, &failure) &&
                    !source_next(s[i], &d, &more, &failure) && more && source_has(s[i], "/x");
        source_close(s[k]);
        good &= !source_next(s[1 - k], &d, &more, &failure) && !more;
        source_close(s[1 - k]);
        ok(good && waitpid(-1, NULL, WNOHANG) < 0, "two at once, the %s closed first",
           k ? "second" : "first");
    }
}

int main(void)
{
    test_lists();
    test_numbers();
    int fd = mkstemp(path);
    h5_start();
    hid_t file = fd < 0 ? -1 : H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hsize_t n = 6;
    struct failure failure = { 0 };
    bool made =
        file >= 0 && !h5_write(file, "/x", h5_vector(H5T_NATIVE_DOUBLE, n, six), NULL, &failure);
    ok(made && H5Fclose(file) >= 0, "a file to read");
    test_death(SIGSEGV, EX_DATAERR, "libhdf5 breaks down");
#ifdef __SANITIZE_ADDRESS__ // which takes the signal, and ends the process itself
    test_death(SIGBUS, EX_DATAERR, "libhdf5 breaks down");
#else
    test_death(SIGBUS, EX_DATAERR, "has become shorter");
#endif
    test_death(SIGXCPU, EX_DATAERR, "takes too long");
    test_death(SIGKILL, EX_SOFTWARE, "no memory?");
    test_two();
    struct source *none;
    ok(source_of_own(&none, -1, &failure) == EX_DATAERR,
       "a file that could not be opened has nothing in it");
    source_close(none);
    source_close(NULL);
    close(fd);
    unlink(path);
    return tap_done();
}
