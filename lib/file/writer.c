#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): F_OFD_SETLK, memfd_create
#include "file/writer.h"

#include "base/output.h"
#include "file/frame_write.h"
#include "file/h5.h"
#include "file/roster.h"
#include "file/stream.h"
#include "state/part.h"

#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    RESERVE_LEAST =
        1 << 22,     /* bytes reserved at a time: posix_fallocate costs a tenth of a frame */
    ALIGN_FROM = 64, /* bytes: the smallest thing aligned; an index's head has 72 */
};

static const char CUT_OFF[] = "has been cut off by another program";

/* What every frame of a trajectory shares */
struct common_part {
    struct packing settings; /* owned */
    int64_t n;               /* bodies */
    /* Of a column of theirs that does not move; 0 where bodies come and go: file/roster.c sees to it */
    uint32_t crc[BODY_COLUMNS];
};

struct writer {
    int fd;
    const char *name;         /* the output's, for messages */
    bool trajectory;          /* else a stream */
    bool append;              /* opened by >>: others may append as well */
    int disk;                 /* a trajectory's file, opened again: > opens it for writing only */
    int library;              /* the same, opened by libhdf5; -1: not yet, or it is closed */
    struct table_write doc;   /* a trajectory's datasets; file -1 before the first frame */
    struct common_part first; /* what its first frame has set */
    struct roster roster;     /* its bodies, where they come and go */
    bool contacts, solved, moved; /* does it have contacts yet, and which kind */
    int64_t step;                 /* of the last frame */
    int64_t frames;               /* that are finished */
    off_t end;                    /* of the file, at the last flush */
    off_t start, size;            /* of a stream's document in hand; start -1: of a pipe */
    struct output file[2];        /* two, because writer_begin makes one before */
    struct output *output;        /* the file; NULL: standard output */
    struct output *begun;         /* the one that has its place until there is a frame; or NULL */
    bool waits;                   /* it takes its place when it is told to, or closed */
    bool linked;                  /* the file had a name when it was opened */
    struct vtkhdf *vtk;           /* what VTK shall find in its documents; NULL: nothing */
    struct writer *next;          /* of those that are open in the program of somebody else */
};

static struct writer *writers; /* in such a program; used with the lock of libhdf5's user */

static void writer_enlist(struct writer *s)
{
    if (embedded_is()) s->next = writers, writers = s;
}

static void writer_unlist(const struct writer *s)
{
    for (struct writer **k = &writers; *k; k = &(*k)->next)
        if (*k == s) {
            *k = s->next;
            return;
        }
}

/* What is written there from now on goes into memory: nowhere. */
static void lead_away(int fd)
{
    if (fd < 0) return;
    close(fd); // then there is room for another one
    int to = memfd_create("forgotten", MFD_CLOEXEC);
    if (to < 0 || to == fd) return;
    dup3(to, fd, O_CLOEXEC);
    close(to);
}

/* The descriptor by which libhdf5 writes; -1: there is none */
static int descriptor_of(hid_t file)
{
    int *fd = NULL;
    return file >= 0 && H5Fget_vfd_handle(file, H5P_DEFAULT, (void **)&fd) >= 0 && fd ? *fd : -1;
}

void writer_forget_all(void)
{
    for (struct writer *s = writers; s; s = s->next) {
        lead_away(s->library), lead_away(s->disk);
        for (int k = 0; k < 2; k++) {
            lead_away(s->file[k].fd), lead_away(s->file[k].old);
        }
    }
    writers = NULL;
}

static int output_failed(const struct writer *s, struct failure *failure, const char *trouble)
{
    return failure_set(failure, EX_IOERR, "%s: %s", s->name, trouble);
}

