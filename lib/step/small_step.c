/* step/small_step.c: a step in small ones: what it begins with and what is told of it [step/small_step.h]. */
#include "step/small_step.h"

#include "base/team.h"
#include "contact/depth.h"
#include "contact/touching.h"
#include "contact/tunnelling.h"
#include "solve/backend.h"
#include "state/freedom.h"
#include "state/placement.h"
#include "state/rotation.h"
#include "state/servo_box.h"
#include "step/small_bonds.h"
#include "step/small_cell.h"
#include "step/small_error.h"
#include "step/small_gain.h"
#include "step/small_give.h"
#include "step/small_load.h"
#include "step/small_loop.h"
#include "step/small_make.h"
#include "step/small_part.h"
#include "step/small_past.h"
#include "step/small_point.h"
#include "step/small_pull.h"
#include "step/small_springs.h"
#include "step/small_stiff.h"
#include "step/small_stress.h"
#include "step/small_sums.h"
#include "step/small_wall.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    COUNT_MOST = 100000, /* small steps of a step; one that needs more is made at once */
    PARTS_MOST = 100     /* of a step that is made at once after all: solves */
};

/* C over W of a pair */
#define COMPLIANCE 0.04
/* Times the lightest body */
#define UNEVEN 30
/* Of h: tau, in which overlaps are left */
#define RELAXES 11
/* Of the fastest speed, of what moves a body by the permitted overlap in h at most and by UNSEEN of the smallest radius at least: a change of a velocity that is not
   followed up, in the first sweep of a step, without restitution, and in others. Less would carry impacts farther into a
   packing, and cost a flowing drum a tenth of its time and more. */
#define UNSEEN 1e-3
static const double ALLOWED[2] = { 0.45, 0.1 };
/* The same in the first sweep where bodies have several points, which are solved together */
#define ALLOWED_POINTS 0.67

/* Those whose loads or edges move fast, which one solve of a whole step would leave with overlaps */
bool small_divides(const struct packing *p)
{
    return small_stress_light(p) || small_loads_heavy(p);
}

const char *small_lacks(const struct packing *p)
{
    if (small_stress_light(p)) return "edges of a cell that are lighter than a row of grains";
    if (small_loads_heavy(p)) return "a load of more mass than two layers of grains";
    if (small_stiff_exceeds(p))
        return "contacts or bonds so stiff that a step has more than 1000 small ones";
    return NULL;
}

/* ---- the interval ---- */

/* m: what ways and overlaps are to be small against: of a ball its radius, else half the thickness; where grains break, half the radius
   of splinters that are thinner */
static double small_size(const struct packing *p, int64_t i)
{
    const double half = packing_shape(p, i) ? tunnelling_thickness(p, i) : p->radius[i];
    return p->breakage ? fmax(half, 0.5 * p->radius[i]) : half;
}

static bool small_has_shapes(const struct packing *p)
{
    bool any = false;
    for (int64_t i = 0; p->shape && i < p->n && !any; i++) any = packing_shape(p, i) != NULL;
    return any;
}

const char *small_undivided(const struct packing *p, double bound)
{
    if (bound > 0) return "a bound on the missing impulse";
    if (small_has_shapes(p) || p->mesh.elements) return "shapes other than balls, or meshes";
    if (freedoms_in(p)) return "walls or cells that loads move";
    if (small_cell_moves(p)) return "a cell that moves";
    if (p->sums.n) return "sums of forces on faces";
    return NULL;
}

struct small_sizes { /* m */
    double least, most;
};
static struct small_sizes small_sizes(const struct packing *p)
{
    const struct whole all = packing_whole(p);
    if (!small_has_shapes(p)) return (struct small_sizes){ all.small, all.large };
    struct small_sizes s = { INFINITY, 0 };
    for (int64_t i = 0; i < p->n; i++) {
        const double size = small_size(p, i);
        s.least = fmin(s.least, size), s.most = fmax(s.most, size);
    }
    return s;
}

/* m: in a small step a body goes R of this size at most. Where grains break, few small fragments do not set the number of
   small steps; what a large body leaves of an overlap with a small one is bounded. */
