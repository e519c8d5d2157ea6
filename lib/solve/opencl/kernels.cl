/*
 * solve/opencl/kernels.cl: the kernels of a device. Each is the loop body of sweep.c, judge.c, mixing.c or walk.h
 * for one slot, in the same order of operations. Macros of the build: METHOD, the local method; EXACT, that it is
 * exact; FULL, W_cc is full;
 * GIVEN, there is only W.
 *
 * Arrays are as in struct problem, [bundles][..][8], but r, which has an array of its own: r[bundles][3][8].
 */

enum { TEAM = 64 }; /* work-items of a group: as in opencl.c */

#define PASTE_(a, b) a##b
#define PASTE(a, b)  PASTE_(a, b)

ALWAYS_INLINE vm exact_search_lanes(const struct local *l, vm m, vm singular, vd r[3])
{
    struct search *s = l->search;
    if (!m) return NONE;
    if (s->answered) {
        for (int i = 0; i < 3; i++) r[i] = s->r[i];
        return -(vm)(s->found != 0);
    }
    s->asked = 1, s->singular = singular != 0;
    return NONE;
}

/* One question to the CPU, with room for its answer; as in opencl.c */
struct question {
    double W[9], b[3], mu, r[3];
    int64_t slot;
    int singular, found;
};

/* ---- what is given of a problem ---- */

/* W as rows of blocks in the order of the slots [solve/delassus.h] */
struct rows {
    __global const int64_t *first;
    __global const int32_t *col;
    __global const double *block, *q, *r;
};

#define GIVEN_BY_W                                                                                 \
    __global const int64_t *row_first, __global const int32_t *row_col,                            \
        __global const double *row_block, __global const double *row_q, __global double *row_r,    \
        __global const double *block
#define ROWS ((struct rows){ row_first, row_col, row_block, row_q, row_r })

/* As blocks_gather() of one lane */
ALWAYS_INLINE void gather(const struct rows *W, int64_t slot, int d, double b[3])
{
    __global const double *B = W->block + d * d * W->first[slot], *q = W->q + d * slot;
    int64_t end = W->first[slot + 1];
    for (int i = 0; i < 3; i++) b[i] = i < d ? q[i] : 0;
    for (int64_t k = W->first[slot]; k < end; k++, B += d * d) {
        __global const double *x = W->r + d * (int64_t)W->col[k];
        for (int i = 0; i < d; i++)
            b[i] += d == 2 ? B[i] * x[0] + B[2 + i] * x[1]
                           : B[i] * x[0] + B[3 + i] * x[1] + B[6 + i] * x[2];
    }
}

#define AT(slot, component, width)                                                                 \
    (((slot) / BUNDLE * (width) + (component)) * BUNDLE + (slot) % BUNDLE)

ALWAYS_INLINE void load_block(__global const double *block, int64_t slot, double W[9])
{
    for (int i = 0; i < 9; i++) W[i] = block[AT(slot, i, 9)];
}

/* What may stand behind a bundle, of which t1 is then no more to be computed; NULL: it is */
#define BESIDE(slot) (beside ? &beside[(slot) / BUNDLE] : NULL)

/* As motion_velocity() of solve/judge.c */
ALWAYS_INLINE void motion_velocity(__global const struct bundle *bundle,
                                   __global const struct beside *beside,
                                   __global const struct rebound *rebound,
                                   __global struct body *body, const struct rows *W,
                                   __global const double *block, int64_t slot, int d,
                                   const double r[3], double u[3])
{
    __global const struct bundle *c = &bundle[slot / BUNDLE];
    int k = slot % BUNDLE;
#if GIVEN
    double own[9], b[3];
    struct local l;
    load_block(block, slot, own);
    l.W = own;
    if (c->a[k] >= 0)
        gather(W, slot, d, l.b);
    else
        l.b[0] = l.b[1] = l.b[2] = 0;
    local_velocity(&l, r, u);
#else
    struct bodies a, b;
    struct twist ma, mb;
    double t1[3], t2[3];
    bodies_load(&a, body, c->a + k, &ma), bodies_load(&b, body, c->b + k, &mb);
    __global const struct rebound *e = rebound ? &rebound[slot / BUNDLE] : NULL;
    bundle_velocity(c, BESIDE(slot), e, k, &ma, &mb, u, t1, t2);
    if (e) bundle_soften(e, k, r, u);
#endif
}

