/*
 * nsd.h: simulations by nsd in a C or C++ program. A run is made from a scene, a document or arrays; functions make its
 * steps, read its state, act on it and save it. nsd(3) describes every call.
 *
 *     struct nsd_run *run;
 *     struct nsd_array x = { sizeof x };
 *     if (nsd_from_scene_file(&run, "scene.json")) errx(1, "%s", nsd_error(NULL));
 *     if (nsd_read(run, "position", &x)) errx(1, "%s", nsd_error(run));
 *     while (!nsd_step(run, 1)) ...
 *     nsd_close(&run);
 *
 * Units are SI. Functions return 0 or a status below, and nsd_error() returns the reason. A call that fails leaves the run
 * as it was. The library prints nothing and does not end the program.
 *
 * Threads: a run, or a document, is used by one thread at a time; different threads may use different ones at once, and make them.
 * What a call returns about a run (a text, an array, a reason) belongs to the run: who shares a run between threads copies it
 * under the lock that keeps the other threads out. nsd_version() and nsd_array_name() may be called at any time.
 *
 * fork(): runs and documents belong to the process that made them. In a child their calls are refused (NSD_USAGE), the child does not
 * touch their files, and it may make its own.
 *
 * The interface is stable: later versions add functions, names and members at the end of structs. The program sets
 * `size` to the size of a struct, by which the library determines which members exist.
 */
#ifndef NSD_H
#define NSD_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

struct nsd_run;

/* What functions return. All but 1 are as in sysexits.h. */
enum nsd_status {
    NSD_DONE = 0,
    NSD_DIVERGED =
        1, /* the solve of a step diverged, or its result is not finite: the bodies have not moved */
    NSD_USAGE =
        64, /* an option, name or run does not exist, or is another process's; a pointer is missing */
    NSD_DATA =
        65, /* a number is out of range, a body does not exist, a document or scene is invalid */
    NSD_NO_INPUT = 66, /* a file cannot be opened */
    NSD_SOFTWARE = 70, /* memory is exhausted */
    NSD_OUTPUT = 74    /* a file cannot be written */
};

/* The version, for example "2.0" */
const char *nsd_version(void);
/* The reason for the failure of the last call with this run, "" if it succeeded. NULL: of the last call of this thread
   without a run. Valid until the next call. */
const char *nsd_error(const struct nsd_run *run);

/* ---- a run ---- */

/* Bodies as arrays with one row per body. An array that is NULL stands for zeros, unless its comment has another default. */
struct nsd_bodies {
    size_t size; /* sizeof(struct nsd_bodies) */
    int64_t n;
    const double *position;         /* [n][3] m; required */
    const double *radius;           /* [n] m; required */
    const double *orientation;      /* [n][4] unit quaternions w, x, y, z; NULL: 1, 0, 0, 0 */
    const double *velocity;         /* [n][3] m/s */
    const double *angular_velocity; /* [n][3] rad/s */
    const double *mass;             /* [n] kg; 0: fixed; NULL: computed from density */
    const double *inertia;          /* [n] kg m^2; NULL: that of solid balls, in 2D of discs */
    const int32_t
        *material;  /* [n] number of the material: 0 "ball", 1 "wall", then as in the scene */
    double density; /* kg/m^3, in 2D kg/m^2; required if mass is NULL */
};

/*
 * These functions make a run, which nsd_close() frees. On failure *run is NULL, and nsd_error(NULL) returns the reason.
 * scene: JSON [nsd-scene(5)]; file names in it are relative to folder (NULL: the current one). document [nsd-format(5)]:
 * the run begins with its last frame. arrays: the scene has no bodies, and the arrays are its bodies.
 */
int nsd_from_scene(struct nsd_run **run, const char *text, const char *folder);
int nsd_from_scene_file(struct nsd_run **run, const char *path);
int nsd_from_document(struct nsd_run **run, const char *path);
int nsd_from_memory(struct nsd_run **run, const void *document, size_t size);
int nsd_from_arrays(struct nsd_run **run, const char *scene, const char *folder,
                    const struct nsd_bodies *bodies);
