/*
 * draw/page.h: a trajectory as one HTML file that plays it in a browser, without a network.
 *
 * The file holds the page's program (draw/page/, with three.js) and the frames: numbers of 8 and 16
 * bits relative to each frame's extent, packed by zlib, in base64. page_begin(), page_frame() for
 * each frame, page_end(). What is written is said in draw/page.c, with its packing.
 */
#pragma once

#include "draw/page_data.h"
#include "state/contact.h"

/* Each returns 0, EX_SOFTWARE, EX_IOERR or EX_DATAERR (more than INT32_MAX grains or contacts). */
int page_begin(struct page *p, FILE *out, const char *name, const char *title,
               struct failure *failure);
/* contacts: NULL, or those of this moment; only solved ones are kept. */
int page_frame(struct page *p, const struct packing *k, const struct contacts *contacts,
               struct failure *failure);
/* Adds the number of the last frame written to the curve of that name. */
int page_value(struct page *p, const char *name, const char *unit, double value,
               struct failure *failure);
int page_end(struct page *p, struct failure *failure);
void page_free(struct page *p);
