/*
 * file/layout.h: paths of datasets that several files of this folder need. Which dataset holds which member of which struct
 * is in state/fields.h, and in words in nsd-format(5).
 */
#pragma once

#include "file/frame.h"
#include "file/h5.h"
#include "state/fields.h"

#include <stddef.h>
#include <stdio.h>

/* The dataset of a column of bodies, /particles/all/NAME [N][width], or where the bodies move NAME/value
   [F][N][width]; a row of width 1 has no dimension of its own, but in NAME/value [state/body_columns.h]. */
static inline void layout_body_path(const struct field *b, char path[80])
{
    snprintf(path, 80, "/particles/all/%s%s", b->name, b->traits & FIELD_MOVES ? "/value" : "");
}

/* [S][3] N m s: the moments of solved contacts on b, in the frame, where there is rolling friction */
#define LAYOUT_MOMENT "/contacts/moment"

/* [S][3] N: the reactions of solved contacts as forces on b, in space; written where asked, not read */
#define LAYOUT_FORCE "/contacts/force"

/*
 * The group of the solver's reports. Not among H5MD's /observables: readers take each member of that
 * for an element with a value in every frame. LAYOUT_REPORT_0_1: where it was until nsd 0.1.
 */
/* Each frame's, in documents of versions whose time step adapted: [F], s */
#define LAYOUT_TIME_STEP "/nsd/time_step/value"

#define LAYOUT_REPORT     "/nsd/solver"
#define LAYOUT_REPORT_0_1 "/observables/solver"