/* Passes a change dr of r on to the bodies, or r to W's */
ALWAYS_INLINE void pass_on(__global const struct bundle *bundle,
                           __global const struct beside *beside, __global struct body *body,
                           __global double *row_r, int64_t slot, int d, const double r[3],
                           const double dr[3])
{
    __global const struct bundle *c = &bundle[slot / BUNDLE];
    int k = slot % BUNDLE;
#if GIVEN
    for (int i = 0; i < d && c->a[k] >= 0; i++) row_r[d * (int64_t)c->a[k] + i] = r[i];
#else
    struct bodies a, b;
    struct twist ma, mb;
    double n[3], t1[3], t2[3];
    bodies_load(&a, body, c->a + k, &ma), bodies_load(&b, body, c->b + k, &mb);
    bundle_basis(c, BESIDE(slot), k, n, t1, t2);
    bundle_push(c, k, t1, t2, dr, body, &a, &b);
#endif
}

/* ---- the sweep ---- */

struct counts {
    double change, newton, safeguarded, gave_up;
};

/* The local problem as make_local() of solve/sweep.c has it */
ALWAYS_INLINE void make_local(__global const struct bundle *bundle,
                              __global const struct beside *beside,
                              __global const struct rebound *rebound, __global struct body *body,
                              const struct rows *rows, __global const double *block,
                              __global const double *w, int64_t slot, double W[9], struct local *l)
{
    __global const struct bundle *c = &bundle[slot / BUNDLE];
    int k = slot % BUNDLE;
#if GIVEN
    gather(rows, slot, l->d, l->b);
#if FULL
    load_block(block, slot, W);
#endif
    for (int i = 0; i < 3; i++) {
        l->w[i] = FULL ? W[4 * i] : w[AT(slot, i > 0, 2)];
        l->iw[i] = FULL ? 0 : c->iw[i > 0][k];
    }
    local_velocity(l, l->r, l->v);
#else
    struct bodies a, b;
    struct twist ma, mb;
    double t1[3], t2[3], la = c->la[k], lb = c->lb[k];
    __global const struct rebound *e = rebound ? &rebound[slot / BUNDLE] : NULL;
    bodies_load(&a, body, c->a + k, &ma), bodies_load(&b, body, c->b + k, &mb);
    bundle_velocity(c, BESIDE(slot), e, k, &ma, &mb, l->v, t1, t2);
    if (e) bundle_soften(e, k, l->r, l->v);
    double im = a.im + b.im, it = im + la * la * a.ii + lb * lb * b.ii;
    l->w[0] = e ? e->s[0][k] * im + e->soft[0][k] : im;
    l->w[1] = l->w[2] = e ? e->s[1][k] * it + e->soft[1][k] : it;
    for (int i = 0; i < 3; i++) {
        l->iw[i] = c->iw[i > 0][k];
        l->b[i] = l->v[i] - l->w[i] * l->r[i];
    }
#endif
}

/* As solve_relaxed() of solve/sweep.c */
ALWAYS_INLINE void solve_relaxed(struct local *l, const double was[3], const struct local_opt *o,
                                 double relax)
{
#if EXACT && !FULL
    const bool within = true;
#else
    const bool within = false;
#endif
    l->relax = within ? relax : 1;
    PASTE(METHOD, _solve)(l, o);
    if (within || relax == 1) return;
    double tau[3];
    for (int i = 0; i < 3; i++) tau[i] = was[i] + relax * (l->r[i] - was[i]);
    cone_project(l->mu, tau, l->r);
}

