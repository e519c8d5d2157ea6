/* step/small_seam.c: see step/small_seam.h. */
#include "step/small_seam.h"

#include "contact/internal_edge.h"
#include "step/small_wall.h"

#include <stdlib.h>
#include <string.h>

enum { SEAM_WALLS = 16 }; /* near a ball without asking for memory */

static bool ends(const struct small_run *r, const struct small_touch *t)
{
    const enum wall_shape shape = r->p->wall[t->wall].shape;
    return shape == WALL_RECTANGLE || shape == WALL_DISC;
}

bool small_at_seam(struct small_run *r, int64_t i, double reach)
{
    const struct small_list *l = r->l;
    const int32_t body = l->touch[i].body;
    struct contact few[SEAM_WALLS], *at = few;
    int64_t first = i, end = i + 1, mine = -1;
    if (!ends(r, &l->touch[i])) return false;
    while (first > 0 && l->touch[first - 1].body == body) first--;
    while (end < l->touches && l->touch[end].body == body) end++;
    if (end - first < 2) return false;
    if (end - first > SEAM_WALLS) at = malloc((size_t)(end - first) * sizeof *at);
    struct contacts all = { .c = at };
    if (!at) {
        r->lost = true;
        return false;
    }
    r->x[body] = small_vec(l->s.place[body].x);
    for (int64_t k = end - 1; k >= first; k--) { // the last wall comes first
        struct small_touch t = l->touch[k];
        if (!small_look_at_touch(r, &t, reach)) continue;
        if (k == i) mine = all.n;
        at[all.n++] = (struct contact){ .a = -1 - t.wall,
                                        .b = body,
                                        .n = t.n,
                                        .gap = t.arm - l->s.place[body].r,
                                        .x = v3_axpy(r->x[body], -t.arm, t.n),
                                        .mu = t.mu,
                                        .en = t.e[0],
                                        .et = t.e[1] };
    }
    const struct situation o = {
        .p = r->p, .x = r->x, .t = r->p->t + r->ahead, .surface = l->surface
    };
    const bool seam = mine >= 0 && all.n > 1 && seams_has(&all, &o, body, mine);
    if (at != few) free(at);
    return seam;
}
