#include "state/wall_faces.h"

#include <stdlib.h>

void wall_faces_free(struct wall_faces *f)
{
    for (int32_t w = 0; f->surface && w < f->walls; w++) surface_free(&f->surface[w]);
    free(f->first), free(f->surface);
    *f = (struct wall_faces){ 0 };
}

static bool is_mesh(const struct wall *w)
{
    return w->shape == WALL_MESH;
}

int wall_faces_init(struct wall_faces *f, int32_t walls, const struct wall *wall,
                    const struct mesh *mesh, struct failure *failure)
{
    *f = (struct wall_faces){ .walls = walls };
    f->first = calloc((size_t)walls + 2, sizeof *f->first);
    bool finds = mesh && mesh->elements;
    if (finds) f->surface = calloc((size_t)walls + 1, sizeof *f->surface);
    if (!f->first || (finds && !f->surface))
        failure_set(failure, EX_SOFTWARE, "no memory for the faces of walls");
    for (int32_t w = 0; !failure->status && w < walls; w++) {
        int32_t faces = is_mesh(&wall[w]) ? wall[w].elements : 1;
        if (faces < 0 || faces > INT32_MAX - f->n) {
            failure_set(failure, EX_DATAERR, "wall %d: %d faces", w, faces);
            break;
        }
        f->first[w] = f->n, f->n += faces;
        if (f->surface && is_mesh(&wall[w]))
            surface_init(&f->surface[w], mesh, wall[w].first_element, wall[w].elements,
                         wall[w].weld, failure);
    }
    if (failure->status) return wall_faces_free(f), failure->status;
    f->first[walls] = f->n;
    return 0;
}