#define COARSE 4
static double small_coarse(const struct packing *p)
{
    const struct small_sizes s = small_sizes(p);
    return p->breakage ? fmin(s.most, COARSE * s.least) : s.least;
}

/* m/s: of a point of a body, of balls the centre; of walls */
static double small_fastest(const struct packing *p)
{
    double most = small_wall_speed(p);
    const struct small_flow flow = small_cell_flow(p);
    for (int64_t i = 0; i < p->n; i++) most = dmax(most, small_body_speed(p, &flow, i));
    return most;
}

/* ---- their number ---- */

/* The mass of the heaviest body over that of the lightest, by how many of the smallest find room below it */
static double small_heaviest(const struct packing *p)
{
    const struct whole all = packing_whole(p);
    double least = INFINITY, most = 0;
    for (int64_t i = 0; i < p->n; i++) {
        const double wide = p->radius[i] / all.small;
        if (p->mass[i] > 0) least = dmin(least, p->mass[i]);
        if (p->mass[i] > 0) most = dmax(most, p->mass[i] / (p->dim == 2 ? wide : wide * wide));
    }
    return most > 0 ? most / least : 0;
}

/* Of the heaviest body: what a column carries besides its own grains. More would cost small steps, less overlap. */
#define CARRIES 0.25
/* s: in which a body that a column of grains as high as the packing pushes, with the heaviest body on it, and forces on bodies,
   moves by STEADY of the smallest radius */
#define STEADY 1e-3
static double small_steady(const struct packing *p)
{
    const double g = v3_norm(p->g);
    const struct small_sizes size = small_sizes(p);
    double lo = INFINITY, hi = -INFINITY, pressed = small_pull_presses(p) + small_tie_most(p);
    for (int64_t i = 0; i < p->n; i++) {
        const double z = v3_dot(p->g, p->x[i]);
        if (p->mass[i] > 0) lo = dmin(lo, z), hi = dmax(hi, z);
    }
    if (g > 0 && hi >= lo)
        pressed += g * (fmax(1, CARRIES * small_heaviest(p)) + (hi - lo) / g / (2 * size.most));
    return pressed > 0 ? sqrt(STEADY * small_coarse(p) / pressed) : INFINITY;
}

/* m/s^2: the largest acceleration that a reaction that lasts would give to its pair */
static double small_carries(const struct packing *p)
{
    double most = 0;
    for (int64_t i = 0; i < p->memory.n; i++) {
        const struct recall *c = &p->memory.recall[i];
        double w = p->mass[c->b] > 0 ? 1 / p->mass[c->b] : 0;
        if (p->law && pair_law_springs(&p->law[packing_pair(p, c->a, c->b)])) continue;
        if (c->a >= 0 && p->mass[c->a] > 0) w += 1 / p->mass[c->a];
        most = dmax(most, w * v3_norm(c->r));
    }
    return most / p->dt;
}

/* Of h^2 a/r over R: a pair that carries an acceleration a is left with an overlap of C f (h + tau), half of R r at most; of balls,
   and where points with their levers have more W */
static const double CARRIED[2] = { 1, 0.4 };
/* Without loads, of h: overlaps change with h, and a packing that flows would be shaken by a number of small steps that follows its
   largest reaction, which in drums and silos is below this; what walls squeeze exceeds it. */
static const double SPARED[2] = { 2, 1.5 };
/* Times the small steps of the other limits: where walls crush bodies reactions grow without end */
enum { CARRIED_MOST = 4 };

/* Of a packing whose fastest body has this speed (m/s); 0: too many */
static int64_t small_count_at(const struct packing *p, double overlap, double fastest)
{
    const bool points = small_has_shapes(p);
    const double size = freedoms_in(p) ? small_sizes(p).least : small_coarse(p);
    const double permits = CARRIED[points] * overlap * size;
    const double way = overlap * small_coarse(p);
    double n = fmax(1, p->dt * fmax(fastest / way, 1 / small_steady(p)));
    const double spared = freedoms_in(p) ? 1 : SPARED[points];
    n = fmax(n, fmin(p->dt * sqrt(small_carries(p) / permits) / spared, CARRIED_MOST * n));
    n = fmax(n, small_stiff_count(p));
    return n > COUNT_MOST ? 0 : (int64_t)fmax(1, ceil(n));
}