/* What kind of file it is that has been opened */
static int writer_look_at(struct writer *s, enum writer_kind kind, struct failure *failure)
{
    struct stat st;
    bool regular = !fstat(s->fd, &st) && S_ISREG(st.st_mode);
    char again[40];
    s->append = fcntl(s->fd, F_GETFL) & O_APPEND;
    s->linked = regular && st.st_nlink;
    if (!s->append && output_lock(s->fd, F_OFD_SETLK, s->name, failure)) return failure->status;
    if (isatty(s->fd))
        return failure_set(failure, EX_USAGE,
                           "%s is a terminal: documents are binary, use > FILE or a pipe", s->name);
    snprintf(again, sizeof again, "/proc/self/fd/%d", s->fd);
    if (regular && !st.st_size && !s->append && kind != WRITER_STREAM)
        s->disk = open(again, O_RDWR | O_CLOEXEC);
    s->trajectory = s->disk >= 0;
    return 0;
}

int writer_open(struct writer **out, const char *path, enum writer_kind kind,
                struct failure *failure)
{
    struct writer *s = *out = calloc(1, sizeof *s);
    if (!s) return failure_set(failure, EX_SOFTWARE, "no memory");
    h5_start();
    s->doc.file = s->disk = s->library = -1;
    for (int k = 0; k < 2; k++) s->file[k].fd = s->file[k].old = -1;
    writer_enlist(s);
    s->name = path ? path : "standard output";
    s->fd = STDOUT_FILENO;
    if (!path) return writer_look_at(s, kind, failure);
    if (kind == WRITER_IN_PLACE && access(path, F_OK))
        return output_failed(s, failure, strerror(errno));
    s->output = &s->file[0];
    if (output_open(s->output, path, failure)) return failure->status;
    s->fd = s->output->fd;
    s->waits = kind == WRITER_IN_PLACE || kind == WRITER_STREAM ||
               (kind == WRITER_COPY && s->output->old >= 0);
    if (kind == WRITER_IN_PLACE && s->output->old < 0)
        return output_failed(s, failure, "not a regular file");
    return writer_look_at(s, kind, failure);
}

int writer_take_place(struct writer *s, struct failure *failure)
{
    if (fsync(s->fd)) return output_failed(s, failure, strerror(errno)); // before the old one goes
    s->waits = false;
    return output_place(s->output, failure);
}

static int64_t bodies_of(const struct frame *f)
{
    return f->distributed ? f->distributed->n : f->packing.n;
}

/* The numbers of bodies that others have */
static int writer_fill(struct table_write *t, const char *path, struct failure *failure)
{
    int places = t->places;
    t->places = 0;
    return t->distributed
               ? t->distributed->give(t->distributed, t->file, path, t->place, places, failure)
               : 0;
}

/* Where another process finds the trajectory */
static bool find_path(const struct writer *s, char path[PATH_MAX])
{
    char link[40];
    snprintf(link, sizeof link, "/proc/self/fd/%d", s->disk);
    ssize_t n = readlink(link, path, PATH_MAX - 1);
    if (n > 0) path[n] = 0;
    return n > 0;
}

static hid_t writer_create(const char *path, hid_t access)
{
    hid_t plist = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_userblock(plist, DOCUMENT_USERBLOCK);
    H5Pset_obj_track_times(plist, false);
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, plist, access);
    H5Pclose(plist);
    return file;
}

/* There is something whole in it. */
static int writer_is_there(struct writer *s, struct failure *failure)
{
    if (s->waits || (s->output && output_place(s->output, failure))) return failure->status;
    if (s->begun) output_keep(s->begun);
    s->begun = NULL;
    return 0;
}

/* ---- a stream ---- */

/* A document begins: others that append wait, so that documents stay whole. */
static int document_begin(struct writer *s, struct failure *failure)
{
    if (s->append && output_lock(s->fd, F_OFD_SETLKW, s->name, failure)) return failure->status;
    s->start = lseek(s->fd, 0, s->append ? SEEK_END : SEEK_CUR);
    s->size = 0;
    return 0;
}

