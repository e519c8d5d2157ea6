#include "run/driver.h"

#include "base/option.h"
#include "base/text.h"
#include "scene/breaking.h"

#include <float.h>
#include <math.h>
#include <string.h>

void driver_forget(struct driver *d)
{
    step_forget(&d->memory);
}

void driver_free(struct driver *d)
{
    driver_forget(d);
    control_free(&d->acts);
    flow_free(&d->flow);
    *d = (struct driver){ 0 };
}

int driver_begin(struct driver *d, struct packing *p, struct contacts *last,
                 struct failure *failure)
{
    if (flow_step(&d->flow, p, last, &d->other_bodies, failure) ||
        breaking_step(p, last, &d->other_bodies, failure))
        return failure->status;
    if (d->other_bodies) driver_forget(d);
    return control_begin(&d->acts, p, failure);
}

int driver_read_dt(const char *text, double *x, struct failure *failure)
{
    if (!strncmp(text, "auto", 4))
        return failure_set(failure, EX_USAGE,
                           "'%.60s' is no longer available: leave dt out, for small steps, which "
                           "bound overlaps",
                           text);
    if (!time_parse(x, text) || !(*x > 0 && *x <= DBL_MAX))
        return failure_set(failure, EX_USAGE, "'%.60s' is no time above 0, as 1e-4 or 0.1ms", text);
    return 0;
}

int driver_set_dt(struct packing *p, double dt, struct failure *failure)
{
    const struct packing was = *p;
    packing_set_dt(p, dt);
    if (packing_check_clock(p, failure)) {
        p->dt = was.dt, p->t0 = was.t0, p->step0 = was.step0;
        return failure->status;
    }
    memory_scale(&p->memory, dt / was.dt);
    return 0;
}

double driver_slack(const struct packing *p, double t)
{
    return 1e-6 * p->dt + 4 * DBL_EPSILON * fabs(t);
}
