/* run/act.c: what a program does to a run between steps. */
#include "run/run.h"

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
    return control_force(&r->acts, &r->f.packing, id, (struct wrench){ of(force), of(torque) }, t,
                      failure);
}

int nsd_boundary_force(struct nsd_run *r, int32_t boundary, double force, enum nsd_term term)
{
    struct failure *failure = run_why(r);
    enum control_lasting t = failure ? term_of(term, failure) : CONTROL_TERMS;
    if (t == CONTROL_TERMS) return NSD_USAGE;
    return control_push(&r->acts, &r->f.packing, boundary, force, t, failure);
}

int nsd_boundary_velocity(struct nsd_run *r, int32_t boundary, const double velocity[3])
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (!velocity) return failure_set(failure, NSD_USAGE, "there is no velocity");
    return control_velocity(&r->f.packing, boundary, of(velocity), failure);
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
    if (angular_velocity && control_motion(p, i, true, of(angular_velocity), failure)) p->v[i] = had;
    return failure->status;
}

int nsd_gravity(struct nsd_run *r, const double gravity[3])
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (!gravity) return failure_set(failure, NSD_USAGE, "there is no gravity");
    return control_gravity(&r->f.packing, of(gravity), failure);
}

int nsd_friction(struct nsd_run *r, const char *kind, const char *other, double mu)
{
    struct failure *failure = run_why(r);
    if (!failure) return NSD_USAGE;
    if (!kind || !other) return failure_set(failure, NSD_USAGE, "a kind has a name");
    return control_friction(&r->f.packing, kind, other, mu, failure);
}
