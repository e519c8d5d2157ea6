/* io/report_json.h: errors and reports as JSON, the same keys wherever they appear. */
#ifndef NSD_REPORT_JSON_H
#define NSD_REPORT_JSON_H

#include "base/vec.h"
#include "problem/report.h"

#include <jansson.h>

json_t *json_number(double); /* null where it is not finite */
json_t *json_vec(vec3);
json_t *json_numbers(const double *, int64_t n);

/* contacts, eps_glob, motion, proj, bipotential, penetration, scaled {...}, max_penetration,
   max_penetration_true, max_overlap, natural, natural_siconos, natural_q */
json_t *json_err(const struct err *);
/* step, time, method, the same, criterion, eps, sweeps, converged, newton, safeguarded, gave_up */
json_t *json_report(const struct report *);

/* One compact line on stdout; freed. */
void json_line(json_t *);

#endif