/* Finishes a trajectory begun by nsd_append(), frees *run, if any, and sets it to NULL. */
void nsd_close(struct nsd_run **run);

/*
 * Sets an option by its long name in nsd-step(1), without dashes: "tolerance", "local", "threads", "warm" ("true" or
 * "false"), "dt" ...; "contacts" and "forces": whether saved frames contain them; "compare": whether reactions of small
 * steps are compared with converged ones in each step; and the options of nsd-stat(1) for
 * nsd_measure(): "box", "layers", "point", "plane", "radius", "bins", "distance", "tracer", "sample".
 */
int nsd_set(struct nsd_run *run, const char *option, const char *value);

/* Makes n steps; or steps until the time is t (s). */
int nsd_step(struct nsd_run *run, int64_t n);
int nsd_until(struct nsd_run *run, double t);

/* ---- reading ---- */

struct nsd_array {
    size_t size;       /* sizeof(struct nsd_array), set by the caller */
    void *data;        /* read-only unless writable is 1 */
    const char *unit;  /* for example "m s-1"; "1" for none */
    int64_t shape[2];  /* number of rows; numbers per row */
    int64_t stride[2]; /* bytes from row to row, from number to number */
    int32_t rank;      /* 1 or 2 dimensions */
    char type;         /* 'd' double, 'i' int32_t, 'b' int8_t; of documents also 'l' int64_t */
    char writable;     /* 1: numbers written there take effect */
};

/*
 * nsd_read() describes an array by its name. The names are nsd_array_name(0), (1) ... up to NULL. Arrays of bodies are the
 * run's own, without a copy: they stay at their addresses, and show the current state, until bodies are added or
 * removed, by nsd_add(), nsd_remove() or, if nsd_resizes() returns 1, by steps. Arrays of contacts, walls and
 * the periodic cell are of the last step, and valid until the next step or until they are read again.
 */
int nsd_read(struct nsd_run *run, const char *name, struct nsd_array *array);
const char *nsd_array_name(int k);
/* 1: steps may add and remove bodies, because the scene has inlets or outlets */
int nsd_resizes(const struct nsd_run *run);

/* *x = a number by its name: "step", "time" (s), "dt" (s), "dim", "bodies", "walls", "contacts"; for the last step
   "sweeps", "converged", "error" (of its criterion), "natural", "max_overlap" (m), "max_penetration" (m/s),
   "kinetic_energy" (J) and "seconds" of its solve, which are nan before the first step. */
int nsd_number(struct nsd_run *run, const char *name, double *x);
/* The report of the last solve as JSON, with the keys of nsd-info(1), and of them "account", the account of all steps.
   NSD_USAGE: no step was made. The text is valid until
   the next call of nsd_report(), nsd_failure(), nsd_names() or nsd_measure(). */
int nsd_report(struct nsd_run *run, const char **json);
/* Which of this run's steps failed their account [nsd-step(1)], in words: "2 steps not converged (first step 7, wall 1 and
   body 0)"; "": none. Valid as the text of nsd_report() */
int nsd_failure(struct nsd_run *run, const char **text);
/* {"materials": [NAME, ...], "shapes": [...], "walls": [NAME or null, ...], "groups": [...], "named": {NAME: [WALL, ...], ...}}, in
   their order; named: the numbers of the walls that have the name, or a part that has it. Valid as the text of nsd_report() */
int nsd_names(struct nsd_run *run, const char **json);
/* The measures "A,B,..." or "all" as a line of nsd-stat(1); valid as the text of nsd_report() */
int nsd_measure(struct nsd_run *run, const char *names, const char **json);

/* ---- acting ---- */

enum nsd_term {
    NSD_ONCE,   /* in the next step */
    NSD_LASTING /* until it is changed */
};

