#include "file/report_json.h"

#include "state/fields.h"

#include <math.h>
#include <stdio.h>
#include <stdio_ext.h>
#include <stdlib.h>

static void set_terms(json_t *j, const struct terms *t)
{
    json_object_set_new(j, "eps_glob", json_number(t->eps_glob));
    json_object_set_new(j, "motion", json_number(t->motion));
    json_object_set_new(j, "proj", json_number(t->proj));
    json_object_set_new(j, "bipotential", json_number(t->bipotential));
    json_object_set_new(j, "penetration", json_number(t->penetration));
}

static void set_err(json_t *j, const struct err *e)
{
    json_t *scaled = json_object();
    json_object_set_new(j, "contacts", json_integer(e->contacts));
    set_terms(j, &e->paper);
    set_terms(scaled, &e->scaled);
    json_object_set_new(j, "scaled", scaled);
    json_object_set_new(j, "max_penetration", json_number(e->max_penetration));
    json_object_set_new(j, "max_penetration_true", json_number(e->max_penetration_true));
    json_object_set_new(j, "max_overlap", json_number(e->max_overlap));
    json_object_set_new(j, "natural", json_number(e->natural));
    json_object_set_new(j, "natural_siconos", json_number(e->natural_siconos));
    json_object_set_new(j, "natural_q", json_number(e->natural_q));
    json_object_set_new(j, "velocity", json_number(e->velocity));
    json_object_set_new(j, "velocity_error", json_number(e->velocity_error));
    json_object_set_new(j, "jammed", json_integer(e->jammed));
}

json_t *json_err(const struct err *e)
{
    json_t *j = json_object();
    set_err(j, e);
    return j;
}

/* The numbers of a report in these fields, of which a row has least .. most */
static void set_fields(json_t *j, const struct field *f, const struct report *r, int least,
                       int most)
{
    for (; f->name; f++) {
        const double *x = (const double *)(const void *)((const char *)r + f->offset);
        if (f->width < least || f->width > most) continue;
        json_object_set_new(j, f->key ? f->key : f->name,
                            f->width > 1 ? json_numbers(x, f->width) : json_number(*x));
    }
}

/* Vectors come last. */
static json_t *balance(const struct report *r)
{
    json_t *j = json_object();
    set_fields(j, balance_fields, r, 1, 1);
    for (const struct balance_part *part = balance_parts; part->fields; part++)
        if (balance_part_has(part, r)) set_fields(j, part->fields, r, 1, 3);
    set_fields(j, balance_fields, r, 2, 3);
    return j;
}

json_t *json_report(const struct report *r)
{
    json_t *j = json_object();
    json_object_set_new(j, "step", json_integer(r->step));
    json_object_set_new(j, "time", json_number(r->t));
    json_object_set_new(j, "method", json_string(r->method));
    set_err(j, &r->err);
    json_object_set_new(j, "criterion", json_string(criterion_name[r->criterion]));
    json_object_set_new(j, "eps", json_number(r->eps));
    json_object_set_new(j, "sweeps", json_integer(r->sweeps));
    json_object_set_new(j, "converged", json_boolean(r->converged));
    json_object_set_new(j, "newton", json_integer(r->newton));
    json_object_set_new(j, "safeguarded", json_integer(r->safeguarded));
    json_object_set_new(j, "gave_up", json_integer(r->gave_up));
    if (r->watched) json_object_set_new(j, "passed", json_integer(r->passed));
    if (r->substeps > 1) json_object_set_new(j, "substeps", json_integer(r->substeps));
    if (r->balanced) json_object_set_new(j, "balance", balance(r));
    return j;
}

/* 3, "lid", "wall 4" */
static json_t *body(double id, const struct names *names)
{
    const char *name = id < 0 ? names_of_wall(names, (int32_t)(-1 - id)) : NULL;
    if (id >= 0) return json_integer((json_int_t)id);
    return name ? json_string(name) : json_sprintf("wall %.0f", -1 - id);
}

json_t *json_account(const struct account *a, const struct names *names)
{
    json_t *j = json_pack("{s:I}", "steps", (json_int_t)a->steps);
    for (int k = 0; k < ACCOUNT_ROWS; k++) {
        const struct watched *w = &account_watched[k];
        const struct account_entry *e = &a->worst[k];
        json_t *row = json_object();
        json_object_set_new(row, "value", json_number(e->value));
        json_object_set_new(row, "step", json_integer((json_int_t)e->step));
        if (w->bodies) json_object_set_new(row, "bodies", json_array());
        for (int i = 0; i < w->bodies && e->value != 0; i++)
            json_array_append_new(json_object_get(row, "bodies"), body(e->bodies[i], names));
        json_object_set_new(row, "fails", json_boolean(account_row_fails(a, (enum account_row)k)));
        json_object_set_new(j, w->name, row);
    }
    return j;
}

void json_line(json_t *j)
{
    char *text = ferror(stdout) ? NULL : json_dumps(j, JSON_COMPACT);
    if (text && fputs(text, stdout) != EOF) putchar('\n');
    if (ferror(stdout)) __fpurge(stdout); // nothing comes after a piece that is missing
    free(text);
    json_decref(j);
}