#define SWEEP_OF                                                                                   \
    __global const struct bundle *bundle, __global const struct beside *beside,                    \
        __global const struct rebound *rebound, __global struct body *body, __global double *r,    \
        __global double *u, __global const double *w, __global const double *rho, GIVEN_BY_W,      \
        int d, double relax, double newton_eps, double newton_abs, int newton_max, int plain,      \
        int keep, __global struct question *question, __global int *questions
#define SWEEP_WITH                                                                                 \
    bundle, beside, rebound, body, r, u, w, rho, row_first, row_col, row_block, row_q, row_r,      \
        block, d, relax, newton_eps, newton_abs, newton_max, plain, keep, question, questions

/* Solves a slot; without an answer that it needs it asks, and leaves the slot as it is. */
ALWAYS_INLINE void solve_slot(SWEEP_OF, int64_t slot, struct search *search, struct counts *t)
{
    __global const struct bundle *c = &bundle[slot / BUNDLE];
    int k = slot % BUNDLE;
    const struct local_opt o = { plain != 0, newton_eps, newton_abs, newton_max };
    const struct rows rows = ROWS;
    double W[9], was[3], dr[3];
    struct local l;
    l.d = d, l.W = FULL ? W : NULL, l.search = search;
    l.mu = c->mu[k];
    l.rho = EXACT ? 1 : rho[slot];
    for (int i = 0; i < 3; i++) was[i] = l.r[i] = r[AT(slot, i, 3)];
    make_local(bundle, beside, rebound, body, &rows, block, w, slot, W, &l);
    solve_relaxed(&l, was, &o, relax);
    if (search->asked) {
        __global struct question *q = &question[atomic_inc(questions)];
        for (int i = 0; i < 9; i++) q->W[i] = W[i];
        for (int i = 0; i < 3; i++) q->b[i] = l.b[i], q->r[i] = was[i];
        q->mu = l.mu, q->slot = slot, q->singular = search->singular, q->found = 0;
        return;
    }
    for (int i = 0; i < 3; i++) dr[i] = l.r[i] - was[i], r[AT(slot, i, 3)] = l.r[i];
    if (keep) {
        double moves[3];
        local_velocity(&l, l.r, moves);
        for (int i = 0; i < 3; i++) u[AT(slot, i, 3)] = moves[i];
    }
    t->change = larger(absolute(dr[0]) * l.w[0], t->change);
    t->newton += pick(lt(0, l.rho), l.steps, 0);
    t->safeguarded += pick(l.safeguarded, 1, 0);
    t->gave_up += pick(l.gave_up, 1, 0);
    pass_on(bundle, beside, body, row_r, slot, d, l.r, dr);
}

ALWAYS_INLINE struct counts sum_counts(__local const struct counts *of)
{
    struct counts sum = { 0, 0, 0, 0 };
    for (int i = 0; i < TEAM; i++) {
        sum.change = larger(of[i].change, sum.change);
        sum.newton += of[i].newton;
        sum.safeguarded += of[i].safeguarded, sum.gave_up += of[i].gave_up;
    }
    return sum;
}

/* part[of the team] = the counts of a team: sums of whole numbers, and a largest, in any order the same */
ALWAYS_INLINE void team_counts(__local struct counts *mine, const struct counts *t,
                               __global struct counts *part)
{
    int me = get_local_id(0);
    mine[me] = *t;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (me) return;
    part[get_group_id(0)] = sum_counts(mine);
}

/* n slots of list[] from `first` on, which do not depend on each other; part[] from part_first on */
__kernel void sweep(SWEEP_OF, __global struct counts *part, __global const int *list, long first,
                    int n, long part_first)
{
    __local struct counts mine[TEAM];
    struct counts t = { 0, 0, 0, 0 };
    struct search search = { 0, 0, 0, 0, { 0, 0, 0 } };
    if (get_global_id(0) < n) solve_slot(SWEEP_WITH, list[first + get_global_id(0)], &search, &t);
    team_counts(mine, &t, part + part_first);
}

