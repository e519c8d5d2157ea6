/*
 * nsd.h: runs of nsd in a program of one's own: made from a scene, a document or arrays, stepped, read, acted on and
 * saved. nsd(3) describes every call.
 *
 *     struct nsd_run *run;
 *     struct nsd_array x = { sizeof x };
 *     if (nsd_from_scene_file(&run, "scene.json")) errx(1, "%s", nsd_error(NULL));
 *     if (nsd_read(run, "position", &x)) errx(1, "%s", nsd_error(run));
 *     while (!nsd_step(run, 1)) ...
 *     nsd_close(&run);
 *
 * Units are SI. Functions return 0 or a status below, and nsd_error() has the reason. After a failure the run is what it was
 * before the call. The library prints nothing and ends no program. A run belongs to one thread at a time; different
 * runs may be used by different threads at once.
 *
 * The interface is stable: later versions add functions, names and members at the end of structs, whose `size` says
 * which the program knows.
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

/* What functions return: those of sysexits.h, but for 1 */
enum nsd_status {
    NSD_DONE = 0,
    NSD_DIVERGED = 1, /* the solve of a step diverged: the bodies have not moved */
    NSD_USAGE = 64,   /* no such option, name or run */
    NSD_DATA =
        65, /* a number out of range, a body that there is not, a document or scene with a mistake */
    NSD_NO_INPUT = 66, /* a file cannot be opened */
    NSD_SOFTWARE = 70, /* no memory */
    NSD_OUTPUT = 74    /* a file cannot be written */
};

/* "1.0" */
const char *nsd_version(void);
/* Why the last function that failed with this run did so; NULL: the last of this thread that had no run. "" where none
   has. Until the next call. */
const char *nsd_error(const struct nsd_run *run);

/* ---- a run ---- */

/* Bodies as arrays, a row each. Those that may be NULL are 0, but for what is said. */
struct nsd_bodies {
    size_t size; /* sizeof(struct nsd_bodies) */
    int64_t n;
    const double *position;         /* [n][3] m; needed */
    const double *radius;           /* [n] m; needed */
    const double *orientation;      /* [n][4] unit quaternions w, x, y, z; NULL: 1, 0, 0, 0 */
    const double *velocity;         /* [n][3] m/s */
    const double *angular_velocity; /* [n][3] rad/s */
    const double *mass;             /* [n] kg; 0: fixed; NULL: of the density */
    const double *inertia;          /* [n] kg m^2; NULL: of solid balls, in the plane discs */
    const int32_t *kind; /* [n] of material, by its place in the scene: 0 "ball", 1 "wall" ... */
    double density;      /* kg/m^3, in the plane kg/m^2; wanted where mass is NULL */
};

/*
 * A new run, which nsd_close() frees; on failure *run is NULL, and nsd_error(NULL) has the reason. A scene is JSON
 * [nsd-gen(1)]; names in it are relative to folder (NULL: to the current one). A document [nsd-format(5)]
 * gives its last frame. Arrays give the bodies of a scene that has none.
 */
int nsd_from_scene(struct nsd_run **run, const char *text, const char *folder);
int nsd_from_scene_file(struct nsd_run **run, const char *path);
int nsd_from_document(struct nsd_run **run, const char *path);
int nsd_from_memory(struct nsd_run **run, const void *document, size_t size);
int nsd_from_arrays(struct nsd_run **run, const char *scene, const char *folder,
                    const struct nsd_bodies *bodies);
/* Frees *run, if any, and sets it to NULL. What nsd_append() has begun is finished. */
void nsd_close(struct nsd_run **run);

/*
 * An option by its name and value, as nsd-step(1) has them without --: "eps", "method", "threads", "warm" ("true" or
 * "false"), "dt" ...; "contacts" and "forces" of what is saved; and those of nsd-stat(1) for nsd_measure(): "box",
 * "layers", "point", "plane", "radius", "bins", "distance", "tracer", "sample".
 */
int nsd_set(struct nsd_run *run, const char *option, const char *value);

/* n steps; or steps until the time is t (s). */
int nsd_step(struct nsd_run *run, int64_t n);
int nsd_until(struct nsd_run *run, double t);

/* ---- reading ---- */

