/* problem/schedule.c: levels, colours, and the groups that they make [problem/schedule.h]. */
#include "problem/schedule.h"

#include "problem/bundle.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

const char *const order_name[ORDER_COUNT] = { "natural", "reverse", "random",
                                              "colour",  "halves",  "block" };

enum {
    MARK_COLOURS = 64, /* colours, the bits of a mark; other contacts get groups of their own */
    HALVES_FROM = 384, /* contacts from which halves are worth it */
    COLOUR_HALVES_FROM = 8192, /* contacts from which halves cost one thread nothing */
    ONE_BLOCK_MAX = 65536,     /* contacts that are coloured as one block, at most */
    BLOCK = 16384              /* contacts of a block, whose bodies stay in a second-level cache */

};

/*
 * Which contacts depend on each other, for either kind of problem. A node is a movable body or,
 * where there is only W, a contact. Its mark is what the contacts before have left: a level, or a
 * set of colours.
 */
struct graph {
    int64_t n, nodes;
    const struct contacts *contacts;
    const struct packing *packing;
    const struct delassus *W;    /* NULL: contacts and packing */
    uint64_t *mark;              /* [nodes] */
    int64_t *place;              /* [n] level or colour, -1: not yet */
    uint64_t begun;              /* set of the colours whose last bundle has room */
    int64_t count[MARK_COLOURS]; /* contacts of each colour */
};

/* node[] = the movable bodies of contact c; returns their number. */
static int movable_nodes(const struct graph *g, int64_t c, int32_t node[2])
{
    const struct contact *t = &g->contacts->c[c];
    return packing_movable(g->packing, t->a, t->b, node);
}

