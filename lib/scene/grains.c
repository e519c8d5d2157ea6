#include "scene/grains.h"

#include <stdlib.h>
#include <string.h>

struct grain grain_at(vec3 x, double r)
{
    return (struct grain){ .x = x, .q = { 1, 0, 0, 0 }, .r = r, .kind = -1, .id = -1 };
}

int grains_add(struct grains *t, const struct grain *g, struct failure *failure)
{
    if (t->n == t->room) {
        int64_t room = t->room ? 2 * t->room : 256;
        struct grain *more = realloc(t->g, (size_t)room * sizeof *more);
        if (!more) return failure_set(failure, EX_SOFTWARE, "no memory for the bodies");
        t->g = more, t->room = room;
    }
    t->g[t->n++] = *g;
    return 0;
}

void grains_free(struct grains *t)
{
    free(t->g);
    *t = (struct grains){ 0 };
}

/* The scene's kind of this name; -1 where it has none */
static int32_t grains_kind_named(const struct scene *s, const char *name)
{
    for (int32_t k = 0; k < s->kinds; k++)
        if (!strcmp(s->kind[k].name, name)) return k;
    return -1;
}

int32_t grains_kind(const struct scene *s, const struct scene_bodies *b, int32_t k)
{
    const struct packing *p = b->document;
    if (!b->foreign) return grains_kind_named(s, p->kind_name[k]);
    for (int32_t i = 0; i < b->types; i++)
        if (!strcmp(b->type[i].name, p->kind_name[k])) return b->type[i].kind;
    int32_t kind = grains_kind_named(s, p->kind_name[k]);
    return kind < 0 && p->kinds == 1 && !b->types ? 0 : kind;
}

/* kind[k]: the scene's kind for kind k of the document */
static int grains_add_body(struct grains *out, const struct scene_bodies *b, const int32_t *kind,
                    int64_t i, struct failure *failure)
{
    const struct packing *p = b->document;
    struct grain g = grain_at(p->x[i], p->radius[i]);
    g.q = p->q[i], g.id = p->id[i];
    g.shape = p->shape ? p->shape[i] : 0;
    g.group = p->group ? p->group[i] : 0;
    g.has_v = g.has_w = true;
    if (!b->at_rest) g.v = p->v[i], g.w = p->w[i];
    g.weighs = true, g.mass = p->mass[i], g.inertia = p->inertia[i], g.fixed = p->mass[i] == 0;
    if (b->unsaid && g.mass == 0) g.weighs = g.fixed = false;
    g.kind = b->has_kind ? b->kind : kind[p->kind[i]];
    if (g.kind < 0 && b->foreign)
        return failure_set(failure, EX_DATAERR,
                       "%s: ball %lld is of type %s: which kind is that? \"types\": {\"%s\": NAME}",
                       b->file, (long long)i, p->kind_name[p->kind[i]], p->kind_name[p->kind[i]]);
    if (g.kind < 0)
        return failure_set(failure, EX_DATAERR, "%s: body %lld is of kind \"%s\": name it under \"kinds\"",
                       b->file, (long long)i, p->kind_name[p->kind[i]]);
    return grains_add(out, &g, failure);
}

int grains_of_document(struct grains *out, const struct scene *s, const struct scene_bodies *b,
                       struct failure *failure)
{
    if (!b->document)
        return failure_set(failure, EX_DATAERR, "%s: a document, which is not read here", b->file);
    if (b->document->dim != s->dim)
        return failure_set(failure, EX_DATAERR, "%s: its dim is %d, and the scene's is %d", b->file,
                       b->document->dim, s->dim);
    int32_t *kind = calloc((size_t)b->document->kinds + 1, sizeof *kind);
    if (!kind) return failure_set(failure, EX_SOFTWARE, "no memory for the bodies");
    for (int32_t k = 0; k < b->document->kinds; k++) kind[k] = grains_kind(s, b, k);
    for (int64_t i = 0; i < b->document->n && !failure->status; i++) grains_add_body(out, b, kind, i, failure);
    free(kind);
    return failure->status;
}
