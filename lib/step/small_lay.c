/* step/small_lay.c: the bundles of small steps [step/small_make.h]. */
#include "step/small_make.h"

#include "base/team.h"
#include "contact/contact_law.h"
#include "solve/lay.h"
#include "step/small_part.h"
#include "step/small_stiff.h"

#include <stdlib.h>
#include <string.h>

enum {
    COLOURS = 64,
    PER_THREAD = 4096 /* pairs that are worth a thread: 100 us */
};

/* What parts of the pairs are laid from */
struct small_layer {
    struct small_list *l;
    const struct packing *p;
    const vec3 *x, *edge;
    double near;  /* m */
    bool *beside; /* [pairs] */
};

/* ---- groups ---- */

/* A pair's group; those of a class come after those of the classes before. */
struct small_colours {
    uint64_t *used; /* [bodies] */
    uint8_t *of;    /* [pairs] its colour; COLOURS: none is left */
    int64_t count[2][COLOURS + 1];
};

static double pair_gap(const struct packing *p, const vec3 *x, const vec3 *edge,
                       const struct pair *pair)
{
    vec3 d = v3_sub(x[pair->b], x[pair->a]);
    if (cell_repeats(&p->cell)) d = v3_add(d, cell_shift(edge, pair->shift));
    return v3_norm(d) - p->radius[pair->a] - p->radius[pair->b];
}

static void look_beside(void *arg, int64_t first, int64_t end)
{
    const struct small_layer *o = arg;
    for (int64_t i = first; i < end; i++)
        o->beside[i] = pair_gap(o->p, o->x, o->edge, &o->l->pairs.pair[i]) <= o->near;
}

static void colour_class(struct small_colours *c, const struct packing *p,
                         const struct small_list *l, const bool *beside, int class)
{
    memset(c->used, 0, (size_t)p->n * sizeof *c->used);
    for (int64_t i = 0; i < l->pairs.n; i++) {
        const struct pair *pair = &l->pairs.pair[i];
        if (beside[i] != !class) continue;
        const uint64_t free = ~(c->used[pair->a] | c->used[pair->b]);
        const int k = free ? __builtin_ctzll(free) : COLOURS;
        c->of[i] = (uint8_t)k, c->count[class][k]++;
        if (free) c->used[pair->a] |= 1ULL << k, c->used[pair->b] |= 1ULL << k;
    }
}

/* in[pairs]: the group of each; those without a colour have one each, after the others. */
static void small_number_groups(struct small_list *l, const struct small_colours *c,
                                const bool *beside, int64_t *in)
{
    struct small *s = &l->s;
    int64_t first[2][COLOURS + 1], groups = 0;
    for (int class = 0; class < 2; class ++)
        for (int k = 0; k < COLOURS; k++) {
            first[class][k] = groups;
            groups += c->count[class][k] > 0;
        }
    s->serial = groups;
    for (int class = 0; class < 2; class ++) {
        first[class][COLOURS] = groups;
        groups += c->count[class][COLOURS];
    }
    s->groups = groups;
    for (int64_t i = 0; i < l->pairs.n; i++) {
        int64_t *at = &first[!beside[i]][c->of[i]];
        in[i] = *at;
        *at += c->of[i] == COLOURS;
    }
}

static int64_t in_bundles(int64_t pairs)
{
    return (pairs + BUNDLE - 1) / BUNDLE;
}

/* Of each group first the pairs that are told of early, then the others; after all groups the pairs of other processes.
   False when memory is short. */
static bool small_lay(struct small_list *l, const int64_t *in, const uint8_t *kind)
{
    struct small *s = &l->s;
    const int64_t n = s->groups;
    int64_t *next = calloc((size_t)(2 * n + 1), sizeof *next);
    s->group = malloc((size_t)(n + 1) * sizeof *s->group);
    l->early = malloc((size_t)(n + 1) * sizeof *l->early);
    if (!next || !s->group || !l->early) {
        free(next);
        return false;
    }
    for (int64_t i = 0; i < l->pairs.n; i++)
        next[kind[i] == PAIR_FOREIGN ? 2 * n : 2 * in[i] + (kind[i] == PAIR_LATER)]++;
    s->bundles = 0;
    for (int64_t g = 0; g < n; g++)
        for (int later = 0; later < 2; later++) {
            const int64_t count = next[2 * g + later];
            if (!later) s->group[g] = s->bundles;
            next[2 * g + later] = BUNDLE * s->bundles, s->bundles += in_bundles(count);
            if (!later) l->early[g] = s->bundles;
        }
    s->group[n] = s->bundles;
    const int64_t foreign = next[2 * n];
    next[2 * n] = BUNDLE * s->bundles, s->bundles += in_bundles(foreign);
    for (int64_t i = 0; i < l->pairs.n; i++)
        l->slot[i] = next[kind[i] == PAIR_FOREIGN ? 2 * n : 2 * in[i] + (kind[i] == PAIR_LATER)]++;
    free(next);
    return true;
}

