/* step/project.c: overlaps taken out of positions [step/project.h]. */
#include "step/project.h"

#include "base/team.h"
#include "state/freedom.h"
#include "state/kinematics.h"

#include <stdlib.h>
#include <string.h>

/* ---- the level of each contact, and a counting sort by it ---- */

/* level[i] of every contact; returns the number of levels. after[bodies]: one above the highest level of a body's
   contacts so far. */
static int32_t project_find(const struct contacts *s, int32_t *after, int32_t *level)
{
    int32_t n = 0;
    for (int64_t i = 0; i < s->n; i++) {
        int32_t a = s->c[i].a, b = s->c[i].b, at = after[b];
        if (a >= 0 && after[a] > at) at = after[a];
        level[i] = at++;
        after[b] = at;
        if (a >= 0) after[a] = at;
        if (at > n) n = at;
    }
    return n;
}

int levels_init(struct levels *l, const struct contacts *s, int64_t bodies)
{
    *l = (struct levels){ 0 };
    int32_t *after = calloc((size_t)bodies + 1, sizeof *after);
    int32_t *level = malloc((size_t)(s->n + 1) * sizeof *level);
    l->contact = malloc((size_t)(s->n + 1) * sizeof *l->contact);
    int32_t n = after && level && l->contact ? project_find(s, after, level) : 0;
    int64_t *at = calloc((size_t)n + 2, sizeof *at);
    bool room = after && level && l->contact && at;
    for (int64_t i = 0; room && i < s->n; i++) at[level[i] + 2]++;
    for (int32_t k = 0; room && k < n; k++) at[k + 2] += at[k + 1];
    for (int64_t i = 0; room && i < s->n; i++) l->contact[at[level[i] + 1]++] = (int32_t)i;
    free(after), free(level);
    if (!room) return free(at), -1;
    l->first = at, l->n = n;
    return 0;
}

void levels_free(struct levels *l)
{
    free(l->first), free(l->contact);
    *l = (struct levels){ 0 };
}

enum {
    PER_THREAD = 2048, /* contacts or bodies that are worth a thread */
    LEVEL_LEAST =
        64,     /* contacts of a mean level from which threads share it: 0.5 us for each of two */
    SWEEPS = 10 /* per step, at most: a tenth of what its solve costs */
};

/* Of the smaller radius: contacts keep an overlap, so that rounding does not open them */
#define SLOP 1e-6
/* Of the smaller radius: what a contact is moved apart in a step, at most; normals turn
   otherwise */
#define MOST 0.1
/*
 * Of the smaller radius, and of the overlap: what a contact is moved apart, at least. More opens others so
 * far that the next step does not know them, and under a pressure each of these becomes an overlap. Two
 * bodies that are moved apart by twice OVERLAP_NEAR go by that each.
 */
#define LITTLE (2 * OVERLAP_NEAR)
#define SHARE  0.25
/* Of the slop: changes that are not worth another sweep */
#define ENOUGH 0.01

/* One contact's part: lambda >= 0 keeps gap + n . (d_b - d_a) >= 0. */
struct projected_contact {
    int32_t a, b; /* bodies; a < 0: a wall */
    vec3 n;
    double gap;    /* m: at the next predicted position, above the slop */
    double w;      /* 1/kg: 1/m_a + 1/m_b, and what freedoms add */
    double lambda; /* kg m */
    double slop;   /* m */
};

/* m: as much of what overlaps as a step may remove */
static double removed(double overlap, double small)
{
    return dmin(overlap, dmin(dmax(LITTLE * small, SHARE * overlap), MOST * small));
}

/* The part of a contact; the slop is what gravity overlaps in a step, and more than rounding. */
static struct projected_contact projected_contact_of(const struct packing *p,
                                                     const struct contact *c)
{
    double small = c->a < 0 ? p->radius[c->b] : dmin(p->radius[c->a], p->radius[c->b]);
    double slop = SLOP * small + v3_norm(p->g) * p->dt * p->dt;
    double gap = c->gap + p->dt * opening_of(p, c, -step_after(p)) + slop;
    return (struct projected_contact){ .a = c->a,
                                       .b = c->b,
                                       .n = c->n,
                                       .gap = gap < 0 ? -removed(-gap, small) : gap,
                                       .w = packing_inverse_mass(p, c->a) +
                                            packing_inverse_mass(p, c->b),
                                       .slop = slop };
}