/* How many of them the step from where the packing is needs, that none moves a body by more than `overlap`
   radii of the smallest: of its state alone; 0: too many */
static int64_t small_count(const struct packing *p, double overlap)
{
    return small_count_at(p, overlap, small_fastest(p) + packing_most_fall(p) + small_tie_speed(p));
}

/* m/s: the largest speed of the bodies of a pair of the list against each other where the interval begins, or of a body against a wall
   that it comes near, which may then be as fast as it ever is. A body that flies alone, or with its neighbours, needs no small steps: its
   motion is exact for any h. The list has straight ways. */
static double small_near_speed(struct small_run *r)
{
    struct small_list *l = r->l;
    double most = 0;
    for (int64_t i = 0; i < l->pairs.n; i++) {
        const struct pair *pair = &l->pairs.pair[i];
        most = dmax(most, v3_norm(v3_sub(l->drift[pair->b], l->drift[pair->a])));
    }
    for (int64_t i = 0; i < l->touches; i++) {
        struct small_touch *t = &l->touch[i];
        if (!small_look_at_touch(r, t, INFINITY)) continue;
        const double more = r->wall[t->wall].top - v3_norm(t->v); // it may begin to move
        most = dmax(most, v3_norm(v3_sub(r->p->v[t->body], t->v)) + dmax(0, more));
    }
    return most;
}

/* Where the list has been made: fewer, longer small steps, if what is fast is so against nothing near it */
static void small_count_near(struct small_run *r)
{
    struct packing *p = r->p;
    const double was = r->ahead, dt = (double)r->n * r->h;
    if (r->l->serves < dt) return; // it does not have what fast bodies meet later
    p->dt = dt;
    const double fastest = small_near_speed(r) + packing_most_fall(p) + small_tie_speed(p);
    const int64_t n = small_count_at(p, r->overlap, fastest);
    p->dt = r->h;
    if (!n || n >= r->n) return;
    r->n = n, r->h = p->dt = dt / (double)n, r->ahead = (1 - p->theta) * r->h;
    r->l->since = r->ahead - was;
    for (int64_t i = 0; i < p->n; i++) r->x[i] = v3_axpy(p->x[i], r->ahead, p->v[i]);
}

/* ---- the first list ---- */

static void small_set_rates(struct small_run *r)
{
    const struct packing *p = r->p;
    r->fall = packing_most_fall(p) + p->dt * small_pull_load(p);
    const double fall = r->fall * (double)r->n;
    double heaviest = 0, lightest = INFINITY;
    r->free = 0, r->weight = 0;
    for (int64_t i = 0; i < p->n; i++) {
        r->free += p->mass[i] > 0, r->weight += p->mass[i] * r->fall;
        heaviest = dmax(heaviest, p->mass[i]);
        if (p->mass[i] > 0) lightest = dmin(lightest, p->mass[i]);
    }
    for (int32_t w = 0; w < p->walls; w++)
        if (p->wall[w].load.way == LOAD_GLIDES) heaviest = dmax(heaviest, p->wall[w].load.mass);
    r->uneven = heaviest > UNEVEN * lightest;
    const double fastest = small_fastest(p) + fall;
    const double change =
        fmax(fmin(fastest, r->overlap * small_coarse(p) / r->h), UNSEEN * r->thin / r->h);
    r->l->s.rate =
        (struct small_rates){ .h = r->h,
                              .per_h = 1 / r->h,
                              .relax = 1 / ((1 + RELAXES) * r->h),
                              .push = 2 * fall + 0.02 * fastest,
                              .soft = COMPLIANCE,
                              .gives = r->uneven ? INFINITY : 0,
                              .calm = freedoms_calm(p),
                              .pulls = 2 * r->h * small_tie_most(p),
                              .rise = r->h * fall,
                              .holds = small_tie_range(p, r->h),
                              .allowed = { (r->meets ? ALLOWED_POINTS : ALLOWED[0]) * change,
                                           ALLOWED[1] * change } };
}

static void take_bodies(struct small_run *r)
{
    const struct packing *p = r->p;
    struct small *s = &r->l->s;
    for (int64_t i = 0; i < p->n; i++) {
        small_array(s->place[i].x, r->x[i]);
        small_array(s->body[i].v, p->v[i]), small_array(s->body[i].w, p->w[i]);
    }
    s->sweep = 1;
    memset(s->hot, 0, (size_t)s->bodies * sizeof *s->hot);
}

