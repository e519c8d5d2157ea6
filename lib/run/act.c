/* run/act.c: what a program does to a run between steps. */

#include "run/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static vec3 of(const double x[3])
{
    return x ? v3(x[0], x[1], x[2]) : v3(0, 0, 0);
}

/* How long it lasts; ACTS_TERMS with the reason: neither */
static enum control_lasting term_of(enum nsd_term term, struct failure *failure)
{
    if (term == NSD_ONCE) return CONTROL_ONCE;
    if (term == NSD_LASTING) return CONTROL_LASTING;
    failure_set(failure, NSD_USAGE, "a force acts NSD_ONCE or is NSD_LASTING");
    return CONTROL_TERMS;
}

int nsd_force(struct nsd_run *r, int32_t id, const double force[3], const double torque[3],
              enum nsd_term term)
{
    struct failure *failure = run_why(r);
    enum control_lasting t = failure ? term_of(term, failure) : CONTROL_TERMS;
    if (t == CONTROL_TERMS) return NSD_USAGE;
    return control_force(&r->driver.acts, &r->f.packing, id,
                         (struct wrench){ of(force), of(torque) }, t, failure);
}

int nsd_wall_force(struct nsd_run *r, int32_t wall, double force, enum nsd_term term)
{
    struct failure *failure = run_why(r);
    enum control_lasting t = failure ? term_of(term, failure) : CONTROL_TERMS;
    if (t == CONTROL_TERMS) return NSD_USAGE;
    return control_push(&r->driver.acts, &r->f.packing, wall, force, t, failure);
}

int nsd_wall_velocity(struct nsd_run *r, int32_t wall, const double velocity[3])
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (!velocity) return failure_set(failure, NSD_USAGE, "there is no velocity");
    return control_velocity(&r->f.packing, wall, of(velocity), failure);
}

int nsd_velocity(struct nsd_run *r, int32_t id, const double velocity[3],
                 const double angular_velocity[3])
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    struct packing *p = &r->f.packing;
    int64_t i = control_row(p, id);
    if (i < 0) return failure_set(failure, NSD_DATA, "there is no body %d", id);
    const vec3 had = p->v[i];
    if (velocity && control_motion(p, i, false, of(velocity), failure)) return failure->status;
    if (angular_velocity && control_motion(p, i, true, of(angular_velocity), failure))
        p->v[i] = had;
    return failure->status;
}

int nsd_gravity(struct nsd_run *r, const double gravity[3])
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (!gravity) return failure_set(failure, NSD_USAGE, "there is no gravity");
    return control_gravity(&r->f.packing, of(gravity), failure);
}

int nsd_friction(struct nsd_run *r, const char *material, const char *other, double mu)
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (!material || !other) return failure_set(failure, NSD_USAGE, "a material has a name");
    return control_friction(&r->f.packing, material, other, mu, failure);
}

static vec3 row3(const double *a, int64_t i)
{
    return a ? v3(a[3 * i], a[3 * i + 1], a[3 * i + 2]) : v3(0, 0, 0);
}

/* Body k of the arrays, as body i */
static void act_set(struct packing *p, int64_t i, const struct nsd_bodies *b, int64_t k)
{
    const double *q = b->orientation ? b->orientation + 4 * k : NULL;
    const struct new_body body = { .x = row3(b->position, k),
                                   .v = row3(b->velocity, k),
                                   .w = row3(b->angular_velocity, k),
                                   .q = q ? (quat){ q[0], q[1], q[2], q[3] } : (quat){ 1, 0, 0, 0 },
                                   .radius = b->radius[k],
                                   .density = b->mass ? 1 : b->density,
                                   .mass = b->mass ? b->mass[k] : 0,
                                   .weighed = b->mass,
                                   .fixed = b->mass && b->mass[k] == 0,
                                   .material = b->material ? b->material[k] : 0 };
    packing_set_body(p, i, &body);
    if (b->inertia) p->inertia[i] = b->inertia[k];
}

/* Cells have an image of each body, which packing_resize() knows nothing of. */
static int add_images(struct packing *p, int64_t n, struct failure *failure)
{
    if (!p->image) return 0;
    int32_t(*image)[3] = calloc((size_t)n + 1, sizeof *image);
    if (!image) return failure_set(failure, EX_SOFTWARE, "no memory for the images");
    memcpy(image, p->image, (size_t)p->n * sizeof *image);
    free(p->image);
    p->image = image;
    return 0;
}

/* Bodies that pours have brought */
static int64_t poured(const struct packing *p)
{
    int64_t n = 0;
    for (int32_t k = 0; k < p->pours; k++) n += p->poured[k].bodies;
    return n;
}

