/* api/save.c: a run as documents. */
#include "api/run.h"
#include "io/boundary_tables.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

int nsd_note(struct nsd_run *r, const char *line)
{
    struct why *why = run_why(r);
    if (!why) return NSD_USAGE;
    if (!line || strchr(line, '\n')) return why_set(why, NSD_USAGE, "the history has lines");
    if (r->noted) return why_set(why, NSD_USAGE, "the run has its line in the history already");
    json_t *j = json_loads(line, 0, NULL);
    if (!j) return why_set(why, NSD_DATA, "a line of the history is a JSON object");
    json_decref(j);
    if (!frame_note(&r->f, line, why)) r->noted = true;
    return why->status;
}

/* What is wanted before it: the options, forces of the bodies that there are, and the library's line of history
   unless there is one */
static int prepare(struct nsd_run *r, struct why *why)
{
    static const char line[] =
        "{\"command\":\"libnsd\",\"version\":\"" NSD_VERSION "\",\"options\":{}}";
    if (run_choose(r, why) || (r->acts.id && acts_arrays(&r->acts, &r->f.packing, why)))
        return why->status;
    if (!r->noted && !frame_note(&r->f, line, why)) r->noted = true;
    return why->status;
}

/* What the run was before it was to be written */
struct before {
    bool noted;
    size_t length; /* of its history */
};

static struct before before(const struct nsd_run *r)
{
    return (struct before){ r->noted, r->f.history ? strlen(r->f.history) : 0 };
}

/* It could not be: its history is what it was. */
static int back(struct nsd_run *r, struct before was)
{
    r->noted = was.noted;
    if (r->f.history) r->f.history[was.length] = 0;
    return r->why.status;
}

/* The frame as it is written: nsd-step's, with the forces that last, borrowed */
static struct frame frame_of(const struct nsd_run *r)
{
    struct frame f = r->f;
    f.packing.outside.lasts = acts_lend(&r->acts, f.packing.walls);
    f.detected = f.detected && f.moved && (r->contacts || r->forces);
    f.forces = r->forces;
    return f;
}

int nsd_save(struct nsd_run *r, const char *path)
{
    struct why *why = run_why(r);
    struct writer *out = NULL;
    if (!why) return NSD_USAGE;
    if (!path) return why_set(why, NSD_USAGE, "a document has a path");
    const struct before was = before(r);
    if (prepare(r, why)) return back(r, was);
    const struct frame f = frame_of(r);
    run_lock();
    if (writer_open(&out, path, WRITER_COPY, why) || writer_frame(out, &f, why))
        writer_drop(out);
    else
        writer_close(out, why);
    run_unlock();
    return why->status ? back(r, was) : 0;
}

/* The trajectory ends as it is. */
static void drop(struct nsd_run *r)
{
    run_lock();
    writer_drop(r->out);
    run_unlock();
    free(r->path);
    r->out = NULL, r->path = NULL;
}

static int open_trajectory(struct nsd_run *r, const char *path, struct why *why)
{
    if (!(r->path = strdup(path))) return why_set(why, NSD_SOFTWARE, "no memory for a path");
    run_lock();
    if (writer_open(&r->out, r->path, WRITER_TRAJECTORY, why)) writer_drop(r->out), r->out = NULL;
    run_unlock();
    if (!r->out) free(r->path), r->path = NULL;
    r->other_bodies = false;
    return why->status;
}

int nsd_append(struct nsd_run *r, const char *path)
{
    struct why *why = run_why(r);
    if (!why) return NSD_USAGE;
    if (!path) return why_set(why, NSD_USAGE, "a trajectory has a path");
    if (r->out && strcmp(r->path, path) != 0)
        return why_set(why, NSD_USAGE, "%.100s is not finished: nsd_finish() comes before another",
                       r->path);
    if (r->out && r->other_bodies)
        return why_set(why, NSD_DATA,
                       "%.100s: bodies were added or removed since its first frame: "
                       "nsd_finish() ends it, and another one may begin",
                       path);
    const bool moves = boundary_tables_move(&r->f.packing);
    if (r->out && r->rests && moves)
        return why_set(why, NSD_DATA,
                       "%.100s: a boundary moves, and in its first frame none could: "
                       "nsd_finish() ends it, and "
                       "another one may begin",
                       path);
    const struct before was = before(r);
    if (prepare(r, why)) return back(r, was);
    r->rests = r->out ? r->rests : !moves && !r->f.packing.outside.steered;
    if (!r->out && open_trajectory(r, path, why)) return back(r, was);
    const struct frame f = frame_of(r);
    run_lock();
    int failed = writer_frame(r->out, &f, why);
    run_unlock();
    if (failed) return drop(r), back(r, was);
    r->f.packing.events.n = 0; // they are written
    return 0;
}

int nsd_finish(struct nsd_run *r)
{
    struct why *why = run_why(r);
    if (!why) return NSD_USAGE;
    if (!r->out) return 0;
    run_lock();
    writer_close(r->out, why);
    run_unlock();
    free(r->path);
    r->out = NULL, r->path = NULL;
    return why->status;
}