/* A step at once says what of a body is not finite, and moves none. */
static bool small_is_finite(const struct small_run *r)
{
    for (int64_t i = 0; i < r->p->n; i++) {
        const struct body *b = &r->l->s.body[i];
        const double *x = r->l->s.place[i].x;
        double sum = 0;
        for (int k = 0; k < 3; k++) sum += fabs(x[k]) + fabs(b->v[k]) + fabs(b->w[k]);
        if (!isfinite(sum)) return false;
    }
    return true;
}

/* A velocity that a bond has damped to a denormal number is 0: arithmetic is slow with them, and awk reads them as text. */
static vec3 small_settled(const double v[3])
{
    vec3 u = small_vec(v);
    if (fabs(u.x) < DBL_MIN) u.x = 0;
    if (fabs(u.y) < DBL_MIN) u.y = 0;
    if (fabs(u.z) < DBL_MIN) u.z = 0;
    return u;
}

static void give_bodies(const struct small_run *r)
{
    struct packing *p = r->p;
    const struct small *s = &r->l->s;
    for (int64_t i = 0; i < p->n; i++) {
        p->v[i] = small_settled(s->body[i].v), p->w[i] = small_settled(s->body[i].w);
        p->x[i] = v3_axpy(small_vec(s->place[i].x), -r->ahead, p->v[i]);
        if (packing_shape(p, i) || r->bonds)
            p->q[i] = small_points_q(r, i, &p->w[i]);
        else
            p->q[i] = quat_mul(quat_rotation(r->turned[i]), p->q[i]);
    }
}

/* All small steps: bodies at r->x with the velocities of the packing, which does not change but for its time */
static int small_steps(struct small_run *r, const struct small_opt *o, struct report *rep,
                       struct failure *failure)
{
    for (int64_t i = 0; i < r->p->n; i++) {
        r->x[i] = v3_axpy(r->p->x[i], r->ahead, r->p->v[i]);
        r->v[i] = r->p->v[i];
    }
    small_list_free(r->l);
    r->l->surface = o->near->surface, r->l->s.moves = r->cell.moves, r->l->part = r->part;
    r->l->interval = r->h * (double)r->n;
    rep->detection = 0, r->begins = true;
    while (!failure->status && !r->failed && r->made < r->n) {
        const double cpu = report_seconds(CLOCK_CPU);
        const struct small_start start = { .x = r->x,
                                           .v = r->meets || r->cell.moves ? NULL : r->v,
                                           .edge = r->cell.edge,
                                           .t = r->p->t + r->ahead,
                                           .span = (double)(r->n - r->made) * r->h,
                                           .wall = small_wall_speed(r->p) };
        if (small_list_make(r->l, r->p, &start, failure)) break;
        rep->detection += report_seconds(CLOCK_CPU) - cpu;
        if (r->begins) {
            small_walls_set(r);
            if (start.v && !freedoms_in(r->p) && !r->l->stiffness) small_count_near(r);
            take_bodies(r), small_set_rates(r), small_walls_set(r);
            if ((!o->bare || o->bound > 0) && small_error_init(r, failure)) break;
            if (r->meets && small_points_init(r, r->l->surface, o->threads, failure)) break;
            if (o->warm && !small_list_recall(r->l, r->p, 1 / (double)r->n)) {
                failure_set(failure, EX_SOFTWARE, "no memory for small steps");
                break;
            }
            small_bonds_recall(r, o->warm);
            if (!small_springs_recall(r)) {
                failure_set(failure, EX_SOFTWARE, "no memory for the bonds");
                break;
            }
            r->gains = small_gain_is_bounded(r);
            const struct small_bonds ties = small_bonds_account(r);
            r->stored = ties.stored - ties.joined +
                        small_springs_sums(r).stored; // bridges that are new are of this interval
        }
        r->stop = false;
        team_do(o->threads, small_loop, r);
        if (r->part && !r->lost) r->lost = !small_part_collect(r);
        if (r->lost) failure_set(failure, EX_SOFTWARE, "no memory for small steps");
        for (int64_t i = 0; i < r->p->n; i++) {
            r->x[i] = small_vec(r->l->s.place[i].x);
            r->v[i] = small_vec(r->l->s.body[i].v);
        }
        r->strays = 0;
    }
    small_walls_set(r);
    if (r->cell.moves) small_cell_images(r, 0, 1);
    return failure->status;
}

