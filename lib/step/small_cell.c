/* step/small_cell.c: a cell that moves, in small steps [step/small_cell.h]. */
#include "step/small_cell.h"

#include <math.h>
#include <stdlib.h>

/* The mass of an edge over what its contacts push back with, so that it can follow them a small step later */
#define LIGHT 0.6
/* Over that of a layer of grains: a heavier edge swings in the packing */
#define HEAVY 0.7

bool small_cell_moves(const struct packing *p)
{
    bool any = false;
    for (int k = 0; k < 3; k++) any = any || (p->cell.repeats[k] && cell_moves(&p->cell, k));
    return any;
}

/* 1/s: of edges with these rates (m/s) */
static double strain_of(const vec3 edge[3], const vec3 rate[3])
{
    double sum = 0;
    vec3 inverse[3];
    cell_inverse(edge, inverse);
    for (int k = 0; k < 3; k++) sum += v3_norm(rate[k]) * v3_norm(inverse[k]);
    return sum;
}

double small_cell_strain(const struct packing *p)
{
    return small_cell_moves(p) ? strain_of(p->cell.edge, p->cell.rate) : 0;
}

double small_cell_speed(const struct packing *p)
{
    struct cell_flow flow;
    double most = 0;
    if (p->walls || !small_cell_moves(p)) return packing_whole(p).speed;
    cell_flow_init(&flow, &p->cell, p->cell.edge, p->cell.rate);
    for (int64_t i = 0; i < p->n; i++) {
        vec3 v = p->v[i];
        if (flow.changes) v = v3_sub(v, cell_flow_gain(&flow, p->x[i]));
        most = fmax(most, v3_norm(v));
    }
    return most + small_cell_strain(p) * packing_whole(p).large;
}

/* Mass (kg) and number of bodies that move, and how many do not */
static double mass_of(const struct packing *p, int64_t *n, int64_t *fixed)
{
    double mass = 0;
    *n = *fixed = 0;
    for (int64_t i = 0; i < p->n; i++) {
        if (p->mass[i] > 0)
            mass += p->mass[i], ++*n;
        else
            ++*fixed;
    }
    return mass;
}

/* Has every pair of materials friction? */
static bool rubs(const struct packing *p)
{
    for (int32_t k = 0; k < p->materials * p->materials; k++)
        if (!(p->mu[k] > 0)) return false;
    return true;
}

const char *small_cell_lacks(const struct packing *p)
{
    const struct cell *c = &p->cell;
    int64_t n, fixed;
    const double mass = mass_of(p, &n, &fixed), d = 2 * packing_whole(p).large;
    const double row =
        p->dim == 2 ? 1 : cbrt((double)n); // bodies along it, over those of a layer in 2D
    const double layer = p->dim == 2 ? mass / sqrt((double)n) : mass / cbrt((double)n);
    bool fits = true;
    double size2 = 0;
    if (!cell_yields(c)) return NULL;
    if (fixed || !n) return "a cell under a stress and fixed bodies";
    if (!rubs(p)) return "a cell under a stress without friction";
    for (int k = 0; k < 3; k++) size2 += k < p->dim ? v3_dot(c->edge[k], c->edge[k]) : 0;
    for (int k = 0; k < 9; k++) {
        const double m = c->mass[k / 3][k % 3];
        if (m > 0) fits = fits && m >= LIGHT * row * mass / (double)n && m <= HEAVY * layer;
    }
    if (c->size_mass > 0)
        fits = fits && c->size_mass >= 5 * LIGHT * mass * d * d &&
               c->size_mass <= HEAVY * layer * size2;
    return fits ? NULL : "a cell under a stress with masses far from the default";
}

double small_cell_presses(const struct packing *p)
{
    const struct cell *c = &p->cell;
    int64_t n, fixed;
    const double mass = mass_of(p, &n, &fixed), d = 2 * packing_whole(p).large;
    double most = fabs(c->mean), volume = v3_dot(c->edge[0], v3_cross(c->edge[1], c->edge[2]));
    if (!cell_yields(c) || !(mass > 0)) return 0;
    if (p->dim == 2) volume /= v3_norm(c->edge[2]);
    for (int k = 0; k < 9; k++) most = fmax(most, fabs(c->stress[k / 3][k % 3]));
    return most * cell_factor_most(c) * fabs(volume) / (d * mass);
}

