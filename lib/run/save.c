/* run/save.c: a run as documents. */
#include "file/reader.h"
#include "file/wall_tables.h"
#include "run/run.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

int nsd_note(struct nsd_run *r, const char *line)
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (!line || strchr(line, '\n'))
        return failure_set(failure, NSD_USAGE, "the history has lines");
    if (r->noted)
        return failure_set(failure, NSD_USAGE, "the run has its line in the history already");
    json_t *j = json_loads(line, JSON_REJECT_DUPLICATES, NULL);
    const bool object = json_is_object(j);
    json_decref(j);
    if (!object) return failure_set(failure, NSD_DATA, "a line of the history is a JSON object");
    if (!frame_note(&r->f, line, failure)) r->noted = true;
    return failure->status;
}

/* Is it the path of a file? The word that stands for standard output in the tools is none: that is the program's. */
static bool is_path(const char *path, struct failure *failure)
{
    if (!path || !*path)
        failure_set(failure, NSD_USAGE, "a document has a path");
    else if (!strcmp(path, "-"))
        failure_set(failure, NSD_USAGE,
                    "-: standard output is the program's; a file of this name is ./-");
    return !failure->status;
}

/* What is wanted before it: the options, forces of the bodies that there are, and the library's line of history
   unless there is one */
static int save_prepare(struct nsd_run *r, struct failure *failure)
{
    static const char line[] =
        "{\"command\":\"libnsd\",\"version\":\"" NSD_VERSION "\",\"options\":{}}";
    if (run_choose(r, failure) ||
        (r->driver.acts.id && control_arrays(&r->driver.acts, &r->f.packing, failure)))
        return failure->status;
    if (!r->noted && !frame_note(&r->f, line, failure)) r->noted = true;
    return failure->status;
}

/* What the run was before it was to be written */
struct save_before {
    bool noted;
    size_t length; /* of its history */
};

static struct save_before save_before(const struct nsd_run *r)
{
    return (struct save_before){ r->noted, r->f.history ? strlen(r->f.history) : 0 };
}

/* It could not be: its history is what it was. */
static int back(struct nsd_run *r, struct save_before was)
{
    r->noted = was.noted;
    if (r->f.history) r->f.history[was.length] = 0;
    return r->failure.status;
}

/* The frame as it is written: nsd-step's, with the forces that last, borrowed */
static struct frame frame_of(const struct nsd_run *r)
{
    struct frame f = r->f;
    f.packing.outside.lasts = control_lend(&r->driver.acts, f.packing.walls);
    f.detected = f.detected && f.moved && (r->contacts || r->forces);
    f.forces = r->forces;
    return f;
}

int nsd_save(struct nsd_run *r, const char *path)
{
    struct failure *failure = run_why(r);
    struct writer *out = NULL;
    if (!failure) return NSD_USAGE;
    if (!is_path(path, failure)) return failure->status;
    const struct save_before was = save_before(r);
    if (save_prepare(r, failure)) return back(r, was);
    const struct frame f = frame_of(r);
    process_lock();
    if (writer_open(&out, path, WRITER_COPY, failure) || writer_frame(out, &f, failure))
        writer_drop(out);
    else
        writer_close(out, failure);
    process_unlock();
    return failure->status ? back(r, was) : 0;
}

/* A trajectory whose walls rest has no place for their motion. */
static int check_motion(const struct nsd_run *r, struct failure *failure)
{
    if (!r->rests || !wall_tables_move(&r->f.packing)) return 0;
    return failure_set(failure, NSD_DATA,
                       "%.100s: a wall moves, and in its first frame none could: "
                       "nsd_finish() ends it, and another one may begin",
                       r->path);
}

/* The trajectory ends as it is. */
static void drop(struct nsd_run *r)
{
    process_lock();
    writer_drop(r->out);
    process_unlock();
    free(r->path);
    r->out = NULL, r->path = NULL;
}

/* The last line of a history, with its end; NULL: there is none */
static const char *last_line(const char *history)
{
    size_t n = history ? strlen(history) : 0;
    if (!n) return NULL;
    for (n--; n && history[n - 1] != '\n'; n--) continue;
    return history + n;
}

/* The history of a trajectory has the run's line, too, unless it ends with that: one run in two parts leaves what
   one in one piece does. */
static int note_again(const struct nsd_run *r, struct frame *first, struct failure *failure)
{
    const char *line = last_line(r->f.history), *had = last_line(first->history);
    if (!line || (had && !strcmp(line, had))) return 0;
    char *copy = strndup(line, strcspn(line, "\n"));
    if (!copy) return failure_set(failure, NSD_SOFTWARE, "no memory for the history");
    frame_note(first, copy, failure);
    free(copy);
    return failure->status;
}

