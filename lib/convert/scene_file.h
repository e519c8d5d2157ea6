/*
 * convert/scene_file.h: a scene with all that it names: tables, meshes, and the documents that it takes bodies from.
 */
#pragma once

#include "file/frame.h"
#include "scene/scene.h"

#include <stdio.h>

/* All of an open file, *n bytes, to be freed; NULL where memory is short (EX_SOFTWARE), it cannot be read (EX_NOINPUT), or
   where it is a pipe, it has more than 64 MiB (EX_DATAERR). `name` is for messages. */
char *scene_file_slurp(FILE *file, const char *name, size_t *n, struct failure *failure);
/*
 * The scene of a text; names in it are relative to dir (NULL: to the current folder). What it takes from documents and
 * meshes is read. Returns 0, EX_DATAERR, EX_NOINPUT or EX_SOFTWARE, "name: ..." before the trouble where name is given;
 * *s needs to be freed only after 0.
 */
int scene_file_parse(struct scene *s, const char *text, size_t n, const char *name, const char *dir,
                     struct failure *failure);
