/*
 * solve/opencl.c: a device by OpenCL 1.2 [solve/device.h]: a problem on it. A launch solves contacts that do not depend on each
 * other, and waits for the one before it: the queue is in order.
 */
#include "solve/local_exact.h"
#include "solve/opencl_queue.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- a problem ---- */

static enum variant variant_of(const struct problem *p)
{
    if (!p->kind.given_by_W) return VARIANT_BODIES;
    return p->kind.full ? VARIANT_BLOCKS : VARIANT_DIAGONALS;
}

/*
 * The level of slot i: one after the last contact before it that shares a body that moves, as its bodies' `after` has
 * it; given by W the group, which was made so. Colours of a large pile are those of a stretch of contacts after another
 * [solve/schedule.c], too few at once for a device. Their contacts meet at the borders alone: levels are few and
 * large, and each body gets its changes in the order of the groups, so the bits are the same.
 */
static int32_t opencl_level_of(const struct problem *p, int64_t i, int64_t group, int32_t *after)
{
    if (!p->body) return (int32_t)group;
    const struct bundle *c = slot_bundle(p, i);
    int64_t a = body_index(c->a[slot_lane(i)]), b = body_index(c->b[slot_lane(i)]);
    int32_t level = after[a] > after[b] ? after[a] : after[b];
    if (p->body[a].im > 0) after[a] = level + 1;
    if (p->body[b].im > 0) after[b] = level + 1;
    return level;
}

/* o->first[] and o->list[] from the level of each slot, -1: no contact */
static void list_levels(struct opencl *o, int64_t slots, const int32_t *level)
{
    for (int64_t k = 0; k <= o->levels; k++) o->first[k] = 0;
    for (int64_t i = 0; i < slots; i++)
        if (level[i] >= 0) o->first[level[i] + 1]++;
    o->parts = 0;
    for (int64_t k = 0; k < o->levels; k++) {
        o->parts += (o->first[k + 1] + TEAM - 1) / TEAM;
        o->first[k + 1] += o->first[k];
    }
    for (int64_t i = 0; i < slots; i++)
        if (level[i] >= 0) o->list[o->first[level[i]]++] = (int32_t)i;
    for (int64_t k = o->levels; k > 0; k--) o->first[k] = o->first[k - 1];
    o->first[0] = 0;
}

/* Contacts that the device solves at once, level after level; false when memory is short */
static bool make_levels(struct opencl *o, const struct problem *p)
{
    int32_t *level = malloc((size_t)(p->slots + 1) * sizeof *level);
    int32_t *after = calloc((size_t)p->bodies + 1, sizeof *after);
    int32_t *all = realloc(o->list, (size_t)(p->slots + 1) * sizeof *all);
    if (all) o->list = all;
    int64_t *first = realloc(o->first, (size_t)(p->groups + 2) * sizeof *first);
    if (first) o->first = first;
    bool room = level && after && all && first;
    o->levels = 0;
    for (int64_t i = 0; room && i < p->slots; i++) level[i] = -1;
    for (int64_t g = 0; room && g < p->groups; g++)
        for (int64_t i = p->group[g] * BUNDLE; i < p->group[g + 1] * BUNDLE; i++) {
            level[i] = p->contact[i] < 0 ? -1 : opencl_level_of(p, i, g, after);
            if (level[i] >= o->levels) o->levels = level[i] + 1;
        }
    if (room) list_levels(o, p->slots, level);
    free(level), free(after);
    return room;
}

static int64_t in_level(const struct opencl *o, int64_t k)
{
    return o->first[k + 1] - o->first[k];
}

/* Bundles, and apart from them what stands behind them */
static void give_bundles(struct opencl *o, const struct problem *p)
{
    struct bundle *stage = o->stage;
    struct beside *behind = o->stage;
    for (int64_t i = 0; i < p->bundles && !opencl_lost(o); i += STAGE) {
        int64_t n = p->bundles - i < STAGE ? p->bundles - i : STAGE;
        for (int64_t k = 0; k < n; k++) stage[k] = *bundle_at(p, i + k);
        opencl_put(o, BUNDLES, (size_t)i * sizeof *stage, stage, (size_t)n * sizeof *stage);
        for (int64_t k = 0; k < n && p->kind.near; k++)
            behind[k] = *bundle_beside(p, bundle_at(p, i + k));
        if (p->kind.near)
            opencl_put(o, BESIDE, (size_t)i * sizeof *behind, behind, (size_t)n * sizeof *behind);
    }
}

