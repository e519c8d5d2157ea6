/* convert/vti.h: fields on a grid as VTK's image data (.vti), for ParaView. */
#ifndef NSD_VTI_H
#define NSD_VTI_H

#include "base/failure.h"
#include "measure/fields.h"

#include <stdio.h>

/* XML with the numbers of the points appended as they are in memory. 0 also where the disk is full:
   ferror(out) tells. Symmetric or not, tensors have nine numbers, by rows. */
void vti_write(FILE *out, const struct fields *fields, int64_t step, double t);

#endif
