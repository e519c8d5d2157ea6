/* measure/unit.h: the units of the numbers of measures by their names, for who shows them. */
#ifndef NSD_UNIT_H
#define NSD_UNIT_H

/* Of "measure.quantity", perhaps with ".more" behind it; in the plane, dim 2, per metre of depth. "": it has none, or there is
   no such number. */
const char *measure_unit(const char *name, int dim);

#endif
