/* solve/device.c: where the iterate is, and what is asked of a device [solve/device.h]. */
#include "solve/device.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The table; NULL ends it */
static const struct device_kind *const device_kinds[] = { &device_opencl, NULL };

static const struct device_kind *device_kind_named(const char *name, size_t n)
{
    for (int k = 0; device_kinds[k]; k++)
        if (strlen(device_kinds[k]->name) == n && !strncmp(device_kinds[k]->name, name, n))
            return device_kinds[k];
    return NULL;
}

/* The kind of device, and its number; NULL and EX_USAGE where the name is none */
static const struct device_kind *parse(const char *name, int *number, struct failure *failure)
{
    size_t n = strcspn(name, ":"), digits = name[n] ? strspn(name + n + 1, "0123456789") : 0;
    const struct device_kind *kind = device_kind_named(name, n);
    if (!kind || (name[n] && (!digits || digits > 3 || name[n + 1 + digits]))) {
        failure_set(failure, EX_USAGE, "--device: '%s' is none of list, opencl, opencl:N", name);
        return NULL;
    }
    *number = name[n] ? atoi(name + n + 1) : 0;
    return kind;
}

int device_named(const char *name, struct failure *failure)
{
    int number;
    return parse(name, &number, failure) ? 0 : failure->status;
}

struct device *device_open(const char *name, struct failure *failure)
{
    int number;
    const struct device_kind *kind = parse(name, &number, failure);
    return kind ? kind->open(number, failure) : NULL;
}

int device_list(FILE *to, struct failure *failure)
{
    for (int k = 0; device_kinds[k]; k++)
        if (device_kinds[k]->list(to, failure)) return failure->status;
    return 0;
}

void device_close(struct device *d)
{
    if (d) d->kind->close(d);
}

const char *device_declines(const struct problem *p)
{
    if (p->exchange) return "several processes share the contacts";
    if (p->kind.rolls) return "contacts have rolling friction";
    if (p->kind.extra) return "contacts have bonds";
    if (p->kind.levers) return "grains are no balls or discs";
    if (p->W && p->W->common) return "loads push contacts";
    return p->slots > INT32_MAX ? "there are too many contacts" : NULL;
}

int device_hold(struct device *d, struct problem *p, enum method_id method, struct failure *failure)
{
    if (d->kind->hold(d, p, method, failure)) return failure->status;
    p->device = d;
    d->problem = p, d->here = true, d->there = false, d->kept = 0;
    return 0;
}

int device_release(struct problem *p, struct failure *failure)
{
    struct device *d = p->device;
    if (!d->here && !d->lost.status) d->kind->download(d, p, false);
    p->device = NULL, d->problem = NULL;
    return d->lost.status ? failure_set(failure, d->lost.status, "%s", d->lost.text) : 0;
}

void device_home(struct problem *p, bool writes)
{
    struct device *d = p->device;
    if (!d) return;
    if (!d->here && !d->lost.status) d->kind->download(d, p, true);
    d->here = true;
    if (writes) d->there = false;
}

/* The device, with the iterate; NULL where it is lost */
static struct device *at_work(const struct problem *p)
{
    struct device *d = p->device;
    if (!d->there && !d->lost.status) d->kind->upload(d, p);
    d->there = true;
    return d->lost.status ? NULL : d;
}

void device_sweep(struct problem *p, const struct sweep_opt *o, struct tally *t)
{
    struct device *d = at_work(p);
    if (!d) return;
    d->here = false, d->kind->sweep(d, p, o, t);
}

void device_judge(const struct problem *p, bool believes, enum err_terms which, int64_t per_block,
                  struct sums *s)
{
    struct device *d = at_work(p);
    if (d) d->kind->judge(d, p, believes, which, per_block, s);
    if (p->device->lost.status) s->motion[0] = s->natural2[0] = s->velocity2[0] = NAN;
}

void device_velocities(const struct problem *p)
{
    struct device *d = at_work(p);
    if (d) d->here = false, d->kind->velocities(d, p);
}

void device_renew(struct problem *p)
{
    struct device *d = at_work(p);
    if (d) d->here = false, d->kind->renew(d, p);
}

int device_place(struct device *d)
{
    return d->kept < DEVICE_KEPT ? d->kept++ : -1;
}

void device_keep(struct problem *p, int place, bool u)
{
    struct device *d = at_work(p);
    if (d) d->kind->keep(d, p, place, u);
}

void device_restore(struct problem *p, int place, bool u)
{
    struct device *d = at_work(p);
    if (d) d->here = false, d->kind->restore(d, p, place, u);
}

int device_mixing(struct problem *p, int depth)
{
    struct device *d = at_work(p);
    return d ? d->kind->mixing(d, p, depth) : 0; // lost: the solve ends at its first judgement
}

void device_remember(struct problem *p, int next)
{
    struct device *d = at_work(p);
    if (d) d->kind->remember(d, p, next);
}

void device_measure(struct problem *p, const struct mixing *m, int64_t per_chunk,
                    struct mixing_sums *sums)
{
    struct device *d = at_work(p);
    if (d) d->kind->measure(d, p, m, per_chunk, sums);
    if (p->device->lost.status) sums->f2[0] = NAN;
}

void device_react(struct problem *p, const struct mixing *m, double leap,
                  const double gamma[MIXING_DEPTH])
{
    struct device *d = at_work(p);
    if (d) d->here = false, d->kind->react(d, p, m, leap, gamma);
}
