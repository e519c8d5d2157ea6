/*
 * draw/images.h: where the cell repeats, what a picture shows of that: bodies are in the cell, those
 * that its border cuts on either side of it, and the cell's outline.
 */
#pragma once

#include "draw/walls.h"

/*
 * Brings the bodies of p back into its cell and appends images of those that reach across the border,
 * as bodies; *of, to be freed, is whose they are [p->n], as many as p->n then. Does nothing where
 * nothing repeats. Returns 0 or EX_SOFTWARE.
 */
int images_append(struct packing *p, int64_t **of, struct failure *failure);

/* Adds the cell's outline to the edges; along what does not repeat it is as long as the bodies reach. */
void images_outline(struct walls *b, const struct packing *p);