/* Those of them that have asked, with their n answers; their counts are added to part[part_first]. */
__kernel void sweep_answered(SWEEP_OF, __global struct counts *part, int n, long part_first)
{
    if (get_global_id(0) > 0) return;
    struct counts t = part[part_first];
    for (int i = 0; i < n; i++) {
        __global const struct question *q = &question[i];
        struct search search = { 0, 1, q->found, q->singular, { q->r[0], q->r[1], q->r[2] } };
        solve_slot(SWEEP_WITH, q->slot, &search, &t);
    }
    part[part_first] = t;
}

/* tally = the counts of a sweep; by one team */
__kernel void tally_counts(__global const struct counts *part, long n,
                           __global struct counts *tally)
{
    __local struct counts mine[TEAM];
    struct counts t = { 0, 0, 0, 0 };
    for (int64_t i = get_local_id(0); i < n; i += TEAM) {
        t.change = larger(part[i].change, t.change);
        t.newton += part[i].newton;
        t.safeguarded += part[i].safeguarded, t.gave_up += part[i].gave_up;
    }
    int me = get_local_id(0);
    mine[me] = t;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (me) return;
    tally[0] = sum_counts(mine);
}

/* ---- velocities from the reactions ---- */

/* Adds to the bodies' velocities what the reactions of n slots of list[] make of them */
__kernel void push(__global const int *list, __global const struct bundle *bundle,
                   __global const struct beside *beside, __global struct body *body,
                   __global const double *r, __global double *row_r, int d, long first, int n)
{
    if (get_global_id(0) >= n) return;
    int64_t slot = list[first + get_global_id(0)];
    const double dr[3] = { r[AT(slot, 0, 3)], r[AT(slot, 1, 3)], r[AT(slot, 2, 3)] };
    pass_on(bundle, beside, body, row_r, slot, d, dr, dr);
}

/* u of the slots becomes the motion's */
__kernel void velocities(__global const struct bundle *bundle, __global const struct beside *beside,
                         __global const struct rebound *rebound, __global struct body *body,
                         __global const double *r, __global double *u, GIVEN_BY_W, int d,
                         long slots)
{
    int64_t slot = get_global_id(0);
    if (slot >= slots) return;
    const struct rows rows = ROWS;
    const double of[3] = { r[AT(slot, 0, 3)], r[AT(slot, 1, 3)], r[AT(slot, 2, 3)] };
    double v[3];
    motion_velocity(bundle, beside, rebound, body, &rows, block, slot, d, of, v);
    for (int i = 0; i < 3; i++) u[AT(slot, i, 3)] = v[i];
}

/* ---- the errors, as in solve/judge.c: a work-item has a lane of a block of bundles, in their order ---- */

ALWAYS_INLINE double apart(const double a[3], const double b[3])
{
    double d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
    return norm3(d);
}

ALWAYS_INLINE double natural2(double mu, const double r[3], double rho, const double u[3])
{
    double tau[3] = { r[0] - rho * (u[0] + mu * norm2(u + 1)), r[1] - rho * u[1],
                      r[2] - rho * u[2] };
    double proj[3];
    cone_project(mu, tau, proj);
    double d = apart(r, proj);
    return d * d;
}

/* Sums as struct sums of solve/judge.h has them: SUM_..[8] each */
enum {
    SUM_MOTION,
    SUM_PROJ,
    SUM_BIPOTENTIAL,
    SUM_PENETRATION,
    SUM_NATURAL2,
    SUM_SICONOS2,
    SUM_VELOCITY2,
    SUM_R2,
    SUM_MAX_PEN,
    SUM_MAX_TRUE,
    SUM_MAX_VELOCITY2,
    SUM_JAMMED,
    SUMS
};