static uint64_t larger_of(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/* A colour not in `seen`: the first with room in its last bundle, else any; MARK_COLOURS if none */
static int64_t pick_colour(struct graph *g, uint64_t seen)
{
    uint64_t free = ~seen & g->begun ? ~seen & g->begun : ~seen;
    if (!free) return MARK_COLOURS;
    int64_t c = __builtin_ctzll(free);
    g->begun = ++g->count[c] % BUNDLE ? g->begun | 1ull << c : g->begun & ~(1ull << c);
    return c;
}

/* Places c one level after the marks of its bodies or blocks, and marks them with its level. */
static void place_level(struct graph *g, int64_t c)
{
    uint64_t level = 0;
    if (!g->W) {
        int32_t node[2];
        int k = movable_nodes(g, c, node);
        for (int j = 0; j < k; j++) level = larger_of(level, g->mark[node[j]]);
        for (int j = 0; j < k; j++) g->mark[node[j]] = level + 1;
        g->place[c] = (int64_t)level;
        return;
    }
    // a block may stand on one side of the diagonal only: read the places in c's row, and mark them
    const int32_t *col = g->W->col + g->W->first[c], *end = g->W->col + g->W->first[c + 1];
    level = g->mark[c];
    for (const int32_t *j = col; j < end; j++)
        if (g->place[*j] >= 0) level = larger_of(level, (uint64_t)g->place[*j] + 1);
    for (const int32_t *j = col; j < end; j++) g->mark[*j] = larger_of(g->mark[*j], level + 1);
    g->place[c] = (int64_t)level;
}

/* Chooses a colour for c that no mark of its bodies or blocks has, and adds it to these. */
static int64_t choose_colour(struct graph *g, int64_t c)
{
    uint64_t seen = 0;
    if (!g->W) {
        int32_t node[2];
        int k = movable_nodes(g, c, node);
        for (int j = 0; j < k; j++) seen |= g->mark[node[j]];
        int64_t free = pick_colour(g, seen);
        for (int j = 0; j < k && free < MARK_COLOURS; j++) g->mark[node[j]] |= 1ull << free;
        return free;
    }
    const int32_t *col = g->W->col + g->W->first[c], *end = g->W->col + g->W->first[c + 1];
    seen = g->mark[c];
    for (const int32_t *j = col; j < end; j++)
        if (g->place[*j] >= 0 && g->place[*j] < MARK_COLOURS) seen |= 1ull << g->place[*j];
    int64_t free = pick_colour(g, seen);
    for (const int32_t *j = col; j < end && free < MARK_COLOURS; j++) g->mark[*j] |= 1ull << free;
    return free;
}

/* Colours n contacts, with places from `from` on; returns the place after the last. */
static int64_t place_colours(struct graph *g, const int64_t *sequence, int64_t n, int64_t from)
{
    int64_t most = from, extra = from + MARK_COLOURS;
    int32_t node[2];
    g->begun = 0;
    memset(g->count, 0, sizeof g->count);
    for (int64_t i = 0; i < n && !g->W; i++)
        for (int j = movable_nodes(g, sequence[i], node); j > 0; j--) g->mark[node[j - 1]] = 0;
    for (int64_t i = 0; i < n; i++) {
        int64_t c = choose_colour(g, sequence[i]);
        g->place[sequence[i]] = c < MARK_COLOURS ? from + c : extra++;
        most = larger_of(most, g->place[sequence[i]] + 1);
    }
    return most;
}

/* The ten bits of x as bits 0, 3, 6 ... */
static uint32_t spread_bits(uint32_t x)
{
    x = (x | x << 16) & 0x30000ff;
    x = (x | x << 8) & 0x300f00f;
    x = (x | x << 4) & 0x30c30c3;
    return (x | x << 2) & 0x9249249;
}

/* The place of x on a curve through all cells of a cube from lo on, 1024 of size h (m) a side */
static uint32_t along_curve(vec3 x, vec3 lo, double h)
{
    vec3 i = v3_scale(1 / h, v3_sub(x, lo));
    return spread_bits((uint32_t)i.x) | spread_bits((uint32_t)i.y) << 1 |
           spread_bits((uint32_t)i.z) << 2;
}

/* Sorts the sequence along the curve, by ten bits of the key at a time; -1 when memory is short. */
static int sort_along_curve(const struct contacts *s, int64_t *sequence)
{
    vec3 lo = s->c[0].x, hi = lo;
    for (int64_t i = 0; i < s->n; i++) {
        vec3 x = s->c[i].x;
        lo = v3(fmin(lo.x, x.x), fmin(lo.y, x.y), fmin(lo.z, x.z));
        hi = v3(fmax(hi.x, x.x), fmax(hi.y, x.y), fmax(hi.z, x.z));
    }
    double h = fmax(hi.x - lo.x, fmax(hi.y - lo.y, hi.z - lo.z)) / 1023;
    uint32_t *key = malloc((size_t)s->n * sizeof *key);
    int64_t *from = sequence, *to = malloc((size_t)s->n * sizeof *to), *spare = to;
    bool room = key && to && h > 0;
    for (int64_t i = 0; room && i < s->n; i++) key[i] = along_curve(s->c[i].x, lo, h);
    for (int shift = 0; room && shift < 30; shift += 10) {
        int64_t tally[1025] = { 0 };
        for (int64_t i = 0; i < s->n; i++) tally[(key[i] >> shift & 1023) + 1]++;
        for (int k = 0; k < 1024; k++) tally[k + 1] += tally[k];
        for (int64_t i = 0; i < s->n; i++) to[tally[key[from[i]] >> shift & 1023]++] = from[i];
        int64_t *swap = from;
        from = to, to = swap;
    }
    if (room) memcpy(sequence, spare, (size_t)s->n * sizeof *sequence); // three passes end there
    free(key), free(spare);
    return room || !(h > 0) ? 0 : -1;
}

static void sequence_init(int64_t *sequence, int64_t n, enum order order)
{
    for (int64_t i = 0; i < n; i++) sequence[i] = order == ORDER_REVERSE ? n - 1 - i : i;
    if (order != ORDER_RANDOM || n < 2) return;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937); // a fixed seed: the same sweep every time
    gsl_ran_shuffle(rng, sequence, (size_t)n, sizeof *sequence);
    gsl_rng_free(rng);
}

