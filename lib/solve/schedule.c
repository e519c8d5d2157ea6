/* solve/schedule.c: levels, colours, and the groups that they make [solve/schedule.h]. */
#include "solve/schedule.h"

#include "base/random.h"
#include "base/team.h"
#include "solve/bundle.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* ---- the cut and the zones ---- */

enum {
    SAMPLE = 16384,                  /* contacts that decide where to cut, at most */
    SPLIT_CONTACTS_PER_THREAD = 8192 /* the fewest contacts that are worth a thread */
};

struct division {
    int64_t n;
    int32_t (*body)[2];
    const struct packing *p;
    int8_t *zone;
    int axis;     /* of the cut */
    double at;    /* m */
    bool *shared; /* [p->n] the body has a contact in the border zone */
};

static double coordinate(const struct packing *p, int32_t body, int axis)
{
    vec3 x = p->x[body];
    return axis == 0 ? x.x : axis == 1 ? x.y : x.z;
}

/* From where to where contact c's movable bodies are along the axis, by their centres */
static void schedule_extent(const struct division *y, int64_t c, int axis, double *lo, double *hi)
{
    *lo = INFINITY, *hi = -INFINITY;
    for (int j = 0; j < 2 && y->body[c][j] >= 0; j++) {
        double x = coordinate(y->p, y->body[c][j], axis);
        *lo = dmin(*lo, x), *hi = dmax(*hi, x);
    }
}

/*
 * Chooses the axis and the place of the cut: half of the contacts are below, and as few as possible
 * across. Of many contacts a sample decides; top[SAMPLE] is work space.
 */
static void choose_cut(struct division *y, double *top)
{
    int64_t stride = (y->n + SAMPLE - 1) / SAMPLE, least = y->n;
    for (int k = 0; k < y->p->dim; k++) {
        double lo, hi;
        int64_t n = 0, across = 0;
        for (int64_t c = 0; c < y->n; c += stride) schedule_extent(y, c, k, &lo, &top[n++]);
        double middle = gsl_stats_select(top, 1, (size_t)n, (size_t)n / 2);
        for (int64_t c = 0; c < y->n; c += stride) {
            schedule_extent(y, c, k, &lo, &hi);
            across += lo < middle && hi >= middle;
        }
        if (across < least) least = across, y->axis = k, y->at = middle;
    }
}

static void cut_some(void *arg, int64_t first, int64_t end)
{
    struct division *y = arg;
    double lo, hi;
    for (int64_t c = first; c < end; c++) {
        schedule_extent(y, c, y->axis, &lo, &hi);
        y->zone[c] = hi < y->at ? ZONE_INSIDE : lo < y->at ? ZONE_BORDER : ZONE_BEYOND;
    }
}

static void find_rim(void *arg, int64_t first, int64_t end)
{
    struct division *y = arg;
    for (int64_t c = first; c < end; c++)
        for (int k = 0; k < 2 && y->zone[c] == ZONE_INSIDE && y->body[c][k] >= 0; k++)
            if (y->shared[y->body[c][k]]) y->zone[c] = ZONE_RIM;
}

/* zone[n] = the enum zone of each contact, by its movable bodies: body[n][2], the second -1 where there is one
   only, both where there is none. Returns 0, or -1 when memory is short. */
static int two_thread_split_divide(int64_t n, int32_t (*body)[2], const struct packing *p,
                                   int8_t *zone)
{
    double *top = malloc(SAMPLE * sizeof *top);
    struct division y = { n, body, p, zone, 0, 0, calloc((size_t)p->n + 1, sizeof *y.shared) };
    bool room = top && y.shared;
    if (room) {
        choose_cut(&y, top);
        team_share(team_size(), n, SPLIT_CONTACTS_PER_THREAD, cut_some, &y);
        for (int64_t c = 0; c < n; c++)
            for (int k = 0; k < 2 && zone[c] == ZONE_BORDER && body[c][k] >= 0; k++)
                y.shared[body[c][k]] = true;
        team_share(team_size(), n, SPLIT_CONTACTS_PER_THREAD, find_rim, &y);
    }
    free(top), free(y.shared);
    return room ? 0 : -1;
}

const char *const order_name[ORDER_COUNT] = { "natural", "reverse", "random", "colour", "block" };

enum {
    MARK_COLOURS = 64,     /* colours, the bits of a mark; other contacts get groups of their own */
    HALVES_FROM = 8192,    /* contacts from which halves cost one thread nothing */
    ONE_BLOCK_MAX = 65536, /* contacts that are coloured as one block, at most */
    BLOCK = 16384,         /* contacts of a block, whose bodies stay in a second-level cache */
    CONTACTS_PER_THREAD = 8192 /* the fewest contacts that are worth a thread */
};

