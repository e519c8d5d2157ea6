/* convert/fields_file.h: fields of coarse graining as an HDF5 file [nsd-format(5), "Fields"]. */
#pragma once

#include "base/failure.h"
#include "measure/fields.h"

#include <stdio.h>

struct fields_file;

/* A new file at `path`, for frames of fields on one grid. history: the command's JSON line. EX_IOERR:
   it cannot be written. Removed should the tool end before fields_file_close. */
int fields_file_open(struct fields_file **file, const char *path, const struct fields *fields,
                     const char *history, struct failure *failure);
int fields_file_add(struct fields_file *file, const struct fields *fields, int64_t step, double t,
                    struct failure *failure);
int fields_file_close(struct fields_file *file, struct failure *failure);

/* Fields on a grid as VTK's image data (.vti), for ParaView. */

/* XML with the numbers of the points appended as they are in memory. 0 also where the disk is full:
   ferror(out) tells. Symmetric or not, tensors have nine numbers, by rows. */
void vti_write(FILE *out, const struct fields *fields, int64_t step, double t);
