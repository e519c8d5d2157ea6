/* scene/scene_build.h: builds a packing from a scene. The same scene gives the same bytes. */
#pragma once

#include "scene/scene.h"
#include "state/packing.h"

/*
 * Bodies in the order of the scene's groups; p->scene is the scene's text. Tables with a relative
 * name are looked for in dir (NULL: the working directory). Returns 0, EX_DATAERR (also for bodies
 * that overlap), EX_NOINPUT (a table cannot be read) or EX_SOFTWARE; p needs freeing only after 0.
 */
int scene_build(struct packing *p, const struct scene *s, const char *dir, struct failure *failure);