/*
 * Which contacts depend on each other, for either kind of problem. A node is a movable body or,
 * where there is only W, a contact.
 */
struct graph {
    int64_t n, nodes;
    const struct contacts *contacts;
    const struct packing *packing;
    int32_t (*body)[2];       /* [n] movable bodies, side by side: contacts are 16 times as long */
    const struct delassus *W; /* NULL: contacts and packing */
    int64_t *place;           /* [n] level or colour, -1: not yet */
};

/* What contacts placed before have left at the nodes */
struct marks {
    uint64_t *mark;              /* [nodes] a level, or a set of colours */
    uint64_t begun;              /* set of the colours whose last bundle has room */
    int64_t count[MARK_COLOURS]; /* contacts of each colour */
};

static void find_some(void *arg, int64_t first, int64_t end)
{
    struct graph *g = arg;
    for (int64_t c = first; c < end; c++) {
        const struct contact *t = &g->contacts->c[c];
        g->body[c][0] = g->body[c][1] = -1;
        packing_movable(g->packing, t->a, t->b, g->body[c]);
    }
}

/* How many movable bodies contact c has; they come first in g->body[c]. */
static int movable(const struct graph *g, int64_t c)
{
    return (g->body[c][0] >= 0) + (g->body[c][1] >= 0);
}

