/*
 * file/report_json.h: errors and reports as JSON, under the same keys wherever they appear.
 */
#ifndef NSD_REPORT_JSON_H
#define NSD_REPORT_JSON_H

#include "base/json.h"
#include "state/account.h"

/*
 * contacts, eps_glob, motion, proj, bipotential, penetration, scaled {...}, max_penetration,
 * max_penetration_true, max_overlap, natural, natural_siconos, natural_q, velocity, velocity_error, jammed
 */
json_t *json_err(const struct err *err);
/*
 * step, time, method, the keys of json_err, criterion, eps, sweeps, converged, newton, safeguarded,
 * gave_up; and where it is known balance { kinetic, change, potential, gravity, drives, loads, dissipation,
 * and where they are known the terms of bonds, gained, projection, projection_angular_momentum, peculiar, peculiar_change; momentum, impulse } [step/balance.h]
 */
json_t *json_report(const struct report *report);
/* steps, and for each row { value, step, bodies: [...], fails }: bodies by their ids, walls by their names, or as "wall 3" */
json_t *json_account(const struct account *account, const struct names *names);

/* Prints one compact line on stdout and frees the value. */
void json_line(json_t *value);

#endif
