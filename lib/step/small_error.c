/* step/small_error.c: what is missing of the reactions of small steps [step/small_error.h]. */
#include "step/small_error.h"

#include "base/team.h"
#include "state/kinematics.h"
#include "step/small_part.h"
#include "step/small_point.h"
#include "step/small_touch.h"
#include "step/small_wall.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int small_error_init(struct small_run *r, struct failure *failure)
{
    struct small *s = &r->l->s;
    const size_t n = (size_t)r->p->n + 2;
    double *all = calloc(2 * n, sizeof *all);
    s->missing = all, s->load = all ? all + n : NULL, r->judged = true;
    if (r->bound > 0) r->missing = calloc(2 * n, sizeof *r->missing);
    return all && (r->missing || !(r->bound > 0))
               ? 0
               : failure_set(failure, EX_SOFTWARE, "no memory for errors");
}

void small_error_free(struct small_run *r)
{
    struct small *s = &r->l->s;
    free(s->missing), free(r->missing);
    s->missing = s->load = r->missing = NULL, r->judged = false;
}

static void judge_touches(struct small_run *r, int64_t first, int64_t end)
{
    struct small *s = &r->l->s;
    const int64_t last = small_list_touch(r->l, end, 0);
    for (int64_t i = small_list_touch(r->l, first, 0); i < last; i++) {
        const struct small_touch *t = &r->l->touch[i];
        struct small_law l;
        double df[3];
        if (!t->near || !small_is_own(r, t->body)) continue;
        small_touch_law(r, t, &l);
        s->load[t->body] += norm3(l.f);
        small_touch_solve(t, &l, r->h, df);
        s->missing[t->body] += norm3(df);
    }
}

void small_error_step(struct small_run *r, int me, int threads)
{
    struct small *s = &r->l->s;
    const int64_t n = s->bodies;
    if (r->part && !me) small_part_refresh(r);
    if (r->part) team_meet();
    judge_touches(r, n * me / threads, n * (me + 1) / threads);
    team_meet();
    if (r->meets) small_points_judge(r, me, threads);
    for (int64_t g = 0; g < s->serial; g++) {
        const int64_t at = s->group[g], some = s->group[g + 1] - at;
        r->kernel->judge(s, at + some * me / threads, at + some * (me + 1) / threads);
        team_meet();
    }
    if (!me) r->kernel->judge(s, s->group[s->serial], s->group[s->groups]);
    team_meet();
}

/* N s: the load of body i, its weight in n small steps at least; 0: a body that does not move */
static double small_error_load(const struct small_run *r, int64_t i, const double *load, double n)
{
    const struct packing *p = r->p;
    return p->mass[i] > 0 ? fmax(load[i], p->mass[i] * packing_most_fall(p) * n) : 0;
}

bool small_error_exceeds(struct small_run *r, int me, int threads)
{
    struct small *s = &r->l->s;
    double *const missing = s->missing, *const load = s->load;
    const size_t n = (size_t)s->bodies + 2;
    double off = 0, all = 0;
    team_meet();
    if (!me) {
        memset(r->missing, 0, 2 * n * sizeof *r->missing);
        s->missing = r->missing, s->load = r->missing + n;
    }
    team_meet();
    small_error_step(r, me, threads);
    for (int64_t i = 0; !me && i < s->bodies; i++) {
        const double carries = small_error_load(r, i, s->load, 1);
        if (carries > 0 && s->missing[i] > 0) off += s->missing[i], all += carries;
    }
    if (!me) s->missing = missing, s->load = load, r->exceeds = off > r->bound * all;
    team_meet();
    return r->exceeds;
}

void small_error_give(const struct small_run *r, struct report *rep)
{
    const struct packing *p = r->p;
    const struct small *s = &r->l->s;
    double missing = 0, load = 0;
    for (int64_t i = 0; r->judged && i < p->n; i++) {
        const double carries = small_error_load(r, i, s->load, (double)r->n);
        if (!(s->missing[i] > 0) || !(carries > 0)) continue;
        missing += s->missing[i], load += carries;
        if (s->missing[i] > rep->missing * carries)
            rep->missing = s->missing[i] / carries, rep->missing_id = p->id[i];
    }
    if (load > 0) rep->missing_mean = missing / load;
    rep->compared = r->compared, rep->distance = r->distance;
}

/* Times the permitted overlap */
#define CRUSHED 3

bool small_error_crushes(const struct small_run *r, const struct contacts *s, double permitted)
{
    const struct packing *p = r->p;
    for (int64_t i = 0; i < s->n; i++) {
        const struct contact *c = &s->c[i];
        if (packing_springs(p, c)) continue;
        const double small = c->a < 0 ? p->radius[c->b] : fmin(p->radius[c->a], p->radius[c->b]);
        const vec3 a = c->a < 0 ? r->wall[-1 - c->a].v : small_vec(r->l->s.body[c->a].v);
        const double approach = v3_dot(c->n, v3_sub(a, small_vec(r->l->s.body[c->b].v)));
        if (-c->gap > CRUSHED * permitted * small && approach > r->l->s.rate.push) return true;
    }
    return false;
}

void small_error_approach(const struct small_run *r, const struct contacts *s, double permitted,
                          struct report *rep)
{
    const struct packing *p = r->p;
    double worst = 0;
    for (int64_t i = 0; i < s->n; i++) {
        const struct contact *c = &s->c[i];
        if (!(c->gap < 0) || packing_springs(p, c)) continue; // springs part these
        const double small = c->a < 0 ? p->radius[c->b] : fmin(p->radius[c->a], p->radius[c->b]);
        const double approach = -opening_of(p, c, 0), depth = -c->gap / small;
        if (c->gap + r->h * approach > 0)
            continue; // it has closed in the last small step, and impacts in the next
        rep->err.max_penetration_true = fmax(rep->err.max_penetration_true, approach);
        if (approach <= r->l->s.rate.push || depth <= fmax(worst, CRUSHED * permitted)) continue;
        worst = depth, rep->converged = false;
        rep->unsolved[0] = c->a < 0 ? c->a : p->id[c->a], rep->unsolved[1] = p->id[c->b];
    }
}
