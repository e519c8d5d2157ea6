/* scene/scene_names.c: names of walls, of parts of their surfaces and of groups of bodies, from their JSON. */
#include "scene/scene_read.h"

#include <string.h>

int scene_read_name(jnode n, const struct scene *s, const char **out)
{
    *out = NULL;
    if (!n.json) return 0;
    if (json_node_text(n, out)) return 1;
    const char *trouble = name_trouble(*out, strlen(*out));
    if (trouble) return json_node_fault(n, "a name %s", trouble);
    for (int32_t k = 0; k < s->kinds; k++)
        if (!strcmp(s->kind[k].name, *out))
            return json_node_fault(n, "\"%s\" is a kind: walls and groups have other names", *out);
    return 0;
}

int scene_read_group(jnode n, struct scene *s, int32_t *group)
{
    const char *name;
    int32_t which = -1;
    if (scene_read_name(n, s, &name)) return 1;
    if (name && names_add(&s->names, name, &which, n.in->failure)) return 1;
    *group = which + 1;
    return 0;
}

static int scene_material_read_part(jnode o, struct scene *s)
{
    const char *name;
    int64_t first = 0, last = 0;
    size_t n;
    jnode faces = json_node_key(&o, "faces"), text = json_node_key(&o, "name");
    if (json_node_only(o, "name faces") || json_node_need(&o, "name faces") ||
        scene_read_name(text, s, &name) || json_node_array(faces, &n))
        return 1;
    if (n != 2) return json_node_fault(faces, "needs [first, last]");
    if (json_node_integer(json_node_item(&faces, 0), 0, INT32_MAX - 1, &first) ||
        json_node_integer(json_node_item(&faces, 1), 0, INT32_MAX - 1, &last))
        return 1;
    if (first > last) return json_node_fault(faces, "its first face is behind its last");
    struct failure *failure = o.in->failure;
    return names_give(&s->names, name, s->walls, (int32_t)first, (int32_t)(last - first + 1), failure);
}

int scene_read_parts(jnode a, struct scene *s, bool *groups)
{
    size_t n;
    if (groups && json_is_string(a.json) && !strcmp(json_string_value(a.json), "groups")) {
        *groups = true;
        return 0;
    }
    if (groups && a.json && !json_is_array(a.json))
        return json_node_fault(a, "needs \"groups\" or a list [{name, faces}, ...]");
    if (json_node_array(a, &n)) return 1;
    for (size_t i = 0; i < n; i++)
        if (scene_material_read_part(json_node_item(&a, i), s)) return 1;
    return 0;
}
