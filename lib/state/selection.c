#include "state/selection.h"

#include "state/face_of.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void selection_free(struct selection *c)
{
    free(c->wall), free(c->name), free(c->material);
    *c = (struct selection){ 0 };
}

/* What there is to choose, as long as there is room */
static void list_all(const struct packing *p, char *text, size_t room)
{
    size_t at = 0;
    text[0] = 0;
    for (int32_t k = 0; k < p->names.n + p->materials && at < room; k++) {
        const char *name = k < p->names.n ? p->names.text[k] : p->material_name[k - p->names.n];
        at += (size_t)snprintf(text + at, room - at, "%s%s", k ? ", " : "", name);
    }
    if (p->walls && at < room)
        at += (size_t)snprintf(text + at, room - at, ", or a wall's number, 0 to %d", p->walls - 1);
    if (at >= room) snprintf(text + room - 4, 4, "...");
}

static bool choose_number(struct selection *c, const struct packing *p, const char *word, size_t n)
{
    long k = 0;
    if (!n || n > 9) return false;
    for (size_t i = 0; i < n; i++) {
        if (word[i] < '0' || word[i] > '9') return false;
        k = 10 * k + (word[i] - '0');
    }
    if (k >= p->walls) return false;
    return c->wall[k] = true;
}

static bool selection_choose(struct selection *c, const struct packing *p, const char *word,
                             size_t n)
{
    int32_t name = names_find(&p->names, word, n);
    if (choose_number(c, p, word, n)) return true;
    if (name >= 0) {
        c->name[name] = true;
        for (int32_t k = 0; k < p->names.rows; k++)
            if (p->names.row[k].name == name && !p->names.row[k].count)
                c->wall[p->names.row[k].wall] = true;
        return true;
    }
    for (int32_t k = 0; k < p->materials; k++) {
        if (strncmp(p->material_name[k], word, n) != 0 || p->material_name[k][n]) continue;
        c->material[k] = true;
        for (int32_t w = 0; w < p->walls; w++) c->wall[w] = c->wall[w] || p->wall[w].material == k;
        return true;
    }
    return false;
}

/* A name without rows is that of a group. */
static bool is_of_walls(const struct packing *p, int32_t name)
{
    for (int32_t k = 0; k < p->names.rows; k++)
        if (p->names.row[k].name == name) return true;
    return false;
}

int selection_init(struct selection *c, const struct packing *p, const char *option,
                   const char *list, struct failure *failure)
{
    *c = (struct selection){ .any = list };
    if (!list) return 0;
    c->wall = calloc((size_t)p->walls + 1, sizeof *c->wall);
    c->name = calloc((size_t)p->names.n + 1, sizeof *c->name);
    c->material = calloc((size_t)p->materials + 1, sizeof *c->material);
    if (!c->wall || !c->name || !c->material)
        failure_set(failure, EX_SOFTWARE, "no memory for names");
    for (const char *s = list; !failure->status; s++) {
        size_t n = strcspn(s, ",");
        char all[240];
        if (!selection_choose(c, p, s, n)) {
            list_all(p, all, sizeof all);
            failure_set(failure, EX_DATAERR, "%s: no '%.*s' here, but %s", option,
                        (int)(n > NAME_BYTES ? NAME_BYTES : n), s, all);
        }
        s += n;
        if (!*s) break;
    }
    if (failure->status) return selection_free(c), failure->status;
    for (int32_t w = 0; w < p->walls; w++) c->walls = c->walls || selection_wall(c, p, w);
    for (int32_t k = 0; k < p->materials; k++) c->bodies = c->bodies || c->material[k];
    for (int32_t k = 0; k < p->names.n; k++)
        c->bodies = c->bodies || (c->name[k] && !is_of_walls(p, k));
    return 0;
}

bool selection_face(const struct selection *c, const struct packing *p, int32_t wall, int32_t face)
{
    if (!c->any || c->wall[wall]) return true;
    for (int32_t k = 0; k < p->names.rows; k++) {
        const struct named *r = &p->names.row[k];
        if (c->name[r->name] && r->wall == wall && face >= r->first && face < r->first + r->count)
            return true;
    }
    return false;
}

bool selection_wall(const struct selection *c, const struct packing *p, int32_t wall)
{
    if (!c->any || c->wall[wall]) return true;
    for (int32_t k = 0; k < p->names.rows; k++)
        if (c->name[p->names.row[k].name] && p->names.row[k].wall == wall) return true;
    return false;
}

bool selection_body(const struct selection *c, const struct packing *p, int64_t i)
{
    if (!c->any || c->material[p->material[i]]) return true;
    return p->group && p->group[i] > 0 && c->name[p->group[i] - 1];
}

bool selection_contact(const struct selection *c, const struct packing *p,
                       const struct wall_faces *faces, const struct contact *contact)
{
    if (selection_body(c, p, contact->b)) return true;
    if (contact->a >= 0) return selection_body(c, p, contact->a);
    return selection_face(c, p, -1 - contact->a, face_of_contact(faces, p, contact, 0));
}
