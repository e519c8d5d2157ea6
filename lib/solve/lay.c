/* solve/lay.c: the memory of bundles and bodies [solve/lay.h]. */
#include "solve/lay.h"

#include "base/team.h"
#include "solve/problem.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

enum {
    HUGE_PAGE = 2 << 20, /* bytes */
    LINE = 64,           /* bytes of a cache line */
    MANY_LINES = 8192,   /* lines that are worth a thread to clear: 50 us */
    PER_THREAD = 4096    /* slots that are worth a thread: 100 us of work */
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

bool lay_plan(struct problem *p, const struct plan *l)
{
    p->groups = l->schedule.groups, p->group = l->group;
    p->bundles = l->bundles, p->slots = l->slots, p->contact = l->contact;
    p->seat = l->seat;
    if (l->schedule.rest && !(p->split = lay_lines(1, sizeof *p->split))) return false;
    if (p->split)
        *p->split = (struct two_thread_split){
            l->schedule.beyond, l->schedule.inside, l->schedule.rim, l->schedule.rest, 0, 0
        };
    return true;
}

static bool lay_one(struct problem *p, enum array which)
{
    void *x = lay_lines(p->bundles, problem_array(p, which).size);
    problem_set_array(p, which, x);
    return x != NULL;
}

bool lay_bundles(struct problem *p)
{
    for (int k = 0; k < ARRAYS; k++)
        if (p->kind.arrays >> k & 1 && !lay_one(p, (enum array)k)) return false;
    for (int64_t g = 0; g < p->groups; g++)
        for (int64_t i = p->group[g + 1] * BUNDLE - 1;
             i >= p->group[g] * BUNDLE && p->contact[i] < 0; i--)
            for (int j = 0, k = slot_lane(i); j < 2; j++) {
                struct bundle *c = slot_bundle(p, i);
                p->w[i / BUNDLE][j][k] = c->iw[j][k] = 1;
                if (p->kind.near) bundle_beside(p, c)->w[j][k] = 1;
            }
    for (int64_t i = 0; p->extra && i < p->slots; i++)
        for (int j = 0; j < 2; j++) p->extra[i / BUNDLE].s[j][slot_lane(i)] = 1;
    for (int64_t i = 0; p->turn && i < p->slots; i++)
        for (int j = 0; j < 9; j += 4) p->turn[i / BUNDLE].S[j][slot_lane(i)] = 1;
    return true;
}

/* The copy of a body i (wall w: -1-w) that does not move, of a contact. A load's speed is prescribed here
   [solve/coupling.h]. */
static void lay_copy_body(const struct problem *p, int32_t i, const struct contact *c,
                          struct body *copy)
{
    const struct packing *pack = p->packing;
    if (i >= 0) {
        *copy = p->body[p->seat[i]];
        return;
    }
    const struct wall *wall = &pack->wall[-1 - i];
    vec3 v = v3_add(wall_velocity(pack, wall, c->x), wall_belt(pack, wall, c->n));
    *copy = (struct body){ .v = { v.x, v.y, v.z } };
    if (!p->kind.rolls) return; // its arm is 0: that it turns matters to moments only
    vec3 w = wall_spin(pack, wall);
    copy->w[0] = w.x, copy->w[1] = w.y, copy->w[2] = w.z;
}

struct seating {
    struct problem *p;
    const struct plan *plan;
    const struct contacts *s;
};

static void lay_seat_some(void *arg, int64_t first, int64_t end)
{
    const struct seating *y = arg;
    struct problem *p = y->p;
    int32_t copies = (int32_t)p->packing->n + 2;
    for (int64_t i = BUNDLE * first; i < BUNDLE * end; i++) {
        struct bundle *r = slot_bundle(p, i);
        const int32_t *seat = y->plan->seats[i];
        int k = slot_lane(i);
        r->a[k] = body_place(seat[0]), r->b[k] = body_place(seat[1]);
        for (int j = 0; j < 9 && p->kind.levers; j += 4) // of a lane without a contact
            p->block[i / BUNDLE][j][k] = 1;
        if (p->contact[i] < 0) continue;
        const struct contact *c = &y->s->c[p->contact[i]];
        if (seat[0] >= copies) lay_copy_body(p, c->a, c, &p->body[seat[0]]);
        if (seat[1] >= copies) lay_copy_body(p, c->b, c, &p->body[seat[1]]);
    }
}

void lay_seats(struct problem *p, const struct plan *l, const struct contacts *s)
{
    struct seating y = { p, l, s };
    // w of a lane without a contact is 1, where it is made of masses
    for (int64_t i = 0; i < 2; i++) p->body[p->packing->n + i].im = 0.5;
    team_share(team_size(), p->bundles, PER_THREAD / BUNDLE, lay_seat_some, &y);
}
