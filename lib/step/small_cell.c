/* step/small_cell.c: a cell that moves, in small steps [step/small_cell.h]. */
#include "step/small_cell.h"

#include "step/small_stress.h"

#include <math.h>

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

/* 1/s: how fast the flow of the cell stretches at most */
static double small_cell_strain(const struct packing *p)
{
    return small_cell_moves(p) ? strain_of(p->cell.edge, p->cell.rate) : 0;
}

struct small_flow small_cell_flow(const struct packing *p)
{
    struct small_flow f = { 0 };
    if (p->walls || p->shape || !small_cell_moves(p)) return f;
    cell_flow_init(&f.flow, &p->cell, p->cell.edge, p->cell.rate);
    f.stretch = small_cell_strain(p) * packing_whole(p).large;
    return f;
}

double small_body_speed(const struct packing *p, const struct small_flow *f, int64_t i)
{
    vec3 v = p->v[i];
    if (packing_shape(p, i)) return v3_norm(v) + p->radius[i] * v3_norm(p->w[i]);
    if (f->flow.changes) v = v3_sub(v, cell_flow_gain(&f->flow, p->x[i]));
    return v3_norm(v) + f->stretch;
}

void small_cell_init(struct small_run *r)
{
    struct small_cell *c = &r->cell;
    c->yields = cell_yields(&r->p->cell);
    c->moves = small_cell_moves(r->p), c->relative = c->moves && !r->p->walls;
    c->cell = r->p->cell;
    cell_predict(&c->cell, r->ahead, c->edge);
}

void small_cell_begin(struct small_run *r)
{
    struct small_cell *c = &r->cell;
    const double after = r->h - r->ahead;
    vec3 gain[3];
    cell_predict(&c->cell, r->ahead, c->edge);
    cell_next_rate(&c->cell, r->p->t + r->h, r->ahead, after, c->next);
    if (c->yields) small_stress_begin(r);
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

/* J: what edges do by the image that has got f (N s) */
static double image_work(const struct small_cell *c, const int8_t shift[3], vec3 f)
{
    const vec3 twice = v3_add(cell_shift(c->cell.rate, shift), cell_shift(c->next, shift));
    return -0.5 * v3_dot(f, twice);
}

void small_cell_end(struct small_run *r)
{
    const struct small_list *l = r->l;
    struct small_cell *c = &r->cell;
    if (c->yields) small_stress_end(r);
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
    cell_predict(&c->cell, r->ahead, c->edge);
}
