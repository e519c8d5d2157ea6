/* draw/film.h: pictures joined to a film by ffmpeg, where that is installed. */
#pragma once

#include "draw/picture.h"

#include <stdbool.h>

struct film;

/* Is this a name that a film has, .mp4 or .webm? */
bool film_name(const char *path);
/* Can ffmpeg be run? */
bool film_possible(void);

/*
 * A film of so many pictures a second, all of the first one's size. It takes its place in
 * film_close() [base/output.h]. EX_IOERR where ffmpeg cannot be started or fails, EX_SOFTWARE.
 */
int film_open(struct film **film, const char *path, int rate, struct failure *failure);
int film_add(struct film *film, const struct picture *p, struct failure *failure);
int film_close(struct film *film, struct failure *failure);
