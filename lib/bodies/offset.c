/* bodies/offset.c: gaps as velocities [bodies/offset.h]. */
#include "bodies/offset.h"

bool offset_in(const struct packing *pack, const struct contact *c)
{
    return overlap_sees_gaps(pack->overlap) && (c->gap > 0 || overlap_pushes(pack->overlap));
}

/*
 * Signorini's condition on the gap at the next predicted position, g + dt u_n. Not of an impact
 * that rebounds: its velocities are Newton's, wherever in the step it falls.
 */
double offset_of(const struct packing *pack, const struct contact *c, double un)
{
    bool impact = c->en > 0 && -un > packing_calm(pack);
    return impact || !offset_in(pack, c) ? 0 : c->gap / pack->dt;
}