/* The displacements sought: of bodies, and along the axes of freedoms beyond theirs */
struct displacements {
    struct displaced *d; /* [n] */
    struct freedoms freedoms;
    double *z; /* [freedoms.n] m */
};

/* How much freedom k opens a contact, per m along its axis; one that turns does not, to first
   order */
static double opens(const struct displacements *o, int32_t k, const struct packing *p,
                    const struct contact *c)
{
    const struct freedom *f = &o->freedoms.f[k];
    return f->turns ? 0 : v3_dot(c->n, freedom_direction(f, p, c, 0, p->cell.edge));
}

/* Changes lambda and d so that this gap is 0, or lambda is; returns whether that changed much. */
static inline bool relax(struct projected_contact *k, const struct packing *p,
                         const struct contact *c, struct displacements *o)
{
    struct displaced *a = k->a < 0 ? NULL : &o->d[k->a], *b = &o->d[k->b];
    double gap = k->gap + v3_dot(k->n, b->d) - (a ? v3_dot(k->n, a->d) : 0);
    for (int32_t f = 0; f < o->freedoms.n; f++) gap += opens(o, f, p, c) * o->z[f];
    if (k->lambda == 0 && gap >= 0) return false; // as most are, without a quotient to wait for
    double lambda = dmax(0, k->lambda - gap / k->w), more = lambda - k->lambda;
    if (more == 0) return false;
    k->lambda = lambda;
    b->d = v3_axpy(b->d, more * b->im, k->n);
    if (a) a->d = v3_axpy(a->d, -more * a->im, k->n);
    for (int32_t f = 0; f < o->freedoms.n; f++)
        o->z[f] += more * opens(o, f, p, c) / o->freedoms.f[f].mass;
    return fabs(more) * k->w > ENOUGH * k->slop;
}

/* Parts that are made */
struct project_making {
    const struct packing *p;
    const struct contacts *s;
    const struct displacements *o;
    struct projected_contact *part;
    _Atomic bool any; /* gap is below 0 */
};

static void make_some(void *arg, int64_t first, int64_t end)
{
    struct project_making *m = arg;
    const struct displacements *o = m->o;
    bool any = false;
    for (int64_t i = first; i < end; i++) {
        const struct contact *c = &m->s->c[i];
        m->part[i] = projected_contact_of(m->p, c);
        for (int32_t k = 0; k < o->freedoms.n; k++) {
            double J = opens(o, k, m->p, c);
            m->part[i].w += J * J / o->freedoms.f[k].mass;
        }
        if (m->s->law && m->s->law[i].spring[0] > 0)
            m->part[i].gap = m->part[i].w = 0; // its springs part them
        any |= m->part[i].gap < 0;
    }
    if (any) m->any = true;
}

/* The parts; whether any gap is below 0 */
static bool parts_make(const struct packing *p, const struct contacts *s,
                       const struct displacements *o, struct projected_contact *part)
{
    struct project_making m = { p, s, o, part, false };
    team_share(team_size(), s->n, PER_THREAD, make_some, &m);
    return m.any;
}

/* Bodies that are displaced, or about to be */
struct shifting {
    struct packing *p;
    struct displaced *d;
};

static void begin_some(void *arg, int64_t first, int64_t end)
{
    const struct shifting *y = arg;
    for (int64_t i = first; i < end; i++)
        y->d[i] = (struct displaced){ { 0, 0, 0 }, packing_inverse_mass(y->p, (int32_t)i) };
}

static void shift_some(void *arg, int64_t first, int64_t end)
{
    const struct shifting *y = arg;
    for (int64_t i = first; i < end; i++) y->p->x[i] = v3_add(y->p->x[i], y->d[i].d);
}

static void displace(struct packing *p, const struct displacements *o)
{
    struct shifting y = { p, o->d };
    freedoms_displace(&o->freedoms, p, o->z);
    team_share(team_size(), p->n, PER_THREAD, shift_some, &y);
}

/* What has moved the bodies from x[n] to where they are; own[n] or NULL: those that count */
static struct projected projected_from(const vec3 *x, const struct packing *p, const bool *own)
{
    struct projected did = { 0 };
    for (int64_t i = 0; i < p->n; i++) {
        double m = !own || own[i] ? p->mass[i] : 0;
        vec3 d = v3_sub(p->x[i], x[i]), spin = v3_cross(d, p->v[i]);
        if (!(m > 0)) continue;
        did.work -= m * v3_dot(p->g, d);
        did.spin[0] += m * spin.x, did.spin[1] += m * spin.y, did.spin[2] += m * spin.z;
    }
    return did;
}