double small_cell_energy(const struct packing *p)
{
    const struct cell *c = &p->cell;
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const vec3 v = c->rate[k];
        const double *m = c->mass[k];
        sum += 0.5 * (m[0] * v.x * v.x + m[1] * v.y * v.y + m[2] * v.z * v.z);
    }
    const double growth = c->size_mass > 0 ? cell_growth(c, step_after(p)) : 0;
    return sum + 0.5 * c->size_mass * growth * growth;
}

int small_cell_init(struct small_run *r, struct failure *failure)
{
    struct small_cell *c = &r->cell;
    c->moves = small_cell_moves(r->p), c->relative = c->moves && !r->p->walls;
    c->cell = r->p->cell;
    cell_predict(&c->cell, r->ahead, c->edge);
    if (!cell_yields(&c->cell)) return 0;
    c->stress = calloc(CELL_PARTS, sizeof *c->stress);
    return c->stress ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for the stress");
}

void small_cell_free(struct small_run *r)
{
    free(r->cell.stress);
    r->cell.stress = NULL;
}

void small_cell_begin(struct small_run *r)
{
    struct small_cell *c = &r->cell;
    const double after = r->h - r->ahead;
    vec3 gain[3];
    cell_predict(&c->cell, r->ahead, c->edge);
    cell_next_rate(&c->cell, r->p->t + r->h, r->ahead, after, c->next);
    for (int k = 0; k < 3; k++) gain[k] = v3_sub(c->next[k], c->cell.rate[k]);
    cell_flow_init(&c->flow, &c->cell, c->edge, gain);
    cell_flow_init(&c->peculiar, &c->cell, c->edge, c->cell.rate);
    c->strain = strain_of(c->edge, c->next);
}

void small_cell_images(struct small_run *r, int me, int threads)
{
    const struct small_list *l = r->l;
    const struct small_cell *c = &r->cell;
    for (int64_t i = l->images * me / threads; i < l->images * (me + 1) / threads; i++) {
        const struct pair *q = &l->pairs.pair[l->image[i]];
        const int64_t slot = l->slot[l->image[i]];
        small_shift_set(&l->s.shift[slot / BUNDLE], (int)(slot % BUNDLE),
                        cell_shift(c->edge, q->shift), cell_shift(c->next, q->shift));
    }
}

vec3 small_cell_peculiar(const struct small_run *r, vec3 x, vec3 v)
{
    const struct small_cell *c = &r->cell;
    return c->relative && c->peculiar.changes ? v3_sub(v, cell_flow_gain(&c->peculiar, x)) : v;
}

double small_cell_stretch(const struct small_run *r)
{
    const struct small_cell *c = &r->cell;
    double rate = 0;
    if (!c->moves) return 0;
    if (c->relative) return c->strain * (packing_whole(r->p).large + 0.5 * r->l->margin);
    for (int k = 0; k < 3; k++) rate += v3_norm(c->next[k]);
    return 0.5 * rate;
}

static void add_dyad(double to[3][3], vec3 f, vec3 d)
{
    const double a[3] = { f.x, f.y, f.z }, b[3] = { d.x, d.y, d.z };
    for (int k = 0; k < 9; k++) to[k / 3][k % 3] += a[k / 3] * b[k % 3];
}

/* Does the pair push, or is it held? */
static bool slot_acts(const struct small *s, int64_t slot)
{
    const struct small_bundle *c = &s->bundle[slot / BUNDLE];
    const int k = (int)(slot % BUNDLE);
    return c->f[0][k] != 0 || c->f[1][k] != 0 || c->f[2][k] != 0 ||
           (s->hold && s->hold[slot / BUNDLE].x[HOLD_PULL][k] > 0);
}

void small_cell_stress(struct small_run *r, int me, int threads)
{
    const struct small_list *l = r->l;
    const struct small *s = &l->s;
    for (int part = me; part < CELL_PARTS; part += threads) {
        double(*to)[3] = r->cell.stress[part];
        const int64_t end = l->pairs.n * (part + 1) / CELL_PARTS;
        for (int k = 0; k < 9; k++) to[k / 3][k % 3] = 0;
        for (int64_t i = l->pairs.n * part / CELL_PARTS; i < end; i++)
            if (slot_acts(s, l->slot[i]))
                add_dyad(to, small_slot_force(s, l->slot[i]), small_branch(s, l->slot[i]));
    }
}