/* ---- its report ---- */

struct small_energy {
    double kinetic, potential, peculiar;
    vec3 momentum;
};

static struct small_energy small_energy_of(const struct packing *p)
{
    struct small_energy e = { .peculiar = energy_has_peculiar(p) ? energy_peculiar(p, NULL) : 0 };
    for (int64_t i = 0; i < p->n; i++) {
        const double m = p->mass[i];
        if (!(m > 0)) continue;
        e.kinetic +=
            0.5 * (m * v3_dot(p->v[i], p->v[i]) + rotation_energy2(p, i, p->q[i], p->w[i]));
        e.potential -= m * v3_dot(p->g, p->x[i]);
        e.momentum = v3_axpy(e.momentum, m, p->v[i]);
    }
    e.kinetic += small_loads_energy(p) + small_stress_energy(p);
    return e;
}

/* Dissipation is what the other terms leave. */
static void small_balance(struct balance *b, const struct small_energy *before,
                          const struct small_energy *after, struct small_run *r)
{
    const struct small_bonds ties = small_bonds_account(r);
    const struct small_list *l = r->l;
    vec3 impulse = v3(0, 0, 0);
    *b = (struct balance){ .kinetic = after->kinetic, .potential = after->potential };
    b->change = after->kinetic - before->kinetic;
    b->gravity = before->potential - after->potential;
    const struct small_pull pulls = small_pull_sum(r);
    b->drives = pulls.carried + r->cell.work, b->loads = pulls.work + r->loads.work + r->cell.loads;
    impulse = v3_add(impulse, small_vec(pulls.impulse));
    b->peculiar = after->peculiar, b->peculiar_change = after->peculiar - before->peculiar;
    for (int64_t i = 0; i < l->touches; i++) {
        const struct small_touch *t = &l->touch[i];
        b->drives -= t->work;
        impulse = v3_add(impulse, v3_add(small_vec(t->sum), small_vec(t->f)));
    }
    for (int64_t i = 0; i < l->meetings.n; i++) {
        const struct small_meeting *m = &l->meetings.of[i];
        b->drives -= m->work;
        impulse = v3_add(impulse, small_meeting_impulse(m, l->s.body));
    }
    const struct small_spring_sums springs = small_springs_sums(r),
                                   points = small_springs_points(r, l->s.body);
    b->bond_energy = ties.stored + springs.stored + points.stored;
    b->bond_change = b->bond_energy - r->stored;
    b->broken = springs.broken + points.broken - ties.joined;
    b->dissipation = b->gravity + b->drives + b->loads - b->change - b->bond_change - b->broken;
    small_array(b->momentum, after->momentum), small_array(b->impulse, impulse);
}

/* What the report has been given before the step, and nothing of another step */
static void small_report(struct report *rep, const struct small_run *r, const struct contacts *s,
                         bool bare)
{
    *rep = (struct report){ .options = rep->options,
                            .criterion = rep->criterion,
                            .eps = rep->eps,
                            .detection = rep->detection,
                            .method = "small",
                            .step = r->p->step,
                            .t = r->p->t,
                            .err = { .contacts = s->n, .max_overlap = contacts_max_overlap(s) },
                            .balanced = !bare,
                            .fine = true,
                            .judged = rep->judged,
                            .converged = true,
                            .sweeps = (int32_t)r->sweeps,
                            .substeps = 1,
                            .soft = packing_has_springs(r->p),
                            .tied = r->p->law != NULL,
                            .sheared = energy_has_peculiar(r->p),
                            .small = r->n,
                            .small_limited = r->unsolved };
}

int64_t small_parts(const struct packing *p, double overlap)
{
    const double way = p->dt * (small_fastest(p) + packing_most_fall(p));
    const double n = way / (4 * overlap * small_sizes(p).least);
    return (int64_t)ceil(fmin(fmax(1, n), PARTS_MOST));
}