/* The bodies as they move without reactions; of a packing, else as they are */
static bool give_free_motion(struct opencl *o, struct problem *p)
{
    size_t size = (size_t)p->bodies * sizeof *p->body;
    struct body *now = p->packing ? malloc(size) : NULL;
    if (p->packing && !now) return false;
    if (now) memcpy(now, p->body, size), problem_set_free_motion(p);
    opencl_give(o, FREE, p->body, size);
    if (now) memcpy(p->body, now, size);
    free(now);
    return opencl_need(o, BODIES, size);
}

static void give_rows(struct opencl *o, const struct problem *p)
{
    const struct delassus *W = &p->sorted;
    size_t d = (size_t)p->d, slots = (size_t)p->slots, blocks = (size_t)W->first[p->slots];
    opencl_give(o, ROW_FIRST, W->first, (slots + 1) * sizeof *W->first);
    opencl_give(o, ROW_COL, W->col, blocks * sizeof *W->col);
    opencl_give(o, ROW_BLOCK, W->block, blocks * d * d * sizeof *W->block);
    opencl_give(o, ROW_Q, W->q, slots * d * sizeof *W->q);
    opencl_give(o, BLOCK, p->block, (size_t)p->bundles * sizeof *p->block);
    opencl_need(o, ROW_R, (size_t)p->n * d * sizeof *p->W->r);
}

static int64_t largest_level(const struct opencl *o)
{
    int64_t most = 1;
    for (int64_t k = 0; k < o->levels; k++) most = in_level(o, k) > most ? in_level(o, k) : most;
    return most;
}

static int hold(struct device *d, struct problem *p, enum method_id method, struct failure *failure)
{
    struct opencl *o = (struct opencl *)d;
    const size_t bundles = (size_t)p->bundles;
    const int32_t zero = 0;
    o->method = method, o->variant = variant_of(p);
    o->now = opencl_program(o, method, o->variant);
    bool room = make_levels(o, p);
    opencl_need(o, BUNDLES, bundles * sizeof(struct bundle));
    if (p->kind.near)
        opencl_need(o, BESIDE, bundles * sizeof(struct beside));
    else
        opencl_forget(o, BESIDE);
    if (room) give_bundles(o, p);
    if (room) opencl_give(o, LIST, o->list, (size_t)o->first[o->levels] * sizeof *o->list);
    opencl_give(o, REBOUND, p->rebound, bundles * sizeof *p->rebound);
    opencl_give(o, W_CC, p->w, bundles * sizeof *p->w);
    opencl_give(o, RHO, p->rho, bundles * sizeof *p->rho);
    opencl_need(o, R, bundles * sizeof *p->u), opencl_need(o, U, bundles * sizeof *p->u);
    if (room && p->kind.given_by_W)
        give_rows(o, p);
    else
        room = room && give_free_motion(o, p);
    opencl_need(o, PART, (size_t)(o->parts + 1) * sizeof(struct opencl_counts));
    opencl_need(o, TALLY, sizeof(struct opencl_counts));
    if (room)
        opencl_need(o, QUESTION,
                    (size_t)(p->kind.full ? largest_level(o) : 1) * sizeof(struct question));
    opencl_give(o, QUESTIONS, &zero, sizeof zero);
    if (!room) return failure_set(failure, EX_SOFTWARE, "--device opencl: no memory");
    return d->lost.status ? failure_set(failure, d->lost.status, "%s", d->lost.text) : 0;
}

static void upload(struct device *d, const struct problem *p)
{
    struct opencl *o = (struct opencl *)d;
    double(*stage)[3][BUNDLE] = o->stage;
    for (int64_t i = 0; i < p->bundles; i += STAGE) {
        int64_t n = p->bundles - i < STAGE ? p->bundles - i : STAGE;
        for (int64_t k = 0; k < n; k++) memcpy(stage[k], bundle_at(p, i + k)->r, sizeof *stage);
        opencl_put(o, R, (size_t)i * sizeof *stage, stage, (size_t)n * sizeof *stage);
    }
    opencl_put(o, U, 0, p->u, (size_t)p->bundles * sizeof *p->u);
    if (p->kind.given_by_W)
        opencl_put(o, ROW_R, 0, p->W->r, (size_t)(p->n * p->d) * sizeof *p->W->r);
    else
        opencl_put(o, BODIES, 0, p->body, (size_t)p->bodies * sizeof *p->body);
}

