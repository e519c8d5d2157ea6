/* api/act.c: what a program does to a run between steps. */
#include "api/run.h"

static vec3 of(const double x[3])
{
    return x ? v3(x[0], x[1], x[2]) : v3(0, 0, 0);
}

/* How long it lasts; ACTS_TERMS with the reason: neither */
static enum acts_lasting term_of(enum nsd_term term, struct why *why)
{
    if (term == NSD_ONCE) return ACTS_ONCE;
    if (term == NSD_LASTING) return ACTS_LASTING;
    why_set(why, NSD_USAGE, "a force acts NSD_ONCE or is NSD_LASTING");
    return ACTS_TERMS;
}

int nsd_force(struct nsd_run *r, int32_t id, const double force[3], const double torque[3],
              enum nsd_term term)
{
    struct why *why = run_why(r);
    enum acts_lasting t = why ? term_of(term, why) : ACTS_TERMS;
    if (t == ACTS_TERMS) return NSD_USAGE;
    return acts_force(&r->acts, &r->f.packing, id, (struct wrench){ of(force), of(torque) }, t,
                      why);
}

int nsd_boundary_force(struct nsd_run *r, int32_t boundary, double force, enum nsd_term term)
{
    struct why *why = run_why(r);
    enum acts_lasting t = why ? term_of(term, why) : ACTS_TERMS;
    if (t == ACTS_TERMS) return NSD_USAGE;
    return acts_push(&r->acts, &r->f.packing, boundary, force, t, why);
}

int nsd_boundary_velocity(struct nsd_run *r, int32_t boundary, const double velocity[3])
{
    struct why *why = run_why(r);
    if (!why) return NSD_USAGE;
    if (!velocity) return why_set(why, NSD_USAGE, "there is no velocity");
    return acts_velocity(&r->f.packing, boundary, of(velocity), why);
}

int nsd_velocity(struct nsd_run *r, int32_t id, const double velocity[3],
                 const double angular_velocity[3])
{
    struct why *why = run_why(r);
    if (!why) return NSD_USAGE;
    struct packing *p = &r->f.packing;
    int64_t i = acts_row(p, id);
    if (i < 0) return why_set(why, NSD_DATA, "there is no body %d", id);
    const vec3 had = p->v[i];
    if (velocity && acts_motion(p, i, false, of(velocity), why)) return why->status;
    if (angular_velocity && acts_motion(p, i, true, of(angular_velocity), why)) p->v[i] = had;
    return why->status;
}

int nsd_gravity(struct nsd_run *r, const double gravity[3])
{
    struct why *why = run_why(r);
    if (!why) return NSD_USAGE;
    if (!gravity) return why_set(why, NSD_USAGE, "there is no gravity");
    return acts_gravity(&r->f.packing, of(gravity), why);
}

int nsd_friction(struct nsd_run *r, const char *kind, const char *other, double mu)
{
    struct why *why = run_why(r);
    if (!why) return NSD_USAGE;
    if (!kind || !other) return why_set(why, NSD_USAGE, "a kind has a name");
    return acts_friction(&r->f.packing, kind, other, mu, why);
}