/* May the run go on with the trajectory that begins with this frame? */
static int check_first(const struct packing *first, const struct packing *p, const char *path,
                       struct failure *failure)
{
    bool same = !first->scene == !p->scene && (!p->scene || !strcmp(first->scene, p->scene));
    if (!same || first->seed != p->seed || first->walls != p->walls ||
        first->materials != p->materials)
        return failure_set(failure, NSD_DATA,
                           "%.200s: belongs to another scene: remove it to begin again", path);
    return 0;
}

/* The frames that there are go into r->out, which takes their place later. */
static int copy_frames(struct nsd_run *r, struct reader *in, struct failure *failure)
{
    struct frame f = { 0 };
    const struct packing *p = &r->f.packing, *q = &f.packing;
    bool more, first = true;
    while (!reader_next(in, NULL, &f, &more, failure) && more) {
        const char *lost = reader_loses(in);
        if (!f.packed)
            failure_set(failure, NSD_DATA, "%.200s: an FCLIB problem, and no trajectory", r->path);
        else if (lost)
            failure_set(failure, NSD_DATA, "%.200s: %.100s is not known, and depends on time",
                        r->path, lost);
        else if (q->step >= p->step)
            failure_set(
                failure, NSD_DATA,
                "%.200s: has step %lld already, and the run is at step %lld: remove it to begin "
                "again",
                r->path, (long long)q->step, (long long)p->step);
        if (failure->status ||
            (first && (check_first(q, p, r->path, failure) || note_again(r, &f, failure))))
            break;
        if (first) r->rests = !wall_tables_move(q) && !q->outside.steered;
        first = false;
        if (writer_frame(r->out, &f, failure)) break;
    }
    if (!failure->status && first)
        failure_set(failure, NSD_DATA, "%.200s: no frame to go on from", r->path);
    frame_free(&f);
    return failure->status;
}

/* Is there a file at the path that has something in it? */
static bool save_is_there(const char *path)
{
    struct stat st;
    return !stat(path, &st) && S_ISREG(st.st_mode) && st.st_size > 0;
}

/* The trajectory of r->path, begun or with the frames that there are */
static int open_trajectory(struct nsd_run *r, bool goes_on, struct failure *failure)
{
    struct reader *in = NULL;
    if (writer_open(&r->out, r->path, goes_on ? WRITER_IN_PLACE : WRITER_TRAJECTORY, failure) ||
        !goes_on)
        return failure->status;
    if (!reader_open(&in, 1, &r->path, failure)) {
        reader_copies(in);
        copy_frames(r, in, failure);
    }
    reader_close(in);
    return failure->status;
}

/* The first frame that this run gives to the trajectory at the path */
static int first_frame(struct nsd_run *r, const char *path, struct failure *failure)
{
    const bool goes_on = save_is_there(path);
    const struct packing *p = &r->f.packing;
    if (!(r->path = strdup(path)))
        return failure_set(failure, NSD_SOFTWARE, "no memory for a path");
    r->rests = !wall_tables_move(p) && !p->outside.steered;
    r->other_bodies = false;
    const struct frame f = frame_of(r);
    process_lock();
    if (open_trajectory(r, goes_on, failure) || check_motion(r, failure) ||
        writer_frame(r->out, &f, failure) || (goes_on && writer_take_place(r->out, failure)))
        writer_drop(r->out), r->out = NULL;
    process_unlock();
    if (!r->out) free(r->path), r->path = NULL;
    return failure->status;
}

static int next_frame(struct nsd_run *r, struct failure *failure)
{
    const struct frame f = frame_of(r);
    process_lock();
    writer_frame(r->out, &f, failure);
    process_unlock();
    if (failure->status) drop(r);
    return failure->status;
}

int nsd_append(struct nsd_run *r, const char *path)
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (!is_path(path, failure)) return failure->status;
    if (r->out && strcmp(r->path, path) != 0)
        return failure_set(failure, NSD_USAGE,
                           "%.100s is not finished: nsd_finish() comes before another", r->path);
    if (r->out && r->other_bodies && !packing_varies(&r->f.packing))
        return failure_set(failure, NSD_DATA,
                           "%.100s: bodies were added or removed since its first frame: "
                           "nsd_finish() ends it, and another one may begin",
                           path);
    if (r->out && check_motion(r, failure)) return failure->status;
    const struct save_before was = save_before(r);
    if (save_prepare(r, failure)) return back(r, was);
    if (r->out ? next_frame(r, failure) : first_frame(r, path, failure)) return back(r, was);
    r->f.packing.events.n = 0; // they are written
    return 0;
}

int nsd_finish(struct nsd_run *r)
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (!r->out) return 0;
    process_lock();
    writer_close(r->out, failure);
    process_unlock();
    free(r->path);
    r->out = NULL, r->path = NULL;
    return failure->status;
}