static void download(struct device *d, struct problem *p, bool bodies)
{
    struct opencl *o = (struct opencl *)d;
    double(*stage)[3][BUNDLE] = o->stage;
    for (int64_t i = 0; i < p->bundles; i += STAGE) {
        int64_t n = p->bundles - i < STAGE ? p->bundles - i : STAGE;
        opencl_take(o, R, (size_t)i * sizeof *stage, stage, (size_t)n * sizeof *stage);
        for (int64_t k = 0; k < n && !opencl_lost(o); k++)
            memcpy(bundle_at(p, i + k)->r, stage[k], sizeof *stage);
    }
    opencl_take(o, U, 0, p->u, (size_t)p->bundles * sizeof *p->u);
    if (p->kind.given_by_W)
        opencl_take(o, ROW_R, 0, p->W->r, (size_t)(p->n * p->d) * sizeof *p->W->r);
    else if (bodies)
        opencl_take(o, BODIES, 0, p->body, (size_t)p->bodies * sizeof *p->body);
}

/* ---- sweeps ---- */

/* What sweep and sweep_answered begin with; returns the index of the next argument */
static uint32_t set_sweep(struct opencl *o, enum kernel_id k, const struct problem *p,
                          const struct sweep_opt *s)
{
    return SET(k, 0, MEMORY(BUNDLES), MEMORY(BESIDE), MEMORY(REBOUND), MEMORY(BODIES), MEMORY(R),
               MEMORY(U), MEMORY(W_CC), MEMORY(RHO), ROWS_OF_W, opencl_integer(p->d),
               opencl_real(s->relax), opencl_real(s->local.newton_eps),
               opencl_real(s->local.newton_abs), opencl_integer(s->local.newton_max),
               opencl_integer(s->local.plain), opencl_integer(s->keep), MEMORY(QUESTION),
               MEMORY(QUESTIONS), MEMORY(PART));
}

/* Answers what contacts of the group have asked, and lets them be solved. */
static void opencl_answer(struct opencl *o, int d, uint32_t next, int64_t part)
{
    int32_t n = 0;
    const int32_t zero = 0;
    opencl_take(o, QUESTIONS, 0, &n, sizeof n);
    if (n <= 0 || (size_t)n * sizeof(struct question) > o->buffer[QUESTION].size || opencl_lost(o))
        return;
    struct question *q = malloc((size_t)n * sizeof *q);
    if (!q) {
        opencl_good(o, -6, "answers");
        return;
    }
    opencl_take(o, QUESTION, 0, q, (size_t)n * sizeof *q);
    for (int32_t k = 0; k < n && !opencl_lost(o); k++)
        q[k].found = exact_search(d, q[k].W, q[k].b, q[k].mu, q[k].singular, q[k].r);
    opencl_put(o, QUESTION, 0, q, (size_t)n * sizeof *q);
    opencl_put(o, QUESTIONS, 0, &zero, sizeof zero);
    free(q);
    SET(SWEEP_ANSWERED, next, opencl_integer(n), opencl_whole(part));
    opencl_launch(o, SWEEP_ANSWERED, 1);
}

static void opencl_sweep(struct device *d, struct problem *p, const struct sweep_opt *s,
                         struct tally *t)
{
    struct opencl *o = (struct opencl *)d;
    bool asks = o->variant == VARIANT_BLOCKS && methods[o->method]->believes;
    uint32_t next = set_sweep(o, SWEEP, p, s);
    struct opencl_counts c = { 0, 0, 0, 0 };
    int64_t part = 0;
    if (asks) set_sweep(o, SWEEP_ANSWERED, p, s);
    for (int64_t k = 0; k < o->levels && !opencl_lost(o); k++) {
        SET(SWEEP, next, MEMORY(LIST), opencl_whole(o->first[k]),
            opencl_integer((int32_t)in_level(o, k)), opencl_whole(part));
        opencl_launch(o, SWEEP, in_level(o, k));
        if (asks) opencl_answer(o, p->d, next, part);
        part += (in_level(o, k) + TEAM - 1) / TEAM;
    }
    SET(TALLY_COUNTS, 0, MEMORY(PART), opencl_whole(part), MEMORY(TALLY));
    opencl_launch(o, TALLY_COUNTS, 1);
    opencl_take(o, TALLY, 0, &c, sizeof c);
    if (opencl_lost(o)) return;
    t->change[0] = fmax(t->change[0], c.change), t->newton[0] += c.newton;
    t->safeguarded[0] += c.safeguarded, t->gave_up[0] += c.gave_up;
}

static void opencl_renew(struct device *d, const struct problem *p)
{
    struct opencl *o = (struct opencl *)d;
    if (p->kind.given_by_W) return;
    opencl_copy(o, FREE, BODIES, (size_t)p->bodies * sizeof *p->body);
    SET(PUSH, 0, MEMORY(LIST), MEMORY(BUNDLES), MEMORY(BESIDE), MEMORY(BODIES), MEMORY(R),
        MEMORY(ROW_R), opencl_integer(p->d));
    for (int64_t k = 0; k < o->levels; k++) {
        SET(PUSH, 7, opencl_whole(o->first[k]), opencl_integer((int32_t)in_level(o, k)));
        opencl_launch(o, PUSH, in_level(o, k));
    }
}

