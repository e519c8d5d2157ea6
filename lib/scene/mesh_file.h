/*
 * scene/mesh_file.h: triangles from files of other programs, STL, OBJ, PLY and what else libassimp
 * reads. That is loaded with the first file: it takes longer than nsd-gen needs for a scene without one.
 */
#ifndef NSD_MESH_FILE_H
#define NSD_MESH_FILE_H

#include "scene/scene.h"

/* Adds the triangles of a file, whose name is relative to dir (NULL: the current folder) and whose unit is
   `scale` m; those without an area are left out. Returns 0, EX_NOINPUT, EX_DATAERR or EX_SOFTWARE. */
int mesh_file_read(struct mesh *to, const char *dir, const char *name, double scale,
                   struct why *why);
/* Reads the files of all meshes of the scene, whose names are relative to dir (NULL: the current
   folder), and adds their triangles, as above. */
int mesh_files_read(struct scene *s, const char *dir, struct why *why);

#endif