/* Sorts the sequence by zones, stably; count[] = contacts of each. -1 when memory is short. */
static int sort_by_zone(int64_t *sequence, int64_t n, const int8_t *zone, int64_t count[ZONE_COUNT])
{
    int64_t *from = malloc((size_t)(n + 1) * sizeof *from), next = 0;
    if (!from) return -1;
    memcpy(from, sequence, (size_t)n * sizeof *from);
    for (int k = 0; k < ZONE_COUNT; k++) {
        count[k] = -next;
        for (int64_t i = 0; i < n; i++)
            if (zone[from[i]] == k) sequence[next++] = from[i];
        count[k] += next;
    }
    free(from);
    return 0;
}

/* The same, block by block where there are many contacts */
static int64_t place_blocks(struct graph *g, const int64_t *sequence, int64_t n, int64_t from)
{
    int64_t block = g->W || g->n <= ONE_BLOCK_MAX ? g->n + 1 : BLOCK;
    for (int64_t i = 0; i < n; i += block)
        from = place_colours(g, sequence + i, n - i < block ? n - i : block, from);
    return from;
}

/* Colours by zones; the rim's groups go between those of the inside. -1 when memory is short. */
static int place_halves(struct schedule *s, struct graph *g)
{
    int8_t *zone = malloc((size_t)g->n + 1);
    int64_t count[ZONE_COUNT], first[ZONE_COUNT + 1] = { 0 }, begin = 0;
    if (!zone || two_thread_split_divide(g->contacts, g->packing, zone) ||
        sort_by_zone(s->sequence, g->n, zone, count))
        return free(zone), -1;
    for (int k = 0; k < ZONE_COUNT; begin += count[k++])
        first[k + 1] = place_blocks(g, s->sequence + begin, count[k], first[k]);
    s->beyond = first[ZONE_BEYOND], s->inside = first[ZONE_INSIDE];
    int64_t inside = first[ZONE_RIM] - s->inside, rim = first[ZONE_COUNT] - first[ZONE_RIM];
    s->rim = s->inside + inside / 3, s->rest = s->rim + rim; // the first colours are the largest
    for (int64_t c = 0; c < g->n; c++) {
        if (zone[c] == ZONE_RIM) g->place[c] -= first[ZONE_RIM] - s->rim;
        if (zone[c] == ZONE_INSIDE && g->place[c] >= s->rim) g->place[c] += rim;
    }
    free(zone);
    return 0;
}

/* Sorts the sequence by place, stably, and makes the groups. -1 when memory is short. */
static int regroup(struct schedule *s, const struct graph *g)
{
    int64_t places = 0;
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
    bool colours = order >= ORDER_COLOUR;
    bool halves = !g->W && g->n >= (order == ORDER_HALVES ? HALVES_FROM : COLOUR_HALVES_FROM);
    *s = (struct schedule){ .sequence = malloc((size_t)(g->n + 1) * sizeof *s->sequence) };
    g->mark = calloc((size_t)g->nodes + 1, sizeof *g->mark);
    g->place = malloc((size_t)(g->n + 1) * sizeof *g->place);
    int failed = !s->sequence || !g->mark || !g->place;
    if (!failed) {
        sequence_init(s->sequence, g->n, order);
        for (int64_t i = 0; i < g->n; i++) g->place[i] = -1;
        if (colours && g->contacts && g->n > ONE_BLOCK_MAX)
            failed = sort_along_curve(g->contacts, s->sequence);
        if (colours && halves)
            failed = failed || place_halves(s, g);
        else if (colours)
            place_blocks(g, s->sequence, g->n, 0);
        else
            for (int64_t i = 0; i < g->n; i++) place_level(g, s->sequence[i]);
        failed = failed || regroup(s, g);
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