static void opencl_velocities(struct device *d, const struct problem *p)
{
    struct opencl *o = (struct opencl *)d;
    SET(VELOCITIES, 0, MEMORY(BUNDLES), MEMORY(BESIDE), MEMORY(REBOUND), MEMORY(BODIES), MEMORY(R),
        MEMORY(U), ROWS_OF_W, opencl_integer(p->d), opencl_whole(p->slots));
    opencl_launch(o, VELOCITIES, p->slots);
}

/* ---- sums ---- */

/* Columns of parts: n of them, all to be added but those of which the largest is taken, most_first .. most_end-1 */
struct opencl_columns {
    int n, most_first, most_end;
};

/* to[c.n] = the sums of n parts of that many numbers, and the largest of some */
static void sum_parts(struct opencl *o, enum opencl_role parts, int64_t n, struct opencl_columns c,
                      enum opencl_role sum, double *to)
{
    if (!opencl_need(o, sum, (size_t)c.n * sizeof *to)) return;
    SET(SUM_PARTS, 0, MEMORY(parts), opencl_whole(n), opencl_integer(c.n),
        opencl_integer(c.most_first), opencl_integer(c.most_end), MEMORY(sum));
    opencl_launch(o, SUM_PARTS, c.n);
    opencl_take(o, sum, 0, to, (size_t)c.n * sizeof *to);
}

#define COLUMN(member) ((int)(offsetof(struct sums, member) / sizeof(double)))
enum { SUM_COLUMNS = sizeof(struct sums) / sizeof(double) };
static_assert(SUM_COLUMNS == 12 * BUNDLE, "struct sums is what the kernel judge writes");
static_assert(offsetof(struct sums, max_pen) == 8 * BUNDLE * sizeof(double) &&
                  offsetof(struct sums, jammed) == 11 * BUNDLE * sizeof(double),
              "and in its order");

static void opencl_judge(struct device *d, const struct problem *p, bool believes,
                         enum err_terms which, int64_t per_block, struct sums *s)
{
    struct opencl *o = (struct opencl *)d;
    int64_t blocks = (p->bundles + per_block - 1) / per_block;
    const double *end = p->endless, misses = MISSES * p->unit;
    if (!opencl_need(o, JUDGED, (size_t)blocks * sizeof *s)) return;
    SET(JUDGE, 0, MEMORY(BUNDLES), MEMORY(BESIDE), MEMORY(REBOUND), MEMORY(BODIES), MEMORY(R),
        MEMORY(U), MEMORY(W_CC), ROWS_OF_W, opencl_integer(p->d), opencl_whole(p->bundles),
        opencl_integer((int32_t)per_block), opencl_integer(believes),
        opencl_integer((which & ERR_TERMS) != 0), opencl_integer((which & ERR_NATURAL) != 0),
        opencl_real(ROUNDING_OF_R * ROUNDING_OF_R), opencl_real(p->rounded * p->rounded),
        opencl_real(end[0] * end[0]), opencl_real(end[1] * end[1]), opencl_real(misses * misses),
        opencl_real(p->wild * p->wild), MEMORY(JUDGED));
    opencl_launch(o, JUDGE, blocks * BUNDLE);
    const struct opencl_columns columns = { SUM_COLUMNS, COLUMN(max_pen), COLUMN(jammed) };
    sum_parts(o, JUDGED, blocks, columns, JUDGED_SUM, s->motion);
}

/* ---- iterates that are kept ---- */

static void opencl_keep(struct device *d, const struct problem *p, int place, bool u)
{
    struct opencl *o = (struct opencl *)d;
    size_t size = (size_t)p->bundles * sizeof *p->u;
    enum opencl_role r = (enum opencl_role)(KEPT_R + place), v = (enum opencl_role)(KEPT_U + place);
    if (opencl_need(o, r, size)) opencl_copy(o, R, r, size);
    if (u && opencl_need(o, v, size)) opencl_copy(o, U, v, size);
}

static void opencl_restore(struct device *d, const struct problem *p, int place, bool u)
{
    struct opencl *o = (struct opencl *)d;
    size_t size = (size_t)p->bundles * sizeof *p->u;
    opencl_copy(o, (enum opencl_role)(KEPT_R + place), R, size);
    if (u) opencl_copy(o, (enum opencl_role)(KEPT_U + place), U, size);
    if (p->kind.given_by_W) {
        SET(SCATTER, 0, MEMORY(BUNDLES), MEMORY(R), MEMORY(ROW_R), opencl_integer(p->d),
            opencl_whole(p->slots));
        opencl_launch(o, SCATTER, p->slots);
    }
    opencl_renew(d, p);
}