static uint64_t larger_of(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/* A colour not in `seen`: the first with room in its last bundle, else any; MARK_COLOURS if none */
static int64_t pick_colour(struct marks *m, uint64_t seen)
{
    uint64_t free = ~seen & m->begun ? ~seen & m->begun : ~seen;
    if (!free) return MARK_COLOURS;
    int64_t c = __builtin_ctzll(free);
    m->begun = ++m->count[c] % BUNDLE ? m->begun | 1ull << c : m->begun & ~(1ull << c);
    return c;
}

/* Places c one level after the marks of its bodies or blocks, and marks them with its level. */
static void place_level(struct graph *g, uint64_t *mark, int64_t c)
{
    uint64_t level = 0;
    if (!g->W) {
        const int32_t *node = g->body[c];
        int k = movable(g, c);
        for (int j = 0; j < k; j++) level = larger_of(level, mark[node[j]]);
        for (int j = 0; j < k; j++) mark[node[j]] = level + 1;
        g->place[c] = (int64_t)level;
        return;
    }
    // a block may stand on one side of the diagonal only: read the places in c's row, and mark them
    const int32_t *col = g->W->col + g->W->first[c], *end = g->W->col + g->W->first[c + 1];
    level = mark[c];
    for (const int32_t *j = col; j < end; j++)
        if (g->place[*j] >= 0) level = larger_of(level, (uint64_t)g->place[*j] + 1);
    for (const int32_t *j = col; j < end; j++) mark[*j] = larger_of(mark[*j], level + 1);
    g->place[c] = (int64_t)level;
}

static int place_levels(struct graph *g, const int64_t *sequence)
{
    uint64_t *mark = calloc((size_t)g->nodes + 1, sizeof *mark);
    for (int64_t i = 0; mark && i < g->n; i++) place_level(g, mark, sequence[i]);
    free(mark);
    return mark ? 0 : -1;
}

/* Chooses a colour for c that no mark of its bodies or blocks has, and adds it to these. */
static int64_t choose_colour(const struct graph *g, struct marks *m, int64_t c)
{
    uint64_t seen = 0;
    if (!g->W) {
        const int32_t *node = g->body[c];
        int k = movable(g, c);
        for (int j = 0; j < k; j++) seen |= m->mark[node[j]];
        int64_t free = pick_colour(m, seen);
        for (int j = 0; j < k && free < MARK_COLOURS; j++) m->mark[node[j]] |= 1ull << free;
        return free;
    }
    const int32_t *col = g->W->col + g->W->first[c], *end = g->W->col + g->W->first[c + 1];
    seen = m->mark[c];
    for (const int32_t *j = col; j < end; j++)
        if (g->place[*j] >= 0 && g->place[*j] < MARK_COLOURS) seen |= 1ull << g->place[*j];
    int64_t free = pick_colour(m, seen);
    for (const int32_t *j = col; j < end && free < MARK_COLOURS; j++) m->mark[*j] |= 1ull << free;
    return free;
}

/* A stretch of the sequence that is coloured by itself */
struct stretch {
    int64_t first, n, places; /* contacts; how many places they take */
};

/* Colours a stretch, with places from 0 on. */
static void colour(struct graph *g, struct marks *m, const int64_t *sequence, struct stretch *s)
{
    int64_t extra = MARK_COLOURS;
    m->begun = 0;
    memset(m->count, 0, sizeof m->count);
    sequence += s->first;
    for (int64_t i = 0; i < s->n; i++)
        for (int j = g->W ? 0 : movable(g, sequence[i]); j > 0; j--)
            m->mark[g->body[sequence[i]][j - 1]] = 0;
    for (int64_t i = 0; i < s->n; i++) {
        int64_t c = choose_colour(g, m, sequence[i]);
        g->place[sequence[i]] = c < MARK_COLOURS ? c : extra++;
        s->places = larger_of(s->places, g->place[sequence[i]] + 1);
    }
}

/* Stretches that threads colour */
struct colouring {
    struct graph *g;
    const int64_t *sequence;
    struct stretch *stretch;
    _Atomic bool failed;
};

static void colour_some(void *arg, int64_t first, int64_t end)
{
    struct colouring *c = arg;
    struct marks m = { .mark = calloc((size_t)c->g->nodes + 1, sizeof *m.mark) };
    if (!m.mark) c->failed = true;
    for (int64_t k = first; k < end && m.mark; k++) colour(c->g, &m, c->sequence, &c->stretch[k]);
    free(m.mark);
}

/*
 * Colours the zones of a sequence, count[zones] contacts in each, one after another, and where there are
 * many contacts each block by block; first[zones + 1] = where their places begin. -1 when memory is short.
 */
static int place_zones(struct graph *g, const int64_t *sequence, int zones, const int64_t *count,
                       int64_t *first)
{
    int64_t block = g->W || g->n <= ONE_BLOCK_MAX ? g->n + 1 : BLOCK, n = 0, begin = 0;
    struct stretch *s = calloc((size_t)(g->n / block + zones + 1), sizeof *s);
    struct colouring c = { g, sequence, s, false };
    if (!s) return -1;
    for (int k = 0; k < zones; begin += count[k++])
        for (int64_t i = 0; i < count[k]; i += block)
            s[n++].first = begin + i, s[n - 1].n = count[k] - i < block ? count[k] - i : block;
    team_share(g->n < CONTACTS_PER_THREAD ? 1 : team_size(), n, 1, colour_some, &c);
    int64_t at = 0, from = 0, end = 0;
    for (int k = 0; k < zones; k++) {
        first[k] = from, end += count[k];
        for (; at < n && s[at].first < end; from += s[at++].places)
            for (int64_t i = 0; i < s[at].n; i++) g->place[sequence[s[at].first + i]] += from;
    }
    first[zones] = from;
    free(s);
    return c.failed ? -1 : 0;
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

/* Places of contacts along the curve */
struct places {
    const struct contacts *s;
    uint32_t *key;        /* [s->n] */
    vec3 lo, hi;          /* m: of all points of contact */
    double h;             /* m */
    pthread_mutex_t lock; /* of lo and hi */
};

static void bound_some(void *arg, int64_t first, int64_t end)
{
    struct places *o = arg;
    vec3 lo = o->s->c[first].x, hi = lo;
    for (int64_t i = first + 1; i < end; i++)
        lo = v3_min(lo, o->s->c[i].x), hi = v3_max(hi, o->s->c[i].x);
    pthread_mutex_lock(&o->lock);
    o->lo = v3_min(o->lo, lo), o->hi = v3_max(o->hi, hi);
    pthread_mutex_unlock(&o->lock);
}

static void place_some(void *arg, int64_t first, int64_t end)
{
    struct places *o = arg;
    for (int64_t i = first; i < end; i++) o->key[i] = along_curve(o->s->c[i].x, o->lo, o->h);
}

/* key[s->n] = where the contacts are on the curve; whether they are not all at one point */
static bool find_places(const struct contacts *s, uint32_t *key)
{
    struct places o = { s, key, s->c[0].x, s->c[0].x, 0, PTHREAD_MUTEX_INITIALIZER };
    team_share(team_size(), s->n, CONTACTS_PER_THREAD, bound_some, &o);
    o.h = dmax(o.hi.x - o.lo.x, dmax(o.hi.y - o.lo.y, o.hi.z - o.lo.z)) / 1023;
    if (o.h > 0)
        team_share(team_size(), s->n, CONTACTS_PER_THREAD, place_some, &o);
    else
        memset(key, 0, (size_t)s->n * sizeof *key);
    return o.h > 0;
}

/* Sorts the sequence along the curve, by ten bits of the key at a time; -1 when memory is short. */
static int sort_along_curve(const struct contacts *s, int64_t *sequence, uint32_t **keys)
{
    uint32_t *key = *keys = malloc((size_t)s->n * sizeof *key);
    int64_t *from = sequence, *to = malloc((size_t)s->n * sizeof *to), *spare = to;
    bool room = key && to, apart = room && find_places(s, key);
    for (int shift = 0; apart && shift < 30; shift += 10) {
        int64_t tally[1025] = { 0 };
        for (int64_t i = 0; i < s->n; i++) tally[(key[i] >> shift & 1023) + 1]++;
        for (int k = 0; k < 1024; k++) tally[k + 1] += tally[k];
        for (int64_t i = 0; i < s->n; i++) to[tally[key[from[i]] >> shift & 1023]++] = from[i];
        int64_t *swap = from;
        from = to, to = swap;
    }
    if (apart) memcpy(sequence, spare, (size_t)s->n * sizeof *sequence); // three passes end there
    free(spare);
    return room ? 0 : -1;
}

static void sequence_init(int64_t *sequence, int64_t n, enum order order)
{
    for (int64_t i = 0; i < n; i++) sequence[i] = order == ORDER_REVERSE ? n - 1 - i : i;
    if (order != ORDER_RANDOM || n < 2) return;
    gsl_rng *rng = random_alloc(gsl_rng_mt19937); // a fixed seed: the same sweep every time
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

/* Colours by zones; the rim's groups go between those of the inside. -1 when memory is short. */
static int place_halves(struct schedule *s, struct graph *g)
{
    int8_t *zone = s->zone = malloc((size_t)g->n + 1);
    int64_t count[ZONE_COUNT], first[ZONE_COUNT + 1];
    if (!zone || two_thread_split_divide(g->n, g->body, g->packing, zone) ||
        sort_by_zone(s->sequence, g->n, zone, count) ||
        place_zones(g, s->sequence, ZONE_COUNT, count, first))
        return -1;
    s->beyond = first[ZONE_BEYOND], s->inside = first[ZONE_INSIDE];
    int64_t inside = first[ZONE_RIM] - s->inside, rim = first[ZONE_COUNT] - first[ZONE_RIM];
    s->rim = s->inside + inside / 3, s->rest = s->rim + rim; // the first colours are the largest
    for (int64_t c = 0; c < g->n; c++) {
        if (zone[c] == ZONE_RIM) g->place[c] -= first[ZONE_RIM] - s->rim;
        if (zone[c] == ZONE_INSIDE && g->place[c] >= s->rim) g->place[c] += rim;
    }
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

static int schedule_place(struct schedule *s, enum order order, struct graph *g)
{
    bool halves = !g->W && g->n >= HALVES_FROM;
    int64_t first[2];
    if (order < ORDER_COLOUR) return place_levels(g, s->sequence);
    if (g->contacts && g->n > ONE_BLOCK_MAX && sort_along_curve(g->contacts, s->sequence, &s->key))
        return -1;
    return halves ? place_halves(s, g) : place_zones(g, s->sequence, 1, &g->n, first);
}

static int schedule(struct schedule *s, enum order order, struct graph *g)
{
    *s = (struct schedule){ .sequence = malloc((size_t)(g->n + 1) * sizeof *s->sequence) };
    g->place = malloc((size_t)(g->n + 1) * sizeof *g->place);
    if (!g->W) g->body = malloc((size_t)(g->n + 1) * sizeof *g->body);
    int failed = !s->sequence || !g->place || (!g->W && !g->body);
    if (!failed) {
        if (!g->W) team_share(team_size(), g->n, CONTACTS_PER_THREAD, find_some, g);
        sequence_init(s->sequence, g->n, order);
        for (int64_t i = 0; i < g->n; i++) g->place[i] = -1;
        failed = schedule_place(s, order, g) || regroup(s, g);
    }
    free(g->place), free(g->body);
    if (!failed) return 0;
    schedule_free(s);
    return -1;
}

void schedule_free(struct schedule *s)
{
    free(s->sequence), free(s->group), free(s->key), free(s->zone);
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

static bool same_zones(const struct schedule *s, const struct contacts *contacts,
                       const struct packing *packing)
{
    struct graph g = { .n = contacts->n, .contacts = contacts, .packing = packing };
    int8_t *zone = malloc((size_t)g.n + 1);
    g.body = malloc((size_t)(g.n + 1) * sizeof *g.body);
    bool same = zone && g.body;
    if (same) team_share(team_size(), g.n, CONTACTS_PER_THREAD, find_some, &g);
    same = same && !two_thread_split_divide(g.n, g.body, packing, zone) &&
           !memcmp(zone, s->zone, (size_t)g.n);
    free(zone), free(g.body);
    return same;
}

bool schedule_holds(const struct schedule *s, const struct contacts *contacts,
                    const struct packing *packing)
{
    if (s->key) {
        uint32_t *key = malloc((size_t)(contacts->n + 1) * sizeof *key);
        bool same = key != NULL;
        if (same) find_places(contacts, key);
        same = same && !memcmp(key, s->key, (size_t)contacts->n * sizeof *key);
        free(key);
        if (!same) return false;
    }
    return !s->zone || same_zones(s, contacts, packing);
}
