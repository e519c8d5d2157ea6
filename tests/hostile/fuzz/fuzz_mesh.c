/*
 * Files of surfaces: bytes as a reader of STL, OBJ or PLY gets them; the first byte of the input says which
 * name the file has. What is read is made a grain, too, if it has few corners.
 */
#include "fuzz.h"
#include "scene/mesh_file.h"
#include "scene/surface_parts.h"
#include "shape/solid.h"

#include <stdlib.h>
#include <string.h>

/* What a scene does with the shape of a grain */
static void make_grain(const struct mesh *m, bool hull)
{
    struct shape s = { .form = SHAPE_HULL };
    struct failure failure = { 0 };
    struct solid_frame was;
    bool by_hull = false;
    if (!mesh_shape(&s, m, hull, &by_hull, &failure) && !solid_settle(&s, 3, &was, &failure))
        shape_finish(&s, 3, &failure);
    if (failure.status && (!failure.text[0] || strchr(failure.text, '\n'))) abort();
    shape_free(&s);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const name[] = { "m.stl", "m.obj", "m.ply", "m" };
    struct mesh m = { 0 };
    struct scene_files files = { 0 };
    struct failure failure = { 0 };
    int32_t left_out = 0;
    if (size < 1) return -1;
    char *text = malloc(size); // one byte less, and a zero: none is behind it
    if (!text) abort();
    memcpy(text, data + 1, size - 1), text[size - 1] = 0;
    const struct mesh_bytes all = { name[data[0] % 4], text, (int64_t)size - 1, 1 };
    int e = mesh_bytes_read(&m, &files, &all, &left_out, &failure);
    free(text);
    if (e && (!failure.status || !failure.text[0] || strchr(failure.text, '\n'))) abort();
    if (!e && (left_out < 0 || m.elements < 1 || mesh_check(&m, 3, &failure))) abort();
    if (!e && m.vertices < 200) make_grain(&m, false), make_grain(&m, true);
    mesh_free(&m);
    return 0;
}