/* Touches with walls, which count from the cell's origin */
static void add_touch_stress(const struct small_run *r, double to[3][3])
{
    for (int64_t i = 0; i < r->l->touches; i++) {
        const struct small_touch *t = &r->l->touch[i];
        const vec3 x = small_vec(r->l->s.place[t->body].x);
        const vec3 f = v3_axpy(small_vec(t->f), -t->hold[HOLD_PULL], t->n);
        if (t->near) add_dyad(to, f, v3_sub(x, r->cell.cell.origin));
    }
}

/* What reactions and stresses make of the rates; gain (m/s): that */
static void yield_edges(struct small_run *r, vec3 gain[3])
{
    struct small_cell *c = &r->cell;
    double T[3][3] = { { 0 } };
    for (int part = 0; part < CELL_PARTS; part++)
        for (int k = 0; k < 9; k++) T[k / 3][k % 3] += c->stress[part][k / 3][k % 3];
    add_touch_stress(r, T);
    for (int32_t k = 0; k < r->loads.list.n; k++) {
        const struct freedom *f = &r->loads.list.f[k];
        const vec3 row[3] = { small_vec(T[0]), small_vec(T[1]), small_vec(T[2]) };
        double got = T[0][0] + T[1][1] + (r->p->dim == 3 ? T[2][2] : 0);
        if (!freedom_of_cell(f)) continue;
        if (f->wall == -1)
            got =
                v3_dot(f->inverse, v3_axpy(v3_axpy(v3_scale(f->axis.x, row[0]), f->axis.y, row[1]),
                                           f->axis.z, row[2]));
        const double change = (r->h * f->force + got) / f->mass, mean = f->speed + 0.5 * change;
        freedom_gain(f, change, gain);
        r->loads.work += r->h * f->force * mean, c->work += got * mean;
    }
}

void small_cell_follow(struct small_run *r, int64_t first, int64_t end)
{
    for (int64_t i = first; i < end && r->cell.yield.changes; i++) {
        struct body *b = &r->l->s.body[i];
        struct small_pull *y = &r->pull[i];
        double gain[3];
        if (!(b->im > 0)) continue;
        small_array(gain, cell_flow_gain(&r->cell.yield, small_vec(r->l->s.place[i].x)));
        for (int k = 0; k < 3; k++) {
            y->carried += 0.5 * r->p->mass[i] * gain[k] * b->v[k];
            y->impulse[k] += r->p->mass[i] * gain[k];
            b->v[k] += gain[k], y->dv[k] += gain[k], y->gain[k] += gain[k];
        }
    }
}

/* J: what edges do by the image that has got f (N s) */
static double image_work(const struct small_cell *c, const int8_t shift[3], vec3 f)
{
    const vec3 twice = v3_add(cell_shift(c->cell.rate, shift), cell_shift(c->next, shift));
    return -0.5 * v3_dot(f, twice);
}

void small_cell_end(struct small_run *r)
{
    vec3 gain[3] = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } };
    const struct small_list *l = r->l;
    struct small_cell *c = &r->cell;
    if (c->stress) yield_edges(r, gain);
    cell_flow_init(&c->yield, &c->cell, c->edge, gain);
    for (int k = 0; k < 3; k++) c->next[k] = v3_add(c->next[k], gain[k]);
    for (int64_t i = 0; i < l->meetings.n; i++) {
        const struct small_meeting *m = &l->meetings.of[i];
        for (int64_t k = 0; m->key.a >= 0 && k < m->points; k++)
            if (m->point[k].near) c->work += image_work(c, m->key.shift, small_vec(m->point[k].f));
    }
    for (int64_t i = 0; i < l->images; i++) {
        const struct pair *q = &l->pairs.pair[l->image[i]];
        c->work += image_work(c, q->shift, small_slot_force(&l->s, l->slot[l->image[i]]));
    }
    cell_move(&c->cell, r->ahead, r->h - r->ahead, c->next);
    for (int k = 0; k < 3; k++)
        r->p->cell.edge[k] = c->cell.edge[k], r->p->cell.rate[k] = c->cell.rate[k];
    cell_predict(&c->cell, r->ahead, c->edge);
}