int small_advance(struct packing *p, struct contacts *s, struct small_list *l,
                  const struct small_opt *o, struct report *rep, bool *made,
                  struct failure *failure)
{
    const double cpu = report_seconds(CLOCK_CPU), elapsed = report_seconds(CLOCK_WALL);
    const struct packing whole = *p;
    *made = false;
    if (packing_check_clock(p, failure)) return failure->status;
    const struct whole sizes = packing_whole(p); // radii, which are asked for many times
    if (!p->whole) p->whole = &sizes;
    const int64_t count = small_count(p, o->overlap);
    p->whole = whole.whole;
    if (!count) return 0;
    const size_t n = (size_t)p->n + 1;
    packing_wrap(p, NULL);
    if (touching_bond(p, failure)) return failure->status;
    const struct small_energy before = small_energy_of(p);
    struct small_run r = { .p = p, .l = l, .lock = PTHREAD_MUTEX_INITIALIZER };
    if (o->part && o->part->ranks->n > 1) r.part = o->part;
    r.n = count, r.overlap = o->overlap, r.kernel = backend_widest()->small;
    r.bound = o->bound, r.compares = o->compare && !o->bare;
    r.h = p->dt / (double)r.n, r.ahead = (1 - p->theta) * r.h;
    r.wall = calloc((size_t)p->walls + 1, sizeof *r.wall);
    r.x = calloc(n, sizeof *r.x), r.v = calloc(n, sizeof *r.v);
    r.turned = calloc(n, sizeof *r.turned);
    p->dt = r.h, p->t0 = p->t, p->step0 = p->step;
    if (!p->whole) p->whole = &sizes;
    r.meets = small_has_shapes(p) || p->mesh.elements, r.thin = small_sizes(p).least;
    r.bonds = r.meets && packing_adheres(p);
    small_cell_init(&r);
    if (!r.wall || !r.x || !r.v || !r.turned)
        failure_set(failure, EX_SOFTWARE, "no memory for small steps");
    else if (!neighbours_surfaces(o->near, p, failure) && !small_pull_init(&r, failure) &&
             !small_sums_init(&r, failure) && !small_loads_init(&r, failure))
        small_steps(&r, o, rep, failure);
    p->dt = whole.dt, p->t0 = whole.t0, p->step0 = whole.step0, p->whole = whole.whole;
    r.failed = r.failed || (!failure->status && !small_is_finite(&r));
    *made = !failure->status && !r.failed && !servo_box_check_growth(p, failure);
    if (*made && r.meets) small_points_last(&r);
    // grains that break need the reactions of each step
    const bool reads = !r.part || !r.part->ranks->me || r.uneven; // others need no contacts
    if (*made && reads && !small_give_contacts(&r, s, o->bare && !p->breakage, failure))
        *made = !r.uneven || !small_error_crushes(&r, s, o->overlap);
    if (*made && !failure->status && !small_bonds_keep(&r, failure) &&
        !small_bonds_laws(s, p, failure) &&
        !(o->warm && small_list_remember(l, p, 1 / (double)r.n, failure))) {
        give_bodies(&r), small_sums_give(&r);
        for (int k = 0; k < 3 && r.cell.moves; k++)
            p->cell.edge[k] = r.cell.cell.edge[k], p->cell.rate[k] = r.cell.cell.rate[k];
        memory_set(&p->memory, o->warm);
        p->step++, p->t = packing_time(p, p->step);
        const struct small_energy after = small_energy_of(p);
        small_report(rep, &r, s, o->bare);
        small_error_give(&r, rep), small_error_approach(&r, s, o->overlap, rep);
        small_balance(&rep->balance, &before, &after, &r);
        depth_of(&rep->depth, p, s, NULL, failure);
    } else {
        p->t = whole.t;
    }
    rep->seconds = report_seconds(CLOCK_CPU) - cpu - rep->detection;
    rep->elapsed = report_seconds(CLOCK_WALL) - elapsed;
    small_loads_free(&r, !*made), small_stress_free(&r);
    small_points_free(&r), small_error_free(&r);
    l->part = NULL;
    free(r.wall), free(r.x), free(r.v), free(r.turned), free(r.pull), free(r.sums);
    return failure->status;
}
