/*
 * scene/mesh_file.h: triangles from files of other programs, STL, OBJ and PLY [scene/mesh_format.h]. What the
 * bytes are says which format it is, and the name only where they do not. Readers are nsd's own: they read one
 * file and no other, keep double precision, and refuse what is not as its format says.
 */
#ifndef NSD_MESH_FILE_H
#define NSD_MESH_FILE_H

#include "scene/scene.h"

enum {
    MESH_BYTES_MOST = 1 << 30, /* of all files of a scene */
    MESH_WORK_MOST = 1 << 30   /* for concave polygons [scene/ears.h]: some seconds */
};

/* Adds the triangles of a file, whose name is relative to files->dir and whose unit is `scale` m, and adds
   to its accounts; *left_out: triangles that are not there [scene/soup.h]. Returns 0, EX_NOINPUT,
   EX_DATAERR or EX_SOFTWARE. */
int mesh_file_read(struct mesh *to, struct scene_files *files, const char *name, double scale,
                   int32_t *left_out, struct failure *failure);
/* Reads the files of all meshes of the scene, and adds their triangles, as above. */
int mesh_files_read(struct scene *s, struct scene_files *files, struct failure *failure);
/* What a file has */
struct mesh_bytes {
    const char *name;
    const char *at; /* [n] bytes, and a 0 behind them */
    int64_t n;
    double scale; /* m: its unit */
};
/* The same of bytes */
int mesh_bytes_read(struct mesh *to, struct scene_files *files, const struct mesh_bytes *b,
                    int32_t *left_out, struct failure *failure);

#endif
