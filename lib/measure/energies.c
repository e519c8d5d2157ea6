/* measure/energies.c: energies, and what a step takes of them. */

#include "contact/contact_law.h"
#include "measure/measures.h"
#include "measure/snapshot.h"
#include "state/breakable.h"
#include "state/rotation.h"
#include "step/contact_motion.h"
#include "step/move.h"

#include <math.h>

/*
 * The beginning of the step that a frame's contacts belong to, and the sums of their reactions.
 * A document has either end of the step; the reactions lead from one to the other.
 */

struct step_start {
    const struct packing *p; /* where the step begins */
    struct impulses sum;
    struct packing back; /* the frame moved back, if it is the step's end */
};

/* Of solved contacts. Returns 0 or EX_SOFTWARE; to be freed either way. */
static int step_start_init(struct step_start *m, const struct snapshot *s, struct failure *failure);
static void step_start_free(struct step_start *m);

static int step_start_init(struct step_start *m, const struct snapshot *s, struct failure *failure)
{
    *m = (struct step_start){ .p = s->p };
    if (s->moved) {
        m->p = &m->back;
        if (packing_copy(&m->back, s->p, failure) || move_back(&m->back, s->s, failure))
            return failure->status;
    }
    return impulses_init(&m->sum, m->p, s->s, false, failure);
}

static void step_start_free(struct step_start *m)
{
    impulses_free(&m->sum);
    packing_free(&m->back);
}

static const struct quantity quantities[] = {
    { "kinetic", "J", 1, "kinetic energy of translation" },
    { "rotation", "J", 1, "kinetic energy of rotation" },
    { "potential", "J", 1, "potential energy, - sum m g . x, zero at the origin" },
    { "stored", "J", 1, "energy stored in cohesion, liquid, bonds and springs" },
    { "total", "J", 1, "sum of these four" },
    { "dissipated", "J", 1, "energy dissipated by contacts in their step, without stored energy" },
    { "impact", "J", 1, "part of dissipated by normal velocities" },
    { "friction", "J", 1,
      "part of dissipated by tangential velocities and by rolling and pivoting" },
    { "walls", "J", 1, "work of walls on bodies in that step" },
    { "peculiar", "J", 1, "kinetic energy of translation relative to the flow of the cell" },
    { "breaking", "J", 1,
      "energy that broken grains have lost since the first frame, that of their dust" },
    { "boundaries", "J", 1, "walls under their former name" },
    { 0 },
};

/* What contacts take in the step, and what walls give, by the motion at each contact [step/contact_motion.h] */
static int energies_add_step(double **at, const struct snapshot *s, double *stored,
                             struct failure *failure)
{
    struct step_start m;
    double impact = 0, friction = 0, walls = 0, kept = 0;
    if (step_start_init(&m, s, failure)) {
        step_start_free(&m);
        return failure->status;
    }
    for (int64_t i = 0; i < s->s->n; i++) {
        const struct contact *c = &s->s->c[i];
        const double *r = s->s->found[i].r, *moment = s->s->moment ? s->s->moment[i] : NULL;
        int times = region_holds(&s->region, c->x);
        if (!times) continue;
        if (s->s->law) {
            struct contact_law_end end =
                contact_law_end(m.p, c, &s->s->law[i], &s->s->found[i], moment);
            struct contact_law_account a = contact_law_account(m.p, c, &s->s->law[i], &end);
            *stored += times * a.stored, kept += times * (a.change + a.broken - a.rise);
        }
        const struct contact_motion motion = contact_motion(m.p, &m.sum, c);
        const struct contact_loss loss = contact_loss(&motion, c, r, moment);
        impact += times * loss.impact, friction += times * loss.friction;
        if (c->a < 0) walls -= times * contact_wall_work(&motion, c, r, moment);
    }
    put(at, impact + friction - kept), put(at, impact), put(at, friction), put(at, walls);
    step_start_free(&m);
    return 0;
}

/* Of a step that was made in several, by its balance. Returns what is lacking; NULL: nothing. */
static const char *energies_add_balance(double *at, const struct snapshot *s, double *stored)
{
    const struct report *r = s->report;
    if (!r || !r->balanced)
        return "the step was made in small steps, and the document has no balance of them";
    if (!s->region.all)
        return "the step was made in small steps, and their balance is that of all bodies";
    at[0] = r->balance.dissipation, at[3] = r->balance.drives;
    *stored = r->tied ? r->balance.bond_energy : 0;
    return NULL;
}

/* The kinetic and potential energy that dust took with it */
static double energies_breaking(struct table *t, const struct snapshot *s)
{
    const struct broken b = breakage_total(s->p);
    if (s->region.all && !s->only.bodies) return b.kinetic + b.potential;
    if (s->p->breakage) table_null(t, "no energy of breaking: it is that of all bodies");
    return s->p->breakage ? NAN : 0;
}

static int energies_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    const struct packing *p = s->p;
    struct cell_flow flow;
    double peculiar = 0, kinetic = 0, rotation = 0, potential = 0, *at = table_row(t, failure);
    if (!at) return failure->status;
    cell_flow_init(&flow, &p->cell, p->cell.edge, p->cell.rate);
    for (int64_t i = 0; i < p->n; i++) {
        vec3 w = flow.changes ? v3_sub(p->v[i], cell_flow_gain(&flow, p->x[i])) : p->v[i];
        int times = snapshot_body(s, i) ? region_holds(&s->region, p->x[i]) : 0;
        kinetic += times * 0.5 * p->mass[i] * v3_dot(p->v[i], p->v[i]);
        peculiar += times * 0.5 * p->mass[i] * v3_dot(w, w);
        rotation += times * 0.5 * rotation_energy2(p, i, p->q[i], p->w[i]);
        potential -= times * p->mass[i] * v3_dot(p->g, p->x[i]);
    }
    double *step = at + 5, stored = 0;
    at[9] = peculiar, at[10] = energies_breaking(t, s);
    const char *lacks = NULL;
    if (!s->s || (!s->s->found && s->s->n))
        lacks = "the document has no solved contacts";
    else if (s->only.bodies)
        lacks = "contacts are not divided among groups of bodies";
    else if (contacts_summed(s->s))
        lacks = energies_add_balance(step, s, &stored);
    else if (energies_add_step(&step, s, &stored, failure))
        return failure->status;
    if (lacks) table_null(t, "no dissipation: %s", lacks);
    if (isnan(at[6]))
        table_null(t, "impact and friction are known of steps that were made at once");
    if (lacks && p->law) stored = NAN;
    put(&at, kinetic), put(&at, rotation), put(&at, potential), put(&at, stored);
    put(&at, kinetic + rotation + potential + stored);
    at[6] = at[3];
    return 0;
}

const struct measure measure_energy = {
    .name = "energy",
    .help = "energies, and the energy that a step dissipates",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_BODIES,
    .usual = true,
    .rows = energies_rows,
};