__kernel void judge(__global const struct bundle *bundle, __global const struct beside *beside,
                    __global const struct rebound *rebound, __global struct body *body,
                    __global const double *r, __global const double *belief,
                    __global const double *w, GIVEN_BY_W, int d, long bundles, int per_block,
                    int believes, int terms, int natural, double rounding2, double rounded2, double push_end2,
                    double r_end2, double misses2, double wild2, __global double *out)
{
    int64_t which = get_global_id(0) / BUNDLE, first = which * per_block, end = first + per_block;
    int k = get_global_id(0) % BUNDLE;
    const struct rows rows = ROWS;
    double sum[SUMS];
    if (first >= bundles) return;
    if (end > bundles) end = bundles;
    for (int i = 0; i < SUMS; i++) sum[i] = 0;
    for (int64_t i = first; i < end; i++) {
        int64_t slot = i * BUNDLE + k;
        double mu = bundle[i].mu[k], of[3], moves[3], u[3], proj[3];
        for (int j = 0; j < 3; j++) of[j] = r[AT(slot, j, 3)];
        motion_velocity(bundle, beside, rebound, body, &rows, block, slot, d, of, moves);
        if (terms) {
            for (int j = 0; j < 3; j++) u[j] = believes ? belief[AT(slot, j, 3)] : moves[j];
            cone_project(mu, of, proj);
            if (believes) sum[SUM_MOTION] += apart(u, moves);
            sum[SUM_PROJ] += apart(of, proj);
            sum[SUM_BIPOTENTIAL] += absolute(dot3(u, of) + mu * of[0] * norm2(u + 1));
            sum[SUM_PENETRATION] += larger(-u[0], 0);
            sum[SUM_MAX_PEN] = larger(-u[0], sum[SUM_MAX_PEN]);
            sum[SUM_MAX_TRUE] = larger(-moves[0], sum[SUM_MAX_TRUE]);
        }
        if (natural) {
            double lambda = larger(w[AT(slot, 0, 2)], w[AT(slot, 1, 2)]);
            double rho = lambda > 0 ? 1.0 / lambda : 1;
            double n2 = natural2(mu, of, rho, moves), r2 = dot3(of, of);
            double off2 = n2 / (rho * rho), push2 = r2 / (rho * rho);
            double seen2 = rounded2 < push2 ? larger(off2, rounding2 * push2) : off2;
            bool jammed = push_end2 < push2 && r_end2 < r2 && misses2 < seen2 &&
                          off2 < wild2;
            sum[SUM_NATURAL2] += n2, sum[SUM_VELOCITY2] += off2;
            sum[SUM_MAX_VELOCITY2] = larger(jammed ? 0 : seen2, sum[SUM_MAX_VELOCITY2]);
            sum[SUM_JAMMED] += jammed ? 1 : 0;
            sum[SUM_SICONOS2] += natural2(mu, of, 1, moves), sum[SUM_R2] += r2;
        }
    }
    for (int i = 0; i < SUMS; i++) out[(which * SUMS + i) * BUNDLE + k] = sum[i];
}

/* ---- partial sums, in their order ---- */

/* out[columns] = the sums of in[n][columns], from 0; the largest in columns most_first .. most_end-1 */
__kernel void sum_parts(__global const double *in, long n, int columns, int most_first,
                        int most_end, __global double *out)
{
    int column = get_global_id(0);
    double sum = 0;
    if (column >= columns) return;
    bool most = column >= most_first && column < most_end;
    for (int64_t i = 0; i < n; i++) {
        double x = in[i * columns + column];
        sum = most ? fmax(sum, x) : sum + x;
    }
    out[column] = sum;
}

/* ---- Anderson's mixing [solve/mixing.h], of vectors [bundles][d][8] in one array `room` ---- */

__kernel void clear(__global double *x, long n)
{
    if (get_global_id(0) < n) x[get_global_id(0)] = 0;
}

/* W->r of all slots' r */
__kernel void scatter(__global const struct bundle *bundle, __global const double *r,
                      __global double *row_r, int d, long slots)
{
    int64_t slot = get_global_id(0);
    if (slot >= slots) return;
    int a = bundle[slot / BUNDLE].a[slot % BUNDLE];
    for (int i = 0; i < d && a >= 0; i++) row_r[d * (int64_t)a + i] = r[AT(slot, i, 3)];
}