/* ---- Anderson's mixing: f, and then dg[k], df[k] in turn ---- */

static int64_t dg_at(const struct opencl *o, int k)
{
    return (1 + 2 * k) * o->vector;
}
static int64_t df_at(const struct opencl *o, int k)
{
    return (2 + 2 * k) * o->vector;
}

static int mixing(struct device *d, const struct problem *p, int depth)
{
    struct opencl *o = (struct opencl *)d;
    o->vector = p->slots * p->d;
    int64_t all = (1 + 2 * depth) * o->vector;
    if (!opencl_need(o, ROOM, (size_t)all * sizeof(double))) return 0; // it is lost: the solve ends
    SET(CLEAR, 0, MEMORY(ROOM), opencl_whole(all));
    opencl_launch(o, CLEAR, all);
    return 0;
}

static void opencl_remember(struct device *d, const struct problem *p, int next)
{
    struct opencl *o = (struct opencl *)d;
    SET(REMEMBER, 0, MEMORY(R), opencl_integer(p->d), opencl_whole(o->vector), MEMORY(ROOM),
        opencl_whole(df_at(o, next)));
    opencl_launch(o, REMEMBER, o->vector);
}

enum { MIXING_COLUMNS = sizeof(struct mixing_sums) / sizeof(double) };
static_assert(MIXING_COLUMNS == (1 + 2 * MIXING_DEPTH) * BUNDLE && MIXING_DEPTH == 5,
              "struct mixing_sums is what the kernel products writes");

static void opencl_measure(struct device *d, const struct problem *p, const struct mixing *m,
                           int64_t per_chunk, struct mixing_sums *sums)
{
    struct opencl *o = (struct opencl *)d;
    int64_t chunks = (p->bundles + per_chunk - 1) / per_chunk;
    if (!opencl_need(o, MIXED, (size_t)chunks * sizeof *sums)) return;
    SET(CHANGES, 0, MEMORY(R), opencl_integer(p->d), opencl_whole(o->vector), MEMORY(ROOM),
        opencl_whole(0), opencl_whole(dg_at(o, m->next)), opencl_whole(df_at(o, m->next)));
    opencl_launch(o, CHANGES, o->vector);
    SET(PRODUCTS, 0, MEMORY(ROOM), MEMORY(W_CC), opencl_integer(p->d), opencl_integer(m->depth),
        opencl_whole(p->bundles), opencl_integer((int32_t)per_chunk), opencl_whole(0),
        opencl_whole(df_at(o, m->next)), opencl_whole(o->vector), MEMORY(MIXED));
    opencl_launch(o, PRODUCTS, chunks * MIXING_COLUMNS);
    sum_parts(o, MIXED, chunks, (struct opencl_columns){ MIXING_COLUMNS, 0, 0 }, MIXED_SUM,
              sums->f2);
}

static void opencl_react(struct device *d, const struct problem *p, const struct mixing *m,
                         double leap, const double gamma[MIXING_DEPTH])
{
    struct opencl *o = (struct opencl *)d;
    uint32_t next = SET(REACT, 0, MEMORY(LIST), MEMORY(BUNDLES), MEMORY(BESIDE), MEMORY(BODIES),
                        MEMORY(R), MEMORY(ROW_R), opencl_integer(p->d), MEMORY(ROOM),
                        opencl_whole(0), opencl_whole(o->vector), opencl_integer(m->depth),
                        opencl_integer(m->next), opencl_real(leap));
    for (int k = 0; k < MIXING_DEPTH; k++) next = SET(REACT, next, opencl_real(gamma[k]));
    for (int64_t k = 0; k < o->levels; k++) {
        SET(REACT, next, opencl_whole(o->first[k]), opencl_integer((int32_t)in_level(o, k)));
        opencl_launch(o, REACT, in_level(o, k));
    }
}

const struct device_kind device_opencl = {
    .name = "opencl",
    .list = opencl_list,
    .open = opencl_open_device,
    .close = opencl_close,
    .hold = hold,
    .upload = upload,
    .download = download,
    .sweep = opencl_sweep,
    .judge = opencl_judge,
    .velocities = opencl_velocities,
    .renew = opencl_renew,
    .keep = opencl_keep,
    .restore = opencl_restore,
    .mixing = mixing,
    .remember = opencl_remember,
    .measure = opencl_measure,
    .react = opencl_react,
};
