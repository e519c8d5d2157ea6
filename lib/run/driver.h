/*
 * run/driver.h: a run of steps: what it keeps from step to step beside its frame, and how each of its steps begins. Then the step
 * is made: by step_advance(), by one process or by ranks [run/processes.h], who differ in no more than that.
 */
#pragma once

#include "run/control.h"
#include "scene/inlet.h"
#include "step/step.h"

/* All zero to begin with */
struct driver {
    struct flow flow; /* inlets and outlets */
    struct step_memory memory;
    struct control acts; /* what a program has asked for */
    struct step_opt o;   /* of the dt that the step begins with */
    bool other_bodies;   /* than in the step before */
};

void driver_free(struct driver *d);
/* Nothing is kept that only saves time. */
void driver_forget(struct driver *d);
/*
 * The packing's next step begins: bodies come and go, for which `last`, the contacts of the step before or NULL, are renumbered. Returns 0, EX_DATAERR or EX_SOFTWARE.
 */
int driver_begin(struct driver *d, struct packing *p, struct contacts *last,
                 struct failure *failure);

/* "1e-4": s. Returns 0 or EX_USAGE. */
int driver_read_dt(const char *text, double *x, struct failure *failure);
/* dt (s) from here on. Returns 0, or EX_DATAERR: dt does not change the time. */
int driver_set_dt(struct packing *p, double dt, struct failure *failure);
/* s: what a time that is given in seconds may differ from that of its step: a part of dt, and the roundings of dt, of its
   product with the step, and of the time given */
double driver_slack(const struct packing *p, double t);