/* Sweeps over the parts */
struct relaxing {
    const struct packing *p;
    const struct contacts *s;
    struct displacements *o;
    struct projected_contact *part;
    struct levels levels;
    int sweeps;           /* at most */
    _Atomic bool more[3]; /* whether a sweep has changed much: of every third one */
};

/* One sweep in the order of the contacts; returns whether it has changed much */
static bool project_sweep(const struct relaxing *y)
{
    bool more = false;
    for (int64_t i = 0; i < y->s->n; i++)
        if (y->part[i].w > 0 && relax(&y->part[i], y->p, &y->s->c[i], y->o)) more = true;
    return more;
}

/* All sweeps, each level of which the threads share */
static void sweep_levels(void *arg, int me, int threads)
{
    struct relaxing *y = arg;
    const struct levels *l = &y->levels;
    for (int k = 0; k < y->sweeps; k++) {
        bool more = false;
        for (int64_t g = 0; g < l->n; g++) {
            int64_t first = l->first[g], n = l->first[g + 1] - first;
            for (int64_t j = first + n * me / threads; j < first + n * (me + 1) / threads; j++) {
                int32_t i = l->contact[j];
                if (y->part[i].w > 0 && relax(&y->part[i], y->p, &y->s->c[i], y->o)) more = true;
            }
            if (g == l->n - 1) {
                if (me == 0) y->more[(k + 1) % 3] = false; // which all have read, two sweeps ago
                if (more) y->more[k % 3] = true;
            }
            team_meet();
        }
        if (!y->more[k % 3]) return;
    }
}

/* By all threads, where levels are large enough; false where one thread shall do it */
static bool relax_in_threads(struct relaxing *y)
{
    bool shared = team_size() > 1 && y->s->n >= PER_THREAD && !y->o->freedoms.n &&
                  !levels_init(&y->levels, y->s, y->p->n) && y->s->n >= LEVEL_LEAST * y->levels.n;
    if (shared) team_do(team_size(), sweep_levels, y);
    levels_free(&y->levels);
    return shared;
}

int project_apart(struct packing *p, const struct contacts *s, struct projected *did,
                  struct failure *failure)
{
    return project_shared(p, s, NULL, did, failure);
}

int project_shared(struct packing *p, const struct contacts *s, const struct project_share *share,
                   struct projected *did, struct failure *failure)
{
    vec3 *was = did ? malloc(((size_t)p->n + 1) * sizeof *was) : NULL;
    struct displacements o = { .d = malloc(((size_t)p->n + 1) * sizeof *o.d) };
    struct projected_contact *part = malloc(((size_t)s->n + 1) * sizeof *part);
    bool room = part && o.d && (was || !did) &&
                !freedoms_init(&o.freedoms, p, p->cell.edge, false, failure);
    room = room && (o.z = calloc((size_t)o.freedoms.n + 1, sizeof *o.z));
    if (!room) share = NULL; // the caller ends the others, who wait
    bool more = room && parts_make(p, s, &o, part);
    if (share) more = share->any(share->with, more);
    bool moves = more;
    struct shifting y = { p, o.d };
    if (more) team_share(team_size(), p->n, PER_THREAD, begin_some, &y);
    for (int64_t i = 0; share && i < s->n; i++) part[i].w *= share->brake[i];
    struct relaxing all = { .p = p, .s = s, .o = &o, .part = part, .sweeps = SWEEPS };
    if (more && !share && relax_in_threads(&all)) more = false;
    for (int k = 0; more && k < SWEEPS; k++) {
        more = project_sweep(&all);
        if (share) more = share->after_sweep(share->with, o.d, more);
    }
    if (did) *did = (struct projected){ 0 };
    if (moves && did) memcpy(was, p->x, (size_t)p->n * sizeof *was);
    if (moves) displace(p, &o);
    if (moves && did) *did = projected_from(was, p, share ? share->own : NULL);
    free(was), free(part), free(o.d), free(o.z);
    freedoms_free(&o.freedoms);
    return room ? 0 : failure_set(failure, EX_SOFTWARE, "no memory to move the bodies apart");
}
