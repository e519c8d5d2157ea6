/* scene/scene.c: the memory of a scene, and the cells of a lattice. */
#include "scene/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void scene_free(struct scene *s)
{
    for (int32_t k = 0; k < s->materials; k++) free(s->material[k].name);
    for (int64_t i = 0; i < s->groups; i++) {
        struct scene_bodies *b = &s->bodies[i];
        scene_size_free(&b->size);
        if (b->document) packing_free(b->document);
        for (int32_t k = 0; k < b->types; k++) free(b->type[k].name);
        free(b->document), free(b->file), free(b->type);
    }
    for (int32_t i = 0; i < s->pours; i++) scene_size_free(&s->pour[i].size);
    for (int32_t i = 0; i < s->removals; i++) free(s->removal[i].id);
    free(s->pour), free(s->removal);
    cell_free(&s->cell.cell);
    shapes_free(&s->shapes);
    free(s->solid);
    drives_free(&s->drives), drives_free(&s->pushes), drives_free(&s->pulls), mesh_free(&s->mesh);
    names_free(&s->names);
    for (int32_t k = 0; k < s->meshes; k++) free(s->mesh_file[k].file);
    for (int32_t k = 0; k < s->fits; k++) free(s->fit[k].shape);
    free(s->mesh_file), free(s->fit), free(s->part);
    free(s->material), free(s->law), free(s->bodies), free(s->wall), free(s->wall_item),
        free(s->text);
    *s = (struct scene){ 0 };
}

/* In x (and y) the cells fill the box; along the last axis they have the least edge, unless the box
   is the cell that repeats. */
struct scene_lattice scene_lattice(const struct scene_bodies *b, int dim)
{
    struct scene_lattice l = { .cells = { 1, 1, 1 } };
    double least = 2 * b->spacing * b->size.max;
    for (int i = 0; i < dim; i++) {
        double width = b->box.hi[i] - b->box.lo[i];
        l.cells[i] = floor(width / least * (1 + 1e-12)); // 6.3 mm holds six cells of 1.05 mm
        l.edge[i] = i < dim - 1 || b->in_cell ? width / l.cells[i] : least;
    }
    return l;
}

char *scene_path(const char *dir, const char *name)
{
    bool whole = *name == '/' || !dir;
    size_t room = strlen(name) + (whole ? 0 : strlen(dir)) + 2;
    char *path = malloc(room);
    if (path) snprintf(path, room, "%s%s%s", whole ? "" : dir, whole ? "" : "/", name);
    return path;
}