/* Applies a force (N) and a torque (N m), in the axes of space, to the body with this id; replaces the earlier ones of the same
   term; NULL: 0. The arrays "force", "torque", "force_once" and "torque_once" of nsd_read() hold these of all bodies. */
int nsd_force(struct nsd_run *run, int32_t id, const double force[3], const double torque[3],
              enum nsd_term term);
/* Adds a force (N) along the axis of the wall's load, or a torque (N m) about it, to the load */
int nsd_wall_force(struct nsd_run *run, int32_t wall, double force, enum nsd_term term);
/* Prescribes the wall's velocity (m/s) from now on */
int nsd_wall_velocity(struct nsd_run *run, int32_t wall, const double velocity[3]);
/* Sets the velocity (m/s) and the angular velocity (rad/s), in the axes of space, of the body with this id; NULL: unchanged */
int nsd_velocity(struct nsd_run *run, int32_t id, const double velocity[3],
                 const double angular_velocity[3]);
int nsd_gravity(struct nsd_run *run, const double gravity[3]); /* m/s^2 */
/* Sets the coefficient of friction between two materials, by their names */
int nsd_friction(struct nsd_run *run, const char *material, const char *other, double mu);
/* Adds bodies; id[bodies->n] (NULL: not returned): their new ids. Removes the bodies id[n]. */
int nsd_add(struct nsd_run *run, const struct nsd_bodies *bodies, int32_t *id);
int nsd_remove(struct nsd_run *run, int64_t n, const int32_t *id);

/* ---- saving ---- */

/* Sets the run's line in the history of its documents, a JSON object in one line, instead of the library's own; call it before the
   first document is written */
int nsd_note(struct nsd_run *run, const char *line);
/* Writes a document of the current state; replaces a file at `path` when the document is complete */
int nsd_save(struct nsd_run *run, const char *path);
/* Appends a frame to the trajectory at `path`. The first call begins the file, or resumes an existing one; nsd_finish()
   ends it. A run writes one trajectory at a time. NSD_DATA: the file belongs to another scene, has this step or a later
   one already, or is damaged; NSD_OUTPUT: another program or run is writing it */
int nsd_append(struct nsd_run *run, const char *path);
int nsd_finish(struct nsd_run *run);

/* ---- documents ---- */

/*
 * The documents of a file [nsd-format(5)], one after another, as groups, datasets and attributes under their paths
 * ("/particles/all/mass"; "" is the root). A process of its own reads them, with bounds on its memory and time, and checks them
 * first as the tools do: checksums, sizes, no links and no data outside the file (NSD_DATA). Reasons are those of
 * nsd_error(NULL).
 */
struct nsd_document;

/* Opens the file, in which nsd_next() finds the first document; nsd_shut() closes it. */
int nsd_open(struct nsd_document **document, const char *path);
void nsd_shut(struct nsd_document **document);
/* Goes to the next document; *more = 0: there is none. */
int nsd_next(struct nsd_document *document, int *more);
/* {PATH: {"type": TYPE, "shape": [ROWS, ...]}, ...} of all objects. TYPE: "group"; numbers "f8", "i4", "u1" ...; "s" text;
   "other". Texts are valid until the next call of one of these three functions. */
int nsd_objects(struct nsd_document *document, const char **json);
/* {NAME: VALUE or [VALUE, ...], ...} of an object; null: a number that is not finite, or what is neither number nor text */
int nsd_attributes(struct nsd_document *document, const char *path, const char **json);
/* A text; of a list of texts each with a newline behind it */
int nsd_text(struct nsd_document *document, const char *path, const char **text);
/* Rows first .. first+n-1 of a dataset of numbers, of a single number row 0. A row holds all its numbers, of however many
   dimensions. The array is valid until the next call of this function. */
int nsd_rows(struct nsd_document *document, const char *path, int64_t first, int64_t n,
             struct nsd_array *array);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
