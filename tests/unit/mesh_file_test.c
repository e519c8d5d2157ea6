/* What all files of a scene draw on: bytes, and triangles of one mesh. */
#include "scene/mesh_file.h"
#include "scene/soup.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

int main(void)
{
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    struct scene_files files = { 0 };
    struct mesh mesh = { 0 };
    struct failure failure = { 0 }, bytes = { 0 }, triangles = { 0 };
    int32_t left_out;
    char name[] = "/tmp/nsd-mesh-XXXXXX";
    FILE *f = fdopen(mkstemp(name), "w");
    fputs(text, f), fclose(f);
    mesh_file_read(&mesh, &files, name, 2, &left_out, &failure);
    ok(!failure.status && files.mesh_bytes == (int64_t)strlen(text),
       "bytes that are read are counted");
    ok(mesh.elements == 1 && mesh.vertex[1].x == 2,
       "a unit of the file is as long as it is said to be");
    files.mesh_bytes = MESH_BYTES_MOST - (int64_t)strlen(text) + 1;
    mesh_file_read(&mesh, &files, name, 1, &left_out, &bytes);
    ok(bytes.status == EX_DATAERR && strstr(bytes.text, "bytes in all"),
       "there are only so many: %s", bytes.text);
    mesh.elements = SOUP_TRIANGLES_MOST;
    const struct mesh_bytes all = { name, text, (int64_t)strlen(text), 1 };
    mesh_bytes_read(&mesh, &files, &all, &left_out, &triangles);
    ok(triangles.status == EX_DATAERR, "and so many triangles: %s", triangles.text);
    mesh_free(&mesh);
    remove(name);
    return tap_done();
}
