#include "file/report_json.h"

#include "state/fields.h"

#include <math.h>
#include <stdio.h>
#include <stdio_ext.h>
#include <stdlib.h>

enum { ERR_AT = offsetof(struct report, err) };

void json_terms(json_t *j, const struct terms *t)
{
    for (const struct field *f = terms_fields; f->name; f++)
        json_object_set_new(j, f->name, json_field(f, (const char *)t + f->offset));
}

/* The field of an error whose member comes next, from this offset in a report on */
static const struct field *next_of_err(size_t offset)
{
    static const struct field *const tables[] = { report_fields, velocity_fields };
    const struct field *next = NULL;
    for (int k = 0; k < 2; k++)
        for (const struct field *f = tables[k]; f->name; f++)
            if (f->offset >= offset && f->offset < ERR_AT + sizeof(struct err) &&
                (!next || f->offset < next->offset))
                next = f;
    return next;
}

/* In the order of the members of struct err */
static void set_err(json_t *j, const struct err *e)
{
    json_t *scaled = json_object();
    for (const struct field *f = next_of_err(ERR_AT); f; f = next_of_err(f->offset + 1)) {
        const void *x = (const char *)e + f->offset - ERR_AT;
        if (x == &e->paper)
            json_terms(j, x);
        else if (x == &e->scaled)
            json_terms(scaled, x), json_object_set(j, "scaled", scaled);
        else
            json_object_set_new(j, f->name, json_field(f, x));
    }
    json_decref(scaled);
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
    for (; f->name; f++)
        if (f->width >= least && f->width <= most)
            json_object_set_new(j, field_key(f), json_field(f, (const char *)r + f->offset));
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
    json_object_set_new(j, "tolerance", json_number(r->eps));
    for (const struct field *f = report_fields; f->name; f++)
        if (f->offset >= ERR_AT + sizeof r->err)
            json_object_set_new(j, f->name, json_field(f, (const char *)r + f->offset));
    if (r->watched) json_object_set_new(j, "fast", json_integer(r->fast));
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
    if (!ferror(stdout) && !json_write(stdout, j)) putchar('\n');
    if (ferror(stdout)) __fpurge(stdout); // nothing comes after a piece that is missing
    json_decref(j);
}
