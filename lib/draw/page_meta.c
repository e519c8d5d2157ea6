/* draw/page_meta.c: the element "meta" of a page [draw/page_meta.h]. */
#include "draw/page_meta.h"

#include "base/json.h"

#include <jansson.h>

static json_t *vec_json(vec3 x)
{
    const double three[3] = { x.x, x.y, x.z };
    return json_numbers(three, 3);
}

static json_t *cell_json(const struct page_moment *m)
{
    json_t *j = json_pack("{s:[b,b,b]}", "repeats", m->repeats[0], m->repeats[1], m->repeats[2]);
    json_object_set_new(j, "origin", vec_json(m->origin));
    json_object_set_new(
        j, "edge",
        json_pack("[o,o,o]", vec_json(m->edge[0]), vec_json(m->edge[1]), vec_json(m->edge[2])));
    return j;
}

static json_t *moment_json(const struct page_moment *m)
{
    json_t *j =
        json_pack("{s:I, s:I, s:I, s:I, s:o}", "s", (json_int_t)m->step, "n", (json_int_t)m->n, "c",
                  (json_int_t)m->contacts, "g", (json_int_t)m->grains, "t", json_number(m->t));
    if (m->walls >= 0) json_object_set_new(j, "b", json_integer(m->walls));
    if (m->shapes >= 0) json_object_set_new(j, "h", json_integer(m->shapes));
    if (m->repeats[0] || m->repeats[1] || m->repeats[2])
        json_object_set_new(j, "cell", cell_json(m));
    json_object_set_new(j, "lo", json_numbers(m->lo, 3));
    json_object_set_new(j, "step", json_numbers(m->quantum, 3));
    json_object_set_new(j, "vmax", json_number(m->vmax));
    json_object_set_new(j, "wmax", json_number(m->wmax));
    json_object_set_new(j, "fmax", json_number(m->fmax));
    return j;
}

static json_t *range_json(const struct page *p)
{
    const double lo[3] = { p->seen.lo.x, p->seen.lo.y, p->seen.lo.z },
                 hi[3] = { p->seen.hi.x, p->seen.hi.y, p->seen.hi.z };
    json_t *j =
        json_pack("{s:o, s:o, s:o, s:o, s:i}", "lo", json_numbers(lo, 3), "hi", json_numbers(hi, 3),
                  "speed", json_number(p->fastest), "spin", json_number(p->spin), "z", p->most);
    json_object_set_new(j, "radius", json_numbers(p->radius, 2));
    json_object_set_new(j, "force", json_number(p->force));
    json_object_set_new(j, "push", json_number(p->push));
    return j;
}

/* What a reader has to know of the numbers: they are rounded. */
static json_t *said(const struct page *p)
{
    double most = 0, speed = 0;
    for (int64_t k = 0; k < p->frames; k++) {
        for (int j = 0; j < 3; j++) most = fmax(most, p->moment[k].quantum[j]);
        speed = fmax(speed, p->moment[k].vmax / I16);
    }
    char text[300];
    snprintf(text, sizeof text,
             "Numbers here are rounded: positions to %.2g m, velocities to %.2g m/s, orientations "
             "to 1/127, forces to 1/65535 of a frame's largest. The document has them whole.",
             most / 2, speed / 2);
    return json_string(text);
}

json_t *page_meta(const struct page *p)
{
    json_t *j = json_pack("{s:i, s:b}", "dim", p->dim, "solved", p->solved), *list = json_array();
    if ((p->dim == 2 ? p->up.y : p->up.z) != 1) // else the page knows
        json_object_set_new(j, "up", json_pack("[f, f, f]", p->up.x, p->up.y, p->up.z));
    for (int32_t k = 0; k < p->kinds; k++) {
        json_t *name = json_string(p->kind_name[k]);
        json_array_append_new(list, name ? name : json_string("?"));
    }
    json_object_set_new(j, "kinds", list);
    json_object_set_new(j, "frames", list = json_array());
    for (int64_t k = 0; k < p->frames; k++) json_array_append_new(list, moment_json(&p->moment[k]));
    json_object_set_new(j, "range", range_json(p));
    json_object_set_new(j, "curves", list = json_object());
    for (int c = 0; c < p->curves; c++)
        json_object_set_new(list, p->curve[c].name,
                            json_pack("{s:s, s:o}", "unit", p->curve[c].unit, "value",
                                      json_numbers(p->curve[c].value, p->frames)));
    json_object_set_new(j, "said", said(p));
    return j;
}
