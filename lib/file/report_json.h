/*
 * file/report_json.h: errors and reports as JSON, under the same keys wherever they appear.
 */
#pragma once

#include "base/json.h"
#include "state/account.h"

/* Adds the terms of an error under their names. */
void json_terms(json_t *object, const struct terms *terms);
/* The numbers of an error in the order of its members, those of `scaled` in an object of this name */
json_t *json_err(const struct err *err);
/* step, time, method, the keys of json_err, criterion, eps, the other fields of a report; and where it is known the
   balance in an object of this name [step/balance.h] */
json_t *json_report(const struct report *report);
/* steps, and for each row { value, step, bodies: [...], fails }: bodies by their ids, walls by their names, or as "wall 3" */
json_t *json_account(const struct account *account, const struct names *names);

/* Prints one compact line on stdout and frees the value. */
void json_line(json_t *value);
