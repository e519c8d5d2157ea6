#include "run/rollback.h"

#include <stdlib.h>
#include <string.h>

void rollback_free(struct rollback *u)
{
    for (int k = 0; k < BODY_COLUMNS; k++) free(u->column[k]);
    free(u->wall), free(u->recall);
    if (u->whole) packing_free(&u->was), control_free(&u->acts);
    *u = (struct rollback){ 0 };
}

/* The numbers of column k that a step changes, and how many bytes they are; NULL: it changes none */
static void *moving(const struct packing *p, int k, size_t *bytes)
{
    const struct field *b = &body_columns[k];
    *bytes = (size_t)p->n * field_bytes(b);
    return b->traits & FIELD_MOVES ? field_array(b, p) : NULL;
}

static int rollback_no_memory(struct failure *failure)
{
    return failure_set(failure, EX_SOFTWARE, "no memory for the state before a step");
}

/* Has it arrays for just the numbers that p has? */
static bool rollback_fits(const struct rollback *u, const struct packing *p)
{
    size_t bytes;
    bool same = u->wall && u->n == p->n && u->walls == p->walls;
    for (int k = 0; k < BODY_COLUMNS; k++) same = same && !u->column[k] == !moving(p, k, &bytes);
    return same;
}

/* Memory for the parts of p that a step changes */
static int rollback_make_room(struct rollback *u, const struct packing *p, struct failure *failure)
{
    size_t bytes;
    if (!rollback_fits(u, p)) {
        rollback_free(u);
        u->recall = NULL; // as it is; the analyzer loses sight of it
        u->n = p->n, u->walls = p->walls;
        u->wall = malloc(((size_t)p->walls + 1) * sizeof *u->wall);
        bool made = u->wall;
        for (int k = 0; k < BODY_COLUMNS && made; k++)
            if (moving(p, k, &bytes)) made = (u->column[k] = malloc(bytes + 1));
        if (!made) return rollback_free(u), rollback_no_memory(failure);
    }
    if (!u->recall || u->room < p->memory.n) {
        int64_t room = p->memory.n + p->memory.n / 2;
        struct recall *more = realloc(u->recall, ((size_t)room + 1) * sizeof *more);
        if (!more) return rollback_free(u), rollback_no_memory(failure);
        u->recall = more, u->room = room;
    }
    return 0;
}

/* Does a step change more than places and velocities? */
static bool changes_more(const struct packing *p)
{
    return packing_varies(p) || p->law;
}

int rollback_take(struct rollback *u, const struct packing *p, const struct control *acts,
                  struct failure *failure)
{
    size_t bytes;
    if (u->whole) rollback_free(u);
    if (changes_more(p)) {
        rollback_free(u);
        if (packing_copy(&u->was, p, failure))
            return u->was = (struct packing){ 0 }, failure->status;
        if (packing_varies(p) && control_copy(&u->acts, acts, p->walls, failure))
            return packing_free(&u->was), failure->status;
        u->whole = true;
        return 0;
    }
    if (rollback_make_room(u, p, failure)) return failure->status;
    for (int k = 0; k < BODY_COLUMNS; k++) {
        const void *x = moving(p, k, &bytes);
        if (x) memcpy(u->column[k], x, bytes);
    }
    if (p->walls) memcpy(u->wall, p->wall, (size_t)p->walls * sizeof *u->wall);
    if (p->memory.n) memcpy(u->recall, p->memory.recall, (size_t)p->memory.n * sizeof *u->recall);
    u->was = *p;
    return 0;
}

/* The numbers of `was` go into the arrays of p, which go into was: they stay where they are. */
static void keep_places(struct packing *was, struct packing *p)
{
    for (const struct field *b = body_columns; b->name; b++) {
        void *stays = field_array(b, p), *from = field_array(b, was);
        if (!stays || !from) continue;
        memcpy(stays, from, (size_t)was->n * field_bytes(b));
        field_set_array(b, p, from), field_set_array(b, was, stays);
    }
}

void rollback_back(struct rollback *u, struct packing *p, struct control *acts)
{
    size_t bytes;
    if (u->whole) {
        const bool varies = packing_varies(&u->was);
        if (!varies) keep_places(&u->was, p);
        packing_free(p);
        *p = u->was;
        if (varies)
            control_free(acts), *acts = u->acts; // else a step that fails leaves them as they are
        u->whole = false, u->was = (struct packing){ 0 }, u->acts = (struct control){ 0 };
        return;
    }
    for (int k = 0; k < BODY_COLUMNS; k++) {
        void *x = moving(p, k, &bytes);
        if (x) memcpy(x, u->column[k], bytes);
    }
    if (u->walls) memcpy(p->wall, u->wall, (size_t)u->walls * sizeof *u->wall);
    p->step = u->was.step, p->t = u->was.t, p->t0 = u->was.t0, p->step0 = u->was.step0;
    p->dt = u->was.dt, p->cell = u->was.cell;
    free(p->memory.recall); // another than it was, perhaps
    p->memory = (struct memory){ u->was.memory.on, u->was.memory.n, u->room, u->recall };
    u->recall = NULL, u->room = 0;
}
