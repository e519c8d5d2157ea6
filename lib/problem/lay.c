/* problem/lay.c: bundles, seats and places [problem/laying.h]. */
#include "problem/laying.h"

#include "base/team.h"
#include "problem/problem.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

enum {
    HUGE_PAGE = 2 << 20, /* bytes */
    LINE = 64,           /* bytes of a cache line */
    MANY_LINES = 8192,   /* lines that are worth a thread to clear: 50 us */
    SOME = 4096          /* slots that are worth a thread: 100 us of work */
};

static void clear_some(void *lines, int64_t first, int64_t end)
{
    memset((char *)lines + LINE * first, 0, (size_t)(end - first) * LINE);
}

void *lay_lines(int64_t n, size_t size)
{
    size_t bytes = (size_t)(n > 0 ? n : 1) * size, page = bytes < 2 * HUGE_PAGE ? LINE : HUGE_PAGE;
    bytes = (bytes + page - 1) / page * page;
    void *p = aligned_alloc(page, bytes);
#ifdef MADV_HUGEPAGE
    if (p && page == HUGE_PAGE) madvise(p, bytes, MADV_HUGEPAGE);
#endif
    if (p) team_share(team_size(), (int64_t)(bytes / LINE), MANY_LINES, clear_some, p);
    return p;
}

bool lay_bundles(struct problem *p, const struct schedule *plan)
{
    p->groups = plan->groups;
    p->group = malloc((size_t)(plan->groups + 1) * sizeof *p->group);
    for (int64_t g = 0; p->group && g < plan->groups; g++) {
        p->group[g] = p->bundles;
        p->bundles += (plan->group[g + 1] - plan->group[g] + BUNDLE - 1) / BUNDLE;
    }
    p->slots = p->bundles * BUNDLE;
    p->bundle = lay_lines(p->bundles, sizeof *p->bundle);
    p->w = lay_lines(p->bundles, sizeof *p->w);
    p->rho = lay_lines(p->bundles, sizeof *p->rho);
    p->u = lay_lines(p->bundles, sizeof *p->u);
    p->contact = malloc((size_t)(p->slots + 1) * sizeof *p->contact);
    if (!p->group || !p->bundle || !p->w || !p->rho || !p->u || !p->contact) return false;
    p->group[p->groups] = p->bundles;
    if (plan->rest && !(p->split = lay_lines(1, sizeof *p->split))) return false;
    if (p->split)
        *p->split =
            (struct two_thread_split){ plan->beyond, plan->inside, plan->rim, plan->rest, 0, 0 };
    for (int64_t g = 0; g < p->groups; g++) {
        int64_t first = plan->group[g], n = plan->group[g + 1] - first;
        int64_t at = p->group[g] * BUNDLE, end = p->group[g + 1] * BUNDLE;
        for (int64_t i = 0; i < n; i++) p->contact[at++] = (int32_t)plan->sequence[first + i];
        for (; at < end; at++) {
            struct bundle *c = slot_bundle(p, at);
            p->contact[at] = -1;
            for (int k = 0; k < 2; k++)
                p->w[at / BUNDLE][k][slot_lane(at)] = c->iw[k][slot_lane(at)] = 1;
        }
    }
    return true;
}

static void pair_some(void *arg, int64_t first, int64_t end)
{
    struct laying *y = arg;
    const struct problem *p = y->p;
    int32_t moves[2];
    for (int64_t i = BUNDLE * first; i < BUNDLE * end; i++) {
        const struct contact *c = p->contact[i] < 0 ? NULL : &y->s->c[p->contact[i]];
        y->pair[i][0] = c ? c->a : 0, y->pair[i][1] = c ? c->b : -1;
        y->copies[i / BUNDLE + 1] += c ? 2 - packing_movable(p->packing, c->a, c->b, moves) : 0;
    }
}

bool laying_init(struct laying *y, struct problem *p, const struct contacts *s)
{
    *y = (struct laying){ p, s, malloc((size_t)(p->slots + 1) * sizeof *y->pair),
                          calloc((size_t)p->bundles + 1, sizeof *y->copies) };
    if (!y->pair || !y->copies) return false;
    team_share(team_size(), p->bundles, SOME / BUNDLE, pair_some, y);
    for (int64_t k = 0; k < p->bundles; k++) y->copies[k + 1] += y->copies[k];
    return true;
}

void laying_free(struct laying *y)
{
    free(y->pair), free(y->copies);
}

int32_t *lay_seats(const struct laying *y, enum order order)
{
    int64_t n = y->p->packing->n;
    int32_t *seat = malloc((size_t)(n + 1) * sizeof *seat), next = 0;
    for (int64_t i = 0; seat && i < n; i++) seat[i] = -1;
    for (int64_t i = 0; seat && order >= ORDER_COLOUR && i < y->p->slots; i++) {
        const int32_t *c = y->pair[i];
        if (c[1] < 0) continue;
        if (c[0] >= 0 && seat[c[0]] < 0) seat[c[0]] = next++;
        if (seat[c[1]] < 0) seat[c[1]] = next++;
    }
    for (int64_t i = 0; seat && i < n; i++)
        if (seat[i] < 0) seat[i] = next++;
    return seat;
}

/* The place of a body i (wall w: -1-w) of a contact at x (m): its own, or of a new copy if it does
   not move. A load's speed is prescribed here [problem/coupling.h]. */
static int32_t place_of(struct problem *p, int32_t i, const vec3 *x, int64_t *next)
{
    const struct packing *pack = p->packing;
    if (i >= 0 && pack->mass[i] > 0) return body_place(p->seat[i]);
    struct body *copy = &p->body[*next];
    vec3 v = i < 0 ? wall_velocity(pack, &pack->wall[-1 - i], *x) : pack->v[i];
    *copy = (struct body){ .v = { v.x, v.y, v.z } };
    if (i < 0 && p->rolls) { // its arm is 0: that it turns matters to moments only
        vec3 w = wall_spin(pack, &pack->wall[-1 - i]);
        copy->w[0] = w.x, copy->w[1] = w.y, copy->w[2] = w.z;
    }
    if (i >= 0) *copy = p->body[p->seat[i]];
    return body_place((*next)++);
}

static void place_some(void *arg, int64_t first, int64_t end)
{
    struct laying *y = arg;
    struct problem *p = y->p;
    int32_t nobody = (int32_t)p->packing->n;
    int64_t other = p->split ? BUNDLE * p->group[p->split->inside] : p->slots;
    int64_t next = nobody + 2 + y->copies[first];
    for (int64_t i = BUNDLE * first; i < BUNDLE * end; i++) {
        struct bundle *r = slot_bundle(p, i);
        const int32_t *body = y->pair[i];
        int k = slot_lane(i);
        r->a[k] = r->b[k] = body_place(nobody + (i >= other));
        for (int j = 0; j < 9 && p->lever; j += 4) // of a lane without a contact
            p->block[i / BUNDLE][j][k] = 1;
        if (body[1] < 0) continue;
        const vec3 *x = &y->s->c[p->contact[i]].x;
        r->a[k] = place_of(p, body[0], x, &next), r->b[k] = place_of(p, body[1], x, &next);
    }
}

void lay_places(struct laying *y)
{
    // w of a lane without a contact is 1, where it is made of masses
    for (int64_t i = 0; i < 2; i++) y->p->body[y->p->packing->n + i].im = 0.5;
    team_share(team_size(), y->p->bundles, SOME / BUNDLE, place_some, y);
}