struct nsd_array {
    size_t size;       /* sizeof(struct nsd_array), set by the caller */
    void *data;        /* only to be read unless writable */
    const char *unit;  /* "m s-1"; "1" without */
    int64_t shape[2];  /* rows; numbers of a row */
    int64_t stride[2]; /* bytes from row to row, from number to number */
    int32_t rank;      /* 1 or 2 dimensions */
    char type;         /* 'd' double, 'i' int32_t, 'b' int8_t */
    char writable;     /* 1: what is written there acts */
};

/*
 * An array by its name, nsd_array_name(0), (1) ... up to NULL. Those of bodies are the run's own, without a copy: they
 * stay where they are, and show what there is, until bodies are added or removed, by nsd_add(), nsd_remove() or, where
 * nsd_resizes(), by steps. Those of contacts and boundaries are of the last step, until the next, or until they are read
 * again.
 */
int nsd_read(struct nsd_run *run, const char *name, struct nsd_array *array);
const char *nsd_array_name(int k);
/* 1: steps may add and remove bodies, for the scene pours or removes */
int nsd_resizes(const struct nsd_run *run);

/* "step", "time" (s), "dt" (s), "dim", "bodies", "boundaries", "contacts"; of the last step "sweeps", "converged", "error" (of
   its criterion), "natural", "max_overlap" (m), "max_penetration" (m/s), "kinetic_energy" (J) and "seconds" of its
   solve. nan: there is none yet. */
int nsd_number(struct nsd_run *run, const char *name, double *x);
/* The report of the last solve as JSON, with the keys of nsd-info(1); until the next call. NSD_USAGE: no step was made. */
int nsd_report(struct nsd_run *run, const char **json);
/* {"kinds": [NAME, ...], "shapes": [...], "walls": [NAME or null, ...], "groups": [...]}, in their order; the text lasts as
   long as that of nsd_report() */
int nsd_names(struct nsd_run *run, const char **json);
/* Measures "A,B,..." or "all" as a line of nsd-stat(1); until the next call */
int nsd_measure(struct nsd_run *run, const char *names, const char **json);

/* ---- acting ---- */

enum nsd_term {
    NSD_ONCE,   /* in the next step */
    NSD_LASTING /* until it is changed */
};

/* N, N m, in space: on the body with this id, in place of what acts on it for so long; NULL: 0. The arrays "force", "torque",
   "force_once" and "torque_once" of nsd_read() are the same for all bodies. */
int nsd_force(struct nsd_run *run, int32_t id, const double force[3], const double torque[3],
              enum nsd_term term);
/* N along the axis of the boundary's load, N m about it: added to the load */
int nsd_boundary_force(struct nsd_run *run, int32_t boundary, double force, enum nsd_term term);
/* m/s: what is prescribed of its motion from now on */
int nsd_boundary_velocity(struct nsd_run *run, int32_t boundary, const double velocity[3]);
/* m/s, rad/s, in space: of the body with this id, in place of what they are; NULL: as it is */
int nsd_velocity(struct nsd_run *run, int32_t id, const double velocity[3],
                 const double angular_velocity[3]);
int nsd_gravity(struct nsd_run *run, const double gravity[3]); /* m/s^2 */
/* Between two kinds of material, by their names */
int nsd_friction(struct nsd_run *run, const char *kind, const char *other, double mu);
/* id[bodies->n], unless it is NULL, are the new bodies' ids. */
int nsd_add(struct nsd_run *run, const struct nsd_bodies *bodies, int32_t *id);
int nsd_remove(struct nsd_run *run, int64_t n, const int32_t *id);

/* ---- saving ---- */

/* The line of the run's history in documents, JSON without an end of line, in place of the library's own; before the first
   is written */
int nsd_note(struct nsd_run *run, const char *line);
/* A document of this moment, in place of what there is at `path` */
int nsd_save(struct nsd_run *run, const char *path);
/* One more frame of the trajectory at `path`, which the first call begins, or goes on with where there is a file, and
   nsd_finish() ends. One at a time. NSD_DATA: the file belongs to another scene, has this step or a later one already, or is
   damaged; NSD_OUTPUT: another program or run is writing it */
int nsd_append(struct nsd_run *run, const char *path);
int nsd_finish(struct nsd_run *run);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
