#include "file/report_json.h"

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

static json_t *balance(const struct report *r)
{
    const struct balance *b = &r->balance;
    json_t *j = json_object();
    json_object_set_new(j, "kinetic", json_number(b->kinetic));
    json_object_set_new(j, "change", json_number(b->change));
    json_object_set_new(j, "potential", json_number(b->potential));
    json_object_set_new(j, "gravity", json_number(b->gravity));
    json_object_set_new(j, "drives", json_number(b->drives));
    json_object_set_new(j, "loads", json_number(b->loads));
    json_object_set_new(j, "dissipation", json_number(b->dissipation));
    if (r->tied) {
        json_object_set_new(j, "bond_change", json_number(b->bond_change));
        json_object_set_new(j, "bond_energy", json_number(b->bond_energy));
        json_object_set_new(j, "broken", json_number(b->broken));
    }
    if (r->soft) json_object_set_new(j, "implicit", json_number(b->implicit));
    if (r->may_gain) json_object_set_new(j, "gained", json_number(b->gained));
    if (r->projected) {
        json_object_set_new(j, "projection", json_number(b->projection));
        json_object_set_new(j, "projection_angular_momentum", json_numbers(b->spun, 3));
    }
    if (r->sheared) {
        json_object_set_new(j, "peculiar", json_number(b->peculiar));
        json_object_set_new(j, "peculiar_change", json_number(b->peculiar_change));
    }
    json_object_set_new(j, "momentum", json_numbers(b->momentum, 3));
    json_object_set_new(j, "impulse", json_numbers(b->impulse, 3));
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
