/*
 * run/run.h: a run as the functions of nsd.h have it, and what they share.
 */
#pragma once

#include "file/writer.h"
#include "measure/measures.h"
#include "run/driver.h"
#include "run/nsd.h"
#include "run/process.h"
#include "run/rollback.h"
#include "step/step_options.h"

/* Arrays that are made when they are read */
enum { MADE_MOST = 20 };

struct nsd_run {
    pid_t maker; /* the process that may use it */
    struct frame f;
    struct contacts spare;      /* where the contacts of the next step go */
    struct external_force last; /* the forces of the last step, while the next is made */
    struct driver driver;
    struct rollback undo;
    struct account account; /* of the steps of this run */
    double measured;        /* of them that have not converged, when it was measured last */
    bool solved;            /* the report is of a step of this run, and its options are these: */
    char *option_json;      /* or NULL */

    struct options options;
    bool chosen;           /* driver.o is what they come to */
    bool contacts, forces; /* what is saved */
    bool compares; /* reactions of small steps are compared with converged ones in each step */
    struct asked asked;
    struct frame_memory first, before; /* what measures remember */
    bool remembers;

    int32_t next_id;   /* no body had it */
    bool other_bodies; /* than when the trajectory was begun */
    bool noted;
    struct writer *out; /* a trajectory */
    bool rests;         /* in whose first frame no wall could move */
    char *path;         /* its */

    void *made[MADE_MOST]; /* arrays by their place in the table of names; or NULL */
    char *text;            /* JSON that was asked for */
    struct failure failure;
};

/* Each function of nsd.h that has a run begins with this: what it is to put its reason into; NULL: there is no run, or it
   is another process's, which is said (NSD_USAGE). */
struct failure *run_why(struct nsd_run *run);
/* The reason of this thread where there is no run */
struct failure *run_why_of_thread(void);

/* r->driver.o and r->option_json are what the options come to; the packing has theta and what is done about overlap. */
int run_choose(struct nsd_run *r, struct failure *failure);
/* As nsd_add() */
int run_add(struct nsd_run *r, const struct nsd_bodies *b, int32_t *id, struct failure *failure);
/* Where the packing gets other bodies: a new one in place of it */
void run_replace(struct nsd_run *r, struct packing *p, struct contacts *s);
