#include "schedule.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

enum { COLOURS = 64 }; /* the bits of a mark; contacts beyond them follow one after another */

/*
 * Who depends on whom, of either kind of problem. A node is a movable body or, where there is only
 * W, a contact; it carries a mark that the contacts before have left: a level, or a set of colours.
 */
struct graph {
    int64_t n, nodes;
    const struct contacts *contacts;
    const struct packing *packing;
    const struct delassus *W; /* NULL: contacts and packing */
    uint64_t *mark;           /* [nodes] */
    int64_t *place;           /* [n] level or colour, -1: not yet */
};

static int touches(const struct graph *g, int64_t c, int64_t node[2])
{
    int k = 0;
    const struct contact *t = &g->contacts->c[c];
    if (t->a >= 0 && g->packing->mass[t->a] > 0) node[k++] = t->a;
    if (g->packing->mass[t->b] > 0) node[k++] = t->b;
    return k;
}

static uint64_t later(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

static int64_t first_free(uint64_t colours)
{
    return ~colours ? __builtin_ctzll(~colours) : COLOURS;
}

/* c's level, one after what its bodies or blocks have seen; leaves it marked there. */
static void place_level(struct graph *g, int64_t c)
{
    uint64_t level = 0;
    if (!g->W) {
        int64_t node[2];
        int k = touches(g, c, node);
        for (int j = 0; j < k; j++) level = later(level, g->mark[node[j]]);
        for (int j = 0; j < k; j++) g->mark[node[j]] = level + 1;
        g->place[c] = (int64_t)level;
        return;
    }
    // a block may stand on one side of the diagonal only: look at c's row, and leave a mark there
    const int32_t *col = g->W->col + g->W->first[c], *end = g->W->col + g->W->first[c + 1];
    level = g->mark[c];
    for (const int32_t *j = col; j < end; j++)
        if (g->place[*j] >= 0) level = later(level, (uint64_t)g->place[*j] + 1);
    for (const int32_t *j = col; j < end; j++) g->mark[*j] = later(g->mark[*j], level + 1);
    g->place[c] = (int64_t)level;
}

/* c's colour, the first that its bodies or blocks have not seen. */
static void place_colour(struct graph *g, int64_t c)
{
    uint64_t seen = 0;
    if (!g->W) {
        int64_t node[2];
        int k = touches(g, c, node);
        for (int j = 0; j < k; j++) seen |= g->mark[node[j]];
        g->place[c] = first_free(seen);
        for (int j = 0; j < k && g->place[c] < COLOURS; j++)
            g->mark[node[j]] |= 1ull << g->place[c];
        return;
    }
    const int32_t *col = g->W->col + g->W->first[c], *end = g->W->col + g->W->first[c + 1];
    seen = g->mark[c];
    for (const int32_t *j = col; j < end; j++)
        if (g->place[*j] >= 0 && g->place[*j] < COLOURS) seen |= 1ull << g->place[*j];
    g->place[c] = first_free(seen);
    for (const int32_t *j = col; j < end && g->place[c] < COLOURS; j++)
        g->mark[*j] |= 1ull << g->place[c];
}

static void sequence_init(int64_t *sequence, int64_t n, enum order order)
{
    for (int64_t i = 0; i < n; i++) sequence[i] = order == ORDER_REVERSE ? n - 1 - i : i;
    if (order != ORDER_RANDOM || n < 2) return;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937); // a fixed seed: the same sweep every time
    gsl_ran_shuffle(rng, sequence, (size_t)n, sizeof *sequence);
    gsl_rng_free(rng);
}

/* The sequence sorted by place, stable; contacts beyond the colours get a group each. */
static int regroup(struct schedule *s, const struct graph *g, bool colours)
{
    int64_t places = 0, extra = 0;
    for (int64_t c = 0; colours && c < g->n; c++)
        if (g->place[c] >= COLOURS) g->place[c] = COLOURS + extra++;
    for (int64_t c = 0; c < g->n; c++) places = g->place[c] >= places ? g->place[c] + 1 : places;
    int64_t *sorted = malloc((size_t)(g->n + 1) * sizeof *sorted);
    s->groups = places;
    s->group = calloc((size_t)places + 2, sizeof *s->group);
    if (!sorted || !s->group) {
        free(sorted);
        return -1;
    }
    for (int64_t c = 0; c < g->n; c++) s->group[g->place[c] + 2]++;
    for (int64_t p = 0; p < places; p++) s->group[p + 2] += s->group[p + 1];
    for (int64_t i = 0; i < g->n; i++)
        sorted[s->group[g->place[s->sequence[i]] + 1]++] = s->sequence[i];
    free(s->sequence);
    s->sequence = sorted;
    return 0;
}

static int schedule(struct schedule *s, enum order order, struct graph *g)
{
    bool colours = order == ORDER_COLOUR;
    *s = (struct schedule){ .sequence = malloc((size_t)(g->n + 1) * sizeof *s->sequence) };
    g->mark = calloc((size_t)g->nodes + 1, sizeof *g->mark);
    g->place = malloc((size_t)(g->n + 1) * sizeof *g->place);
    int failed = !s->sequence || !g->mark || !g->place;
    if (!failed) {
        sequence_init(s->sequence, g->n, order);
        for (int64_t i = 0; i < g->n; i++) g->place[i] = -1;
        for (int64_t i = 0; i < g->n; i++)
            (colours ? place_colour : place_level)(g, s->sequence[i]);
        failed = regroup(s, g, colours);
    }
    free(g->mark), free(g->place);
    if (!failed) return 0;
    schedule_free(s);
    return -1;
}

void schedule_free(struct schedule *s)
{
    free(s->sequence), free(s->group);
    *s = (struct schedule){ 0 };
}

int schedule_bodies(struct schedule *s, enum order order, const struct contacts *contacts,
                    const struct packing *packing)
{
    struct graph g = {
        .n = contacts->n, .nodes = packing->n, .contacts = contacts, .packing = packing
    };
    return schedule(s, order, &g);
}

int schedule_blocks(struct schedule *s, enum order order, const struct delassus *W)
{
    struct graph g = { .n = W->n, .nodes = W->n, .W = W };
    return schedule(s, order, &g);
}