/* More of its bytes. On failure a regular file is cut back to what it was. */
static int document_bytes(void *to, const void *bytes, size_t size, struct failure *failure)
{
    struct writer *s = to;
    for (size_t done = 0; done < size;) {
        ssize_t n = write(s->fd, (const char *)bytes + done, size - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            output_failed(s, failure, strerror(errno));
            if (s->start >= 0 && ftruncate(s->fd, s->start)) return failure->status;
            return failure->status;
        }
        done += (size_t)n;
    }
    s->size += (off_t)size;
    return 0;
}

static int document_end(struct writer *s, struct failure *failure)
{
    struct stat st;
    if (s->append) output_unlock(s->fd);
    if (s->start >= 0 && !fstat(s->fd, &st) && S_ISREG(st.st_mode) &&
        st.st_size < s->start + s->size)
        return output_failed(s, failure, CUT_OFF);
    return 0;
}

static int writer_write_all(struct writer *s, const unsigned char *bytes, size_t size,
                            struct failure *failure)
{
    return document_begin(s, failure) || document_bytes(s, bytes, size, failure) ||
                   document_end(s, failure)
               ? failure->status
               : 0;
}

int64_t writer_size(const struct writer *s)
{
    struct stat st;
    return fstat(s->fd, &st) || !S_ISREG(st.st_mode) ? 0 : (int64_t)st.st_size;
}

bool writer_passes(const struct writer *s)
{
    return !s->trajectory && !s->vtk;
}

int writer_vtk(struct writer *s, const struct vtkhdf_parts *parts, struct failure *failure)
{
    return vtkhdf_begin(&s->vtk, parts, failure);
}

/* What VTK finds of a frame that the document has, which is its last where no others follow */
static int for_vtk(struct writer *s, hid_t file, const struct frame *f, bool last,
                   struct failure *failure)
{
    if (!s->vtk || !f->packed) return 0;
    if (f->distributed)
        return failure_set(failure, EX_USAGE,
                           "several processes make no /VTKHDF: nsd-cat --vtk does, after");
    return vtkhdf_frame(s->vtk, file, &f->packing, failure) ||
           (last && vtkhdf_end(s->vtk, file, failure));
}

int writer_pass(struct writer *s, struct reader *from, struct failure *failure)
{
    if (document_begin(s, failure)) return failure->status;
    if (reader_pour(from, document_bytes, s, failure)) {
        // a reader that broke down half-way leaves no half a document in a file
        if (s->start >= 0 && ftruncate(s->fd, s->start)) return failure->status;
        return failure->status;
    }
    return document_end(s, failure) || writer_is_there(s, failure) ? failure->status : 0;
}

/* Writes a document of the core driver straight from libhdf5's memory, with its header. */
static int write_image(struct writer *s, hid_t file, struct failure *failure)
{
    void **memory;
    bool flushed = H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0;
    ssize_t image = flushed ? H5Fget_file_image(file, NULL, 0) : -1; // without the user block
    if (image < 0 || H5Fget_vfd_handle(file, H5P_DEFAULT, (void **)&memory) < 0)
        return failure_set(failure, EX_SOFTWARE, "no memory for the document");
    size_t size = (size_t)image + DOCUMENT_USERBLOCK;
    unsigned char *bytes = *memory;
    uint32_t crc = document_crc(0, bytes + DOCUMENT_USERBLOCK, size - DOCUMENT_USERBLOCK);
    document_header(bytes, size, crc);
    return writer_write_all(s, bytes, size, failure);
}

static int stream_frame(struct writer *s, const struct frame *f, struct failure *failure)
{
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    size_t step = (size_t)bodies_of(f) * 32;
    H5Pset_fapl_core(access, step < 1 << 16 ? 1 << 16 : step, false);
    struct table_write doc = { .file = writer_create("document", access),
                               .distributed = f->distributed };
    H5Pclose(access);
    if (doc.file < 0) return failure_set(failure, EX_SOFTWARE, "no memory for the document");
    int e = frame_write_static(&doc, f, failure) || frame_write_moment(&doc, f, failure) ||
            frame_write_step(&doc, f, failure) ||
            (f->export && f->write_export(f->export, f->export_global, doc.file, failure)) ||
            (f->foreign && f->u &&
             fclib_store_solution(&f->problem, doc.file, f->u, f->problem.W.r, failure)) ||
            writer_fill(&doc, NULL, failure) || for_vtk(s, doc.file, f, true, failure) ||
            write_image(s, doc.file, failure);
    H5Fclose(doc.file);
    return e ? failure->status : 0;
}

