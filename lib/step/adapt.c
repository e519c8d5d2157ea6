/* step/adapt.c: dt halved and doubled by what overlaps would come [step/adapt.h]. */
#include "step/adapt.h"

#include "contact/detect.h"
#include "state/kinematics.h"

/* Of TOL: what twice the dt may bring, so that it is not halved again at once */
#define CALM 0.5

/* m/s: no two bodies, or body and wall, approach faster; INFINITY where images of bodies move as well */
static double adapt_fastest(const struct packing *p)
{
    const struct whole all = packing_whole(p);
    double speed = p->shape ? all.rotation_speed : all.speed, wall = speed;
    for (int32_t w = 0; w < p->walls; w++) wall = dmax(wall, wall_top_speed(p, &p->wall[w]));
    return cell_repeats(&p->cell) ? INFINITY : speed + wall;
}

/* Radii: the largest overlap that is new in a step of dt. Looked for with midpoint and laws left out: where
   bodies are at its end. */
static int new_overlap(double *most, const struct packing *p, struct neighbours *near,
                       struct failure *failure)
{
    struct packing end = *p;
    struct contacts met = { 0 };
    *most = 0;
    end.theta = 0, end.law = NULL, end.overlap = OVERLAP_KEEP, end.bonds = (struct bonds){ 0 };
    end.memory = (struct memory){ 0 };
    if (detect_contacts(&met, &end, 0, near, failure)) return failure->status;
    for (int64_t i = 0; i < met.n; i++) {
        const struct contact *c = &met.c[i];
        double come = dmin(-c->gap, -p->dt * opening_of(p, c, p->dt));
        *most = dmax(*most, come / packing_smaller_radius(p, c));
    }
    contacts_free(&met);
    return 0;
}

static void change(struct packing *p, int halved)
{
    double factor = ldexp(1, p->halved - halved);
    p->halved = halved;
    packing_set_dt(p, factor * p->dt);
    memory_scale(&p->memory, factor);
}

/* Is what the step would bring within tol radii? */
static int is_calm(bool *calm, const struct packing *p, double tol, struct neighbours *near,
                   struct failure *failure)
{
    double most = 0;
    bool look = adapt_fastest(p) * p->dt > tol * packing_whole(p).small;
    if (look && new_overlap(&most, p, near, failure)) return failure->status;
    *calm = most <= tol;
    return 0;
}

int adapt_step(struct packing *p, double tol, struct neighbours *near, struct failure *failure)
{
    bool calm = false;
    int had = p->halved;
    if (p->halved && (p->step - p->step0) % 2 == 0) {
        change(p, had - 1);
        if (is_calm(&calm, p, CALM * tol, near, failure)) return failure->status;
        if (calm) return 0;
        change(p, had);
    }
    while (!is_calm(&calm, p, tol, near, failure) && !calm && p->halved < ADAPT_MOST)
        change(p, p->halved + 1);
    return failure->status;
}