static bool small_colour(struct small_layer *o)
{
    struct small_list *l = o->l;
    const struct packing *p = o->p;
    const size_t n = (size_t)l->pairs.n + 1;
    struct small_colours c = { .used = malloc((size_t)(p->n + 1) * sizeof *c.used),
                               .of = malloc(n) };
    bool *beside = malloc(n);
    int64_t *in = malloc(n * sizeof *in);
    uint8_t *kind = malloc(n);
    l->slot = malloc(n * sizeof *l->slot);
    bool room = c.used && c.of && beside && in && kind && l->slot;
    o->near = SMALL_BESIDE / SMALL_MARGIN * l->spare, o->beside = beside;
    if (room) team_share(team_size(), l->pairs.n, PER_THREAD, look_beside, o);
    for (int class = 0; room && class < 2; class ++) colour_class(&c, p, l, beside, class);
    if (room) small_number_groups(l, &c, beside, in), memset(kind, PAIR_LATER, n);
    if (room && l->part) room = small_part_divide(l->part, l, in, kind);
    room = room && small_lay(l, in, kind) && (!l->part || small_part_laid(l->part, l));
    free(c.used), free(c.of), free(beside), free(in), free(kind);
    return room;
}

/* ---- pairs ---- */

static void set_pair(struct small_list *l, const struct packing *p, const vec3 *edge, int64_t i)
{
    const struct pair *pair = &l->pairs.pair[i];
    const int32_t m = packing_pair(p, pair->a, pair->b);
    const int k = (int)(l->slot[i] % BUNDLE);
    struct small_bundle *c = &l->s.bundle[l->slot[i] / BUNDLE];
    c->a[k] = body_place(pair->a), c->b[k] = body_place(pair->b);
    c->mu[k] = p->mu[m], c->e[0][k] = p->en[m], c->e[1][k] = p->et[m];
    if (l->s.shift) {
        vec3 d = cell_shift(edge, pair->shift);
        small_shift_set(&l->s.shift[l->slot[i] / BUNDLE], k, d,
                        cell_shift(p->cell.rate, pair->shift));
    }
    if (l->s.hold) {
        double x[HOLD_COUNT];
        small_tie_set(x, p, pair->a, pair->b, p->dt);
        for (int j = 0; j < HOLD_COUNT; j++) l->s.hold[l->slot[i] / BUNDLE].x[j][k] = x[j];
    }
    if (l->s.spring) {
        const struct body *a = &l->s.body[pair->a], *b = &l->s.body[pair->b];
        const double ra = p->radius[pair->a], rb = p->radius[pair->b], wn = a->im + b->im;
        double x[SPRING_COUNT] = { 0 };
        small_stiff_set(x, l->stiffness, p, pair->a, pair->b, wn,
                        wn + ra * ra * a->ii + rb * rb * b->ii);
        for (int j = 0; j < SPRING_COUNT; j++) l->s.spring[l->slot[i] / BUNDLE].x[j][k] = x[j];
    }
    if (l->s.stick) {
        struct small_stick *t = &l->s.stick[l->slot[i] / BUNDLE];
        double mu[2];
        small_tie_stick(mu, &t->v_s[k], p, m);
        t->mu[0][k] = mu[0], t->mu[1][k] = mu[1];
    }
    if (!l->s.turn) return;
    struct small_turn *t = &l->s.turn[l->slot[i] / BUNDLE];
    contact_laws_rolling(p, pair->a, pair->b, &t->most[1][k], &t->most[0][k]);
}

static void set_pairs(void *arg, int64_t first, int64_t end)
{
    const struct small_layer *o = arg;
    for (int64_t i = first; i < end; i++) set_pair(o->l, o->p, o->edge, i);
}

bool small_pairs_lay(struct small_list *l, const struct packing *p, const vec3 *x,
                     const vec3 edge[3])
{
    struct small *s = &l->s;
    struct small_layer o = { .l = l, .p = p, .x = x, .edge = edge };
    if (!small_colour(&o)) return false;
    s->bundle = lay_lines(s->bundles, sizeof *s->bundle);
    if (packing_rolls(p)) s->turn = lay_lines(s->bundles, sizeof *s->turn);
    if (cell_repeats(&p->cell)) s->shift = lay_lines(s->bundles, sizeof *s->shift);
    if (small_tie_holds(p)) s->hold = lay_lines(s->bundles, sizeof *s->hold);
    if (packing_sticks(p)) s->stick = lay_lines(s->bundles, sizeof *s->stick);
    if (l->stiffness) s->spring = lay_lines(s->bundles, sizeof *s->spring);
    s->live = calloc((size_t)(s->bundles + 1), BUNDLE);
    s->late = calloc((size_t)(s->bundles + 1), BUNDLE);
    s->until = calloc((size_t)(s->bundles + 1), BUNDLE * sizeof *s->until);
    if (!s->bundle || (packing_rolls(p) && !s->turn) || (cell_repeats(&p->cell) && !s->shift) ||
        (small_tie_holds(p) && !s->hold) || (packing_sticks(p) && !s->stick) ||
        (l->stiffness && !s->spring) || !s->live || !s->late || !s->until)
        return false;
    for (int64_t i = 0; i < s->bundles; i++)
        for (int k = 0; k < BUNDLE; k++)
            s->bundle[i].a[k] = body_place(p->n), s->bundle[i].b[k] = body_place(p->n + 1);
    team_share(team_size(), l->pairs.n, PER_THREAD, set_pairs, &o);
    return true;
}