/*
 * ---- a trajectory ----
 *
 * At every moment a reader finds the finished frames, so also after the writer was killed:
 * - numbers go straight to the disk (file/tables.c); a flush writes their shapes and places, and
 *   a frame's step is flushed after everything else;
 * - places are kept in the chunk index of HDF5 1.10, in which no entry ever moves (the older B-tree
 *   is split now and then);
 * - every flush first writes where the file will end;
 * - a kill can end a write between two pages of the file and leave a block that contradicts its
 *   checksum. What HDF5 rewrites in place therefore begins at a multiple of 512 bytes and, up to
 *   that length, lies within one page.
 */

/* All of it, however often the system stops half-way */
static bool write_at(const struct writer *s, const unsigned char *bytes, size_t size, off_t at)
{
    for (size_t done = 0; done < size;) {
        ssize_t n = pwrite(s->disk, bytes + done, size - done, at + (off_t)done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        done += (size_t)n;
    }
    return true;
}

/* The other way round; false also where the file ends before. */
static bool read_at(const struct writer *s, unsigned char *bytes, size_t size, off_t at)
{
    for (size_t done = 0; done < size;) {
        ssize_t n = pread(s->disk, bytes + done, size - done, at + (off_t)done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        done += (size_t)n;
    }
    return true;
}

/* Is what was written still there? A shell's > f cuts f off, and what HDF5 writes then leaves holes. */
static bool still_there(const struct writer *s)
{
    unsigned char header[DOCUMENT_USERBLOCK], now[DOCUMENT_USERBLOCK];
    struct stat st;
    document_header(header, 0, 0);
    return !fstat(s->disk, &st) && st.st_size >= s->end && read_at(s, now, sizeof now, 0) &&
           !memcmp(header, now, sizeof now);
}

static int write_header(struct writer *s, uint64_t length, uint32_t crc, struct failure *failure)
{
    unsigned char header[DOCUMENT_USERBLOCK];
    document_header(header, length, crc);
    return write_at(s, header, sizeof header, 0) ? 0 : output_failed(s, failure, strerror(errno));
}

/*
 * Reserves what a frame may need on the disk before anything of it is written. HDF5 changes its
 * tables in place, so that a disk filling up half-way would cost the earlier frames too.
 */
static int reserve(struct writer *s, const struct frame *f, struct failure *failure)
{
    hsize_t size = 0, n = (hsize_t)bodies_of(f), rows = 0;
    if (H5Fget_filesize(s->doc.file, &size) < 0)
        return output_failed(s, failure, "cannot be written");
    if (n > CHUNK_BODIES) n += CHUNK_BODIES; // chunks are whole
    if (s->doc.roster) // bodies that were there before, and what their rows are rounded up to
        n += (hsize_t)s->roster.rows + 2 * s->doc.chunk_bodies;
    if (f->detected) rows = (hsize_t)f->contacts.n + CHUNK_CONTACTS;
    rows += (hsize_t)f->packing.events.n + (hsize_t)f->packing.bonds.n;
    rows += (hsize_t)f->packing.memory.n;
    // 128 bytes a body, and as many of its motion, 256 a contact, and the tables that may grow
    hsize_t frame = 256 * n + 256 * rows + (1 << 17);
    struct stat st; // HDF5 sometimes cuts the reserve off
    if (!fstat(s->disk, &st) && size + frame <= (hsize_t)st.st_size) return 0;
    // for several frames at once, where the disk has that much
    int e = posix_fallocate(s->disk, (off_t)size,
                            (off_t)(frame < RESERVE_LEAST ? RESERVE_LEAST : frame));
    if (e) e = posix_fallocate(s->disk, (off_t)size, (off_t)frame);
    return e ? output_failed(s, failure, strerror(e)) : 0;
}

/* Sets the superblock's end-of-file address, at its byte 40: readers refuse what lies beyond. */
static bool set_end(const struct writer *s, hsize_t end)
{
    unsigned char bytes[8];
    for (int k = 0; k < 8; k++) bytes[k] = (unsigned char)(end >> 8 * k);
    return write_at(s, bytes, sizeof bytes, DOCUMENT_USERBLOCK + 40);
}

/* HDF5 by itself would write the end-of-file address last. */
static int flush(struct writer *s, struct failure *failure)
{
    hsize_t size;
    bool good = H5Fget_filesize(s->doc.file, &size) >= 0 && set_end(s, size) &&
                H5Fflush(s->doc.file, H5F_SCOPE_GLOBAL) >= 0;
    s->end = (off_t)size;
    return good ? 0 : output_failed(s, failure, "cannot be written (full?)");
}

/* The checksum of a column of bodies, as far as all frames share it */
static uint32_t column_crc(const struct field *b, const struct packing *p)
{
    const void *rows = packing_varies(p) || !(b->traits & FIELD_SAME) ? NULL : field_array(b, p);
    return rows ? document_crc(1, rows, (size_t)p->n * field_bytes(b)) : 0;
}

static int common_part_init(struct common_part *o, const struct frame *f, struct failure *failure)
{
    const struct packing settings = packing_settings(&f->packing);
    packing_free(&o->settings);
    if (packing_copy(&o->settings, &settings, failure))
        return memset(o, 0, sizeof *o), failure->status;
    o->settings.pours = f->packing.pours, o->settings.removals = f->packing.removals;
    o->n = bodies_of(f);
    for (int k = 0; k < BODY_COLUMNS; k++) o->crc[k] = column_crc(&body_columns[k], &f->packing);
    return 0;
}

/* Are two scenes the same but for spaces and the order of keys? */
static bool same_scene(const char *x, const char *y)
{
    if (!x || !y || !strcmp(x, y)) return !x == !y;
    json_t *a = json_loads(x, 0, NULL), *b = json_loads(y, 0, NULL);
    bool same = a && b && json_equal(a, b);
    json_decref(a), json_decref(b);
    return same;
}

/* What is stored only with the first frame has to be true of all. */
static int writer_check_same(const struct writer *s, const struct frame *f, struct failure *failure)
{
    const struct packing *p = &s->first.settings, *q = &f->packing;
    const int64_t n = bodies_of(f);
    if (p->pours != q->pours || p->removals != q->removals)
        return failure_set(failure, EX_DATAERR, "other pours or removals than the trajectory's");
    if (!packing_varies(q) && s->first.n != n)
        return failure_set(failure, EX_DATAERR, "%lld bodies, and the trajectory has %lld",
                           (long long)n, (long long)s->first.n);
    const double dt = q->dt, first_dt = p->dt;
    if (dt != first_dt)
        return failure_set(failure, EX_DATAERR, "dt is %.15g s, and the trajectory's is %.15g s",
                           dt, first_dt);
    if (p->overlap && q->overlap && p->overlap != q->overlap) // that of a scene is not said yet
        return failure_set(failure, EX_DATAERR, "overlap differs from the trajectory's");
    if (packing_same_settings(p, q, failure)) return failure->status;
    for (int k = 0; k < BODY_COLUMNS; k++)
        if (s->first.crc[k] != column_crc(&body_columns[k], q))
            return failure_set(failure, EX_DATAERR,
                               "other bodies than the trajectory's: their %s differs",
                               body_columns[k].name);
    if (!same_scene(p->scene, q->scene))
        return failure_set(failure, EX_DATAERR, "the scene differs from the trajectory's");
    if (f->packing.step <= s->step)
        return failure_set(failure, EX_DATAERR,
                           "step %lld after step %lld: a trajectory's steps increase",
                           (long long)f->packing.step, (long long)s->step);
    if (f->detected && s->contacts && (!f->contacts.found == s->solved || f->moved != s->moved))
        return failure_set(failure, EX_DATAERR, "contacts solved and unsolved in one trajectory");
    return 0;
}

static int trajectory_begin(struct writer *s, const struct frame *f, struct failure *failure)
{
    char path[40];
    snprintf(path, sizeof path, "/proc/self/fd/%d", s->disk);
    hid_t access = H5Pcreate(H5P_FILE_ACCESS); // no padding at the file's end
    H5Pset_file_locking(access, false, true);  // output_lock has seen to it
    H5Pset_meta_block_size(access, 0), H5Pset_small_data_block_size(access, 0);
    H5Pset_alignment(access, ALIGN_FROM, DOCUMENT_USERBLOCK); // the most that HDF5 allows
    s->doc = (struct table_write){ .file = writer_create(path, access), .growing = true };
    H5Pclose(access);
    if (s->doc.file < 0) return output_failed(s, failure, "cannot be written");
    s->library = descriptor_of(s->doc.file);
    if (embedded_is() && s->library < 0)
        return output_failed(s, failure, "cannot be kept from children");
    if (H5Fset_libver_bounds(s->doc.file, H5F_LIBVER_V110, H5F_LIBVER_V110) < 0)
        return output_failed(s, failure, "cannot be written (full?)");
    if (packing_varies(&f->packing)) {
        int64_t most, chunk;
        roster_bounds(&f->packing, &most, &chunk, failure);
        s->doc.most_bodies = (hsize_t)most, s->doc.chunk_bodies = (hsize_t)chunk;
        s->doc.roster = &s->roster;
    }
    if (failure->status || reserve(s, f, failure)) return failure->status;
    if (common_part_init(&s->first, f, failure)) return failure->status;
    s->step = f->packing.step - 1;
    s->doc.distributed = f->distributed;
    return write_header(s, 0, 0, failure) || frame_write_static(&s->doc, f, failure)
               ? failure->status
               : 0;
}

/* Processes that write together give the reserve back. */
static int fill_frame(struct writer *s, const struct frame *f, struct failure *failure)
{
    char path[PATH_MAX];
    if (!f->distributed) return 0;
    return writer_fill(&s->doc, find_path(s, path) ? path : NULL, failure) || reserve(s, f, failure)
               ? failure->status
               : 0;
}

static int trajectory_frame(struct writer *s, const struct frame *f, struct failure *failure)
{
    if (!f->packed)
        return failure_set(failure, EX_DATAERR, "an FCLIB problem does not go into a trajectory");
    bool first = s->doc.file < 0;
    if (!first && !still_there(s)) return output_failed(s, failure, CUT_OFF);
    if (first ? trajectory_begin(s, f, failure) : reserve(s, f, failure)) return failure->status;
    if (!first && writer_check_same(s, f, failure)) return failure->status;
    if (frame_write_moment(&s->doc, f, failure) || flush(s, failure) || fill_frame(s, f, failure) ||
        frame_write_step(&s->doc, f, failure) || flush(s, failure) ||
        for_vtk(s, s->doc.file, f, false, failure))
        return failure->status;
    s->step = f->packing.step, s->frames++;
    if (f->detected) s->contacts = true, s->solved = f->contacts.found, s->moved = f->moved;
    return 0;
}

static int trajectory_close(struct writer *s, struct failure *failure)
{
    hsize_t size;
    if (s->vtk && vtkhdf_end(s->vtk, s->doc.file, failure)) return failure->status;
    int failed = table_write_close(&s->doc) || H5Fget_filesize(s->doc.file, &size) < 0;
    s->library = -1;
    if (H5Fclose(s->doc.file) < 0 || failed)
        return output_failed(s, failure, "cannot be written (full?)");
    if (!still_there(s)) return output_failed(s, failure, CUT_OFF);
    struct stat st; // the reserve that was not needed is given back
    if (fstat(s->disk, &st) || (st.st_size > (off_t)size && ftruncate(s->disk, (off_t)size)))
        return output_failed(s, failure, strerror(errno));
    unsigned char buffer[1 << 16];
    uint32_t crc = 0;
    off_t at = DOCUMENT_USERBLOCK;
    ssize_t n;
    while ((n = pread(s->disk, buffer, sizeof buffer, at)) > 0 || (n < 0 && errno == EINTR)) {
        if (n < 0) continue;
        crc = document_crc(crc, buffer, (size_t)n);
        at += n;
    }
    if (n < 0) return output_failed(s, failure, strerror(errno));
    if (write_header(s, (uint64_t)at, crc, failure)) return failure->status;
    lseek(s->fd, at, SEEK_SET); // the next writer continues behind us
    return 0;
}

/* Half a first frame is nothing; HDF5 writes no more, for h5_start has told it so. */
static void trajectory_fails(const struct writer *s)
{
    if (!s->frames && ftruncate(s->disk, 0)) return; // there is nothing more that can be done
}

int writer_frame(struct writer *s, const struct frame *f, struct failure *failure)
{
    if (f->packed && packing_check(&f->packing, failure))
        return failure->status; // no reader would accept it
    if (!f->packed && s->doc.file < 0)
        s->trajectory = false; // an FCLIB problem is a document of its own
    int e = s->trajectory ? trajectory_frame(s, f, failure) : stream_frame(s, f, failure);
    if (!e) return writer_is_there(s, failure);
    if (s->trajectory) trajectory_fails(s);
    return failure->status;
}

/* The document is whole and closed, and has its place; the one with the frames will take it. */
static int begin_again(struct writer *s, struct failure *failure)
{
    if (trajectory_close(s, failure)) return failure->status;
    roster_free(&s->roster);
    s->doc = (struct table_write){ .file = -1 };
    s->frames = 0, s->contacts = false;
    if (!s->output) { // it will be written over
        s->begun = &s->file[0];
        output_borrow(s->begun, s->fd, s->name);
        return lseek(s->fd, 0, SEEK_SET) ? output_failed(s, failure, strerror(errno)) : 0;
    }
    if (output_place_for_now(s->output, failure)) return failure->status;
    output_unlock(s->fd);
    close(s->disk);
    s->begun = s->output, s->output = &s->file[1], s->disk = -1;
    if (output_open(s->output, s->name, failure)) return failure->status;
    s->fd = s->output->fd;
    return writer_look_at(s, WRITER_TRAJECTORY, failure);
}

int writer_begin(struct writer *s, const struct frame *f, struct failure *failure)
{
    bool begun = s->frames || s->waits || (s->output && s->output->old >= 0);
    if (!s->trajectory || begun) return 0;
    if (trajectory_frame(s, f, failure)) trajectory_fails(s);
    return failure->status ? failure->status : begin_again(s, failure);
}

int writer_close(struct writer *s, struct failure *failure)
{
    int e = s->doc.file >= 0 ? trajectory_close(s, failure) : 0;
    if (!e && s->linked && output_removed(s->fd))
        e = output_failed(s, failure, "another program has removed it");
    if (s->disk >= 0) close(s->disk);
    roster_free(&s->roster), vtkhdf_free(s->vtk), packing_free(&s->first.settings);
    if (s->begun) output_drop(s->begun);
    writer_unlist(s);
    if (!s->output) output_unlock(s->fd);
    if (!s->output && close(s->fd) && !e) e = output_failed(s, failure, strerror(errno));
    if (s->output && e) output_drop(s->output);
    if (s->output && !e) e = output_close(s->output, failure);
    free(s);
    return e;
}

void writer_drop(struct writer *s)
{
    if (!s) return;
    writer_unlist(s);
    if (s->doc.file >= 0) table_write_close(&s->doc), H5Fclose(s->doc.file);
    if (s->disk >= 0) close(s->disk);
    roster_free(&s->roster), packing_free(&s->first.settings);
    if (s->begun) output_drop(s->begun);
    if (s->output) output_drop(s->output);
    free(s);
}
