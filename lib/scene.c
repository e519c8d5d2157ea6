#include "scene_read.h"

#include <stdlib.h>
#include <string.h>

void *scene_room(jnode n, size_t count, size_t size)
{
    void *p = calloc(count ? count : 1, size);
    if (!p) why_set(n.in->why, EX_SOFTWARE, "no memory for the scene");
    return p;
}

/* The text without the blanks outside its strings. */
static char *compact(const char *text)
{
    char *out = malloc(strlen(text) + 1), *o = out;
    bool inside = false;
    for (const char *s = text; out && *s; s++) {
        if (!inside && strchr(" \t\r\n", *s)) continue;
        if (inside && *s == '\\')
            *o++ = *s++;
        else if (*s == '"')
            inside = !inside;
        *o++ = *s;
    }
    if (out) *o = 0;
    return out;
}

static int read_scene(jnode o, struct scene *s)
{
    int64_t dim = 3, seed = 1;
    double density = 2500;
    bool boxed = false;
    const char *title;
    struct scene_law law = { 0 };
    struct scene_box box = { 0 };
    if (jnode_only(o, "title dim dt theta gravity seed density mu e_n e_t kinds pairs overlap "
                      "bodies walls") ||
        jnode_need(&o, "dt") || jnode_text(jnode_key(&o, "title"), &title) ||
        jnode_integer(jnode_key(&o, "dim"), 2, 3, &dim) ||
        jnode_integer(jnode_key(&o, "seed"), 0, UINT32_MAX, &seed) ||
        jnode_number(jnode_key(&o, "dt"), J_POSITIVE, &s->dt) ||
        jnode_number(jnode_key(&o, "theta"), J_UNIT, &s->theta) ||
        jnode_number(jnode_key(&o, "density"), J_POSITIVE, &density) || scene_read_law(&o, &law) ||
        jnode_bool(jnode_key(&o, "overlap"), &s->overlap))
        return 1;
    s->dim = (int)dim, s->seed = (uint64_t)seed;
    s->g = dim == 2 ? v3(0, -9.81, 0) : v3(0, 0, -9.81);
    return jnode_vector(jnode_key(&o, "gravity"), s->dim, &s->g) ||
           scene_read_kinds(jnode_key(&o, "kinds"), s, density) ||
           scene_read_pairs(jnode_key(&o, "pairs"), s, law) ||
           scene_read_walls(jnode_key(&o, "walls"), s, &box, &boxed) ||
           scene_read_bodies(jnode_key(&o, "bodies"), s, boxed ? &box : NULL);
}

int scene_parse(struct scene *s, const char *text, size_t length, struct why *why)
{
    struct jtext t;
    *s = (struct scene){ .theta = 0.5 };
    if (jtext_parse(&t, text, length, why)) return why->status;
    int bad = read_scene(jtext_root(&t), s);
    if (!bad && !(s->text = compact(t.text)))
        bad = why_set(why, EX_SOFTWARE, "no memory for the scene's text");
    jtext_free(&t);
    if (bad) scene_free(s);
    return why->status;
}

void scene_free(struct scene *s)
{
    for (int32_t k = 0; k < s->kinds; k++) free(s->kind[k].name);
    for (int64_t i = 0; i < s->groups; i++) free(s->bodies[i].file);
    free(s->kind), free(s->law), free(s->bodies), free(s->wall), free(s->text);
    *s = (struct scene){ 0 };
}

/* In x (and y) the cells fill the box; along the last axis they are as low as they can be. */
struct scene_lattice scene_lattice(const struct scene_bodies *b, int dim)
{
    struct scene_lattice l = { .cells = { 1, 1, 1 } };
    double least = 2 * b->spacing * b->size.max;
    for (int i = 0; i < dim; i++) {
        double width = b->box.hi[i] - b->box.lo[i];
        l.cells[i] = floor(width / least * (1 + 1e-12)); // 6.3 mm holds six cells of 1.05 mm
        l.edge[i] = i < dim - 1 ? width / l.cells[i] : least;
    }
    return l;
}