/* No body had it, and no pour has brought it. */
static int64_t next_id(const struct nsd_run *r)
{
    const struct packing *p = &r->f.packing;
    const int64_t of_pours = p->first_id + poured(p);
    return of_pours > r->next_id ? of_pours : r->next_id;
}

static int act_check(const struct nsd_run *r, const struct nsd_bodies *b, struct failure *failure)
{
    if (!b || b->size < sizeof *b)
        return failure_set(failure, NSD_USAGE, "bodies: size is not that of struct nsd_bodies");
    if (b->n < 0 || b->n > INT32_MAX - next_id(r))
        return failure_set(failure, NSD_DATA,
                           "bodies: %lld of them, and there are numbers for %lld", (long long)b->n,
                           (long long)(INT32_MAX - next_id(r)));
    if (b->n && (!b->position || !b->radius))
        return failure_set(failure, NSD_USAGE, "bodies: they have no position or no radius");
    if (b->n && !b->mass && !(b->density > 0 && isfinite(b->density)))
        return failure_set(failure, NSD_DATA, "bodies: neither a mass nor a density above 0");
    return 0;
}

int run_add(struct nsd_run *r, const struct nsd_bodies *b, int32_t *id, struct failure *failure)
{
    struct packing p;
    struct contacts s;
    const int64_t had = r->f.packing.n, first = next_id(r);
    if (act_check(r, b, failure) || packing_copy(&p, &r->f.packing, failure))
        return failure->status;
    if (contacts_copy(&s, &r->f.contacts)) {
        packing_free(&p);
        return failure_set(failure, NSD_SOFTWARE, "no memory for the contacts");
    }
    if (!add_images(&p, had + b->n, failure) && !packing_resize(&p, had + b->n, failure)) {
        for (int64_t k = 0; k < b->n; k++) {
            p.id[had + k] = (int32_t)(first + k);
            act_set(&p, had + k, b, k);
        }
        packing_check(&p, failure);
    }
    if (failure->status) return packing_free(&p), contacts_free(&s), failure->status;
    for (int64_t k = 0; k < b->n && id; k++) id[k] = p.id[had + k];
    r->next_id = (int32_t)(first + b->n);
    const int64_t of_pours = r->next_id - poured(&p); // pours go on after the new ones
    if (p.first_id < of_pours) p.first_id = (int32_t)of_pours;
    if (b->n) return run_replace(r, &p, &s), 0;
    return packing_free(&p), contacts_free(&s), 0;
}

int nsd_add(struct nsd_run *r, const struct nsd_bodies *bodies, int32_t *id)
{
    struct failure *failure = run_why(r);
    return failure ? run_add(r, bodies, id, failure) : NSD_USAGE;
}

/* row[i]: where body i goes, -1: it is among those that are removed */
static int act_find_rows(const struct packing *p, int64_t n, const int32_t *id, int32_t *row,
                         struct failure *failure)
{
    int32_t kept = 0;
    for (int64_t i = 0; i < p->n; i++) row[i] = 0;
    for (int64_t k = 0; k < n; k++) {
        int64_t i = control_row(p, id[k]);
        if (i < 0) return failure_set(failure, NSD_DATA, "there is no body %d", id[k]);
        if (row[i] < 0) return failure_set(failure, NSD_DATA, "body %d occurs twice", id[k]);
        row[i] = -1;
    }
    for (int64_t i = 0; i < p->n; i++)
        if (row[i] >= 0) row[i] = kept++;
    return 0;
}

int nsd_remove(struct nsd_run *r, int64_t n, const int32_t *id)
{
    struct failure *failure = run_why(r);
    struct packing p;
    struct contacts s = { 0 };
    if (!failure) return NSD_USAGE;
    if (n < 0 || (n && !id))
        return failure_set(failure, NSD_USAGE, "there are no numbers of bodies");
    if (!n) return 0;
    if (n > r->f.packing.n)
        return failure_set(failure, NSD_DATA, "%lld bodies cannot be removed: there are %lld",
                           (long long)n, (long long)r->f.packing.n);
    int32_t *row = malloc(((size_t)r->f.packing.n + 1) * sizeof *row);
    if (!row) return failure_set(failure, NSD_SOFTWARE, "no memory to remove bodies");
    if (!act_find_rows(&r->f.packing, n, id, row, failure) &&
        !packing_copy(&p, &r->f.packing, failure)) {
        if (contacts_copy(&s, &r->f.contacts))
            failure_set(failure, NSD_SOFTWARE, "no memory for the contacts");
        else
            flow_drop(&p, &s, row, failure);
        if (failure->status)
            packing_free(&p), contacts_free(&s);
        else
            run_replace(r, &p, &s);
    }
    free(row);
    return failure->status;
}
