/* measure/measured.h: measures of a snapshot, by their names, as JSON. */
#ifndef NSD_MEASURED_H
#define NSD_MEASURED_H

#include "measure/measures.h"

enum { MOST_MEASURES = 32 }; /* at once */

/* chosen[MOST_MEASURES + 1] = those of the names "A,B,..." or "all", each once, ended by NULL. Returns 0, or EX_USAGE with
   "--measures: ...". */
int measured_choose(const struct measure **chosen, const char *names, struct failure *failure);
/* Does any of them look at earlier frames? */
bool measured_remember(const struct measure *const *chosen);
/* first, before = what they look back to from the next frame on; first only where the snapshot has none. Returns 0 or
   EX_SOFTWARE. */
int measured_keep(const struct measure *const *chosen, const struct snapshot *s, struct frame_memory *first,
                  struct frame_memory *before, struct failure *failure);
/* t[MOST_MEASURES] = the chosen ones, none where snapshot_init() has failed with this `why`; to be freed by measured_free in any case. Returns 0, EX_SOFTWARE, or EX_DATAERR where
   one of them cannot keep to what --only names. */
int measured_run(struct table *t, const struct measure *const *chosen, const struct snapshot *s,
                 struct failure *failure);
void measured_free(struct table *t);
/* {"step":...,"time":...,"bodies":...,"contacts":...,"unconverged":...,"NAME":{...},...,"why":{...}}, without an end of line */
void measured_json(FILE *out, const struct snapshot *s, const struct measure *const *chosen,
                   const struct table *t);

#endif