/* df[next] = r */
__kernel void remember(__global const double *r, int d, long numbers, __global double *room,
                       long df)
{
    int64_t at = get_global_id(0), bundle = at / (d * BUNDLE);
    if (at < numbers) room[df + at] = r[bundle * 3 * BUNDLE + at % (d * BUNDLE)];
}

/* f, and the changes of g and f, into dg[next] and df[next] */
__kernel void changes(__global const double *r, int d, long numbers, __global double *room, long f,
                      long dg, long df)
{
    int64_t at = get_global_id(0), bundle = at / (d * BUNDLE);
    if (at >= numbers) return;
    double g = r[bundle * 3 * BUNDLE + at % (d * BUNDLE)], now = g - room[df + at];
    double change = now - room[f + at];
    room[dg + at] = g - room[dg + at], room[df + at] = change, room[f + at] = now;
}

/* Of a chunk of bundles, a lane and one sum: f.f, then df[next].df[j], then f.df[j], j < 5, from vector_first on */
__kernel void products(__global const double *room, __global const double *w, int d, int depth,
                       long bundles, int per_chunk, long f, long next, long size,
                       __global double *out)
{
    enum { DEPTH = 5, PRODUCTS = 1 + 2 * DEPTH };
    int64_t item = get_global_id(0), which = item / (PRODUCTS * BUNDLE), first = which * per_chunk;
    int k = item % BUNDLE, product = item / BUNDLE % PRODUCTS;
    int64_t end = first + per_chunk;
    int j = (product - 1) % DEPTH;
    if (first >= bundles) return;
    if (end > bundles) end = bundles;
    double sum = 0;
    __global const double *x = room + f, *y = x; // x weighted, times y
    if (product > 0) y = room + f + (2 + 2 * j) * size;
    if (product > 0 && product <= DEPTH) x = room + next;
    if (product == 0 || j < depth)
        for (int64_t i = first; i < end; i++) {
            double lambda = larger(w[AT(i * BUNDLE + k, 0, 2)], w[AT(i * BUNDLE + k, 1, 2)]);
            for (int l = 0; l < d; l++) {
                int64_t at = (i * d + l) * BUNDLE + k;
                sum += lambda * x[at] * y[at];
            }
        }
    out[item] = sum;
}

/* r = x = g + leap f - sum_j gamma_j dg_j, projected onto the discs, of n slots of list[]; the bodies follow */
__kernel void react(__global const int *list, __global const struct bundle *bundle,
                    __global const struct beside *beside, __global struct body *body,
                    __global double *r, __global double *row_r, int d, __global double *room,
                    long f, long size, int depth, int next, double leap, double gamma0,
                    double gamma1, double gamma2, double gamma3, double gamma4, long first, int n)
{
    if (get_global_id(0) >= n) return;
    int64_t slot = list[first + get_global_id(0)];
    const double gamma[5] = { gamma0, gamma1, gamma2, gamma3, gamma4 };
    double x[3] = { 0, 0, 0 }, now[3], dr[3];
    for (int l = 0; l < d; l++) {
        int64_t at = AT(slot, l, d);
        x[l] = r[AT(slot, l, 3)] + leap * room[f + at];
        for (int j = 0; j < depth; j++) x[l] -= gamma[j] * room[f + (1 + 2 * j) * size + at];
    }
    disc_project(bundle[slot / BUNDLE].mu[slot % BUNDLE], x, now);
    for (int l = 0; l < 3; l++) {
        double was = r[AT(slot, l, 3)];
        dr[l] = now[l] - was, r[AT(slot, l, 3)] = now[l];
        if (l >= d) continue;
        int64_t at = AT(slot, l, d);
        room[f + (1 + 2 * next) * size + at] = was, room[f + (2 + 2 * next) * size + at] = now[l];
    }
    pass_on(bundle, beside, body, row_r, slot, d, now, dr);
}
