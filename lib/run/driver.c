#include "run/driver.h"

#include "base/option.h"
#include "base/text.h"
#include "scene/breaking.h"
#include "step/adapt.h"

#include <float.h>
#include <math.h>
#include <string.h>

void driver_forget(struct driver *d)
{
    step_forget(&d->memory);
    neighbours_free(&d->ahead);
}

void driver_free(struct driver *d)
{
    driver_forget(d);
    control_free(&d->acts);
    flow_free(&d->flow);
    *d = (struct driver){ 0 };
}

static int driver_adapt(struct driver *d, struct packing *p, double tol, struct failure *failure)
{
    const double had = p->dt;
    if (!(tol > 0)) return 0;
    if (adapt_step(p, tol, &d->ahead, failure)) return failure->status;
    d->o.solve.local.newton_abs *= p->dt / had;
    return 0;
}

int driver_begin(struct driver *d, struct packing *p, double tol, struct contacts *last,
                 struct failure *failure)
{
    if (driver_adapt(d, p, tol, failure) ||
        flow_step(&d->flow, p, last, &d->other_bodies, failure) ||
        breaking_step(p, last, &d->other_bodies, failure))
        return failure->status;
    if (d->other_bodies) driver_forget(d);
    return control_begin(&d->acts, p, failure);
}

bool driver_read_dt(const char *text, bool *adapts, double *x)
{
    static const char word[] = "auto:";
    *adapts = !strncmp(text, word, sizeof word - 1);
    const char *number = *adapts ? text + sizeof word - 1 : text;
    char *end = NULL;
    bool read =
        *adapts ? (*x = number_read(number, &end), end != number && !*end) : time_parse(x, number);
    return read && *x > 0 && *x <= (*adapts ? 1 : DBL_MAX);
}

int driver_set_dt(struct packing *p, double dt, struct failure *failure)
{
    const struct packing was = *p;
    p->halved = 0;
    packing_set_dt(p, dt);
    if (packing_check_clock(p, failure)) {
        p->dt = was.dt, p->halved = was.halved, p->t0 = was.t0, p->step0 = was.step0;
        return failure->status;
    }
    memory_scale(&p->memory, dt / was.dt);
    return 0;
}

double driver_slack(const struct packing *p, double t)
{
    return 1e-6 * p->dt + 4 * DBL_EPSILON * fabs(t);
}
