#include "file/contact_rows.h"

#include "file/distributed.h"
#include "file/h5.h"
#include "solve/local.h"

#include <stdlib.h>

int contact_rows_open(struct contact_rows *r, struct source *source, struct failure *failure)
{
    int64_t n, m, l;
    *r = (struct contact_rows){ .source = source };
    r->step = table_read_steps(source, "/contacts/step", &n, failure);
    r->start = table_read_steps(source, "/contacts/start", &m, failure);
    r->count = table_read_steps(source, "/contacts/count", &l, failure);
    n = n < m ? n : m; // a killed writer may have extended only some columns
    r->blocks = failure->status ? 0 : table_read_rising(r->step, n < l ? n : l);
    return failure->status;
}

static int check_shifts(const struct contacts *s, const struct cell *cell, struct failure *failure)
{
    for (int64_t i = 0; i < s->n; i++)
        for (int k = 0; k < 3; k++)
            if (s->c[i].shift[k] && !cell->repeats[k])
                return failure_set(failure, EX_DATAERR,
                                   "contact %lld: shift along edge %d, which is not periodic",
                                   (long long)i, k);
    return 0;
}

/* What contacts_check leaves: they are sorted, each pair once, and their states are states. */
static int check_order(const struct contacts *s, struct failure *failure)
{
    for (int64_t i = 1; i < s->n; i++) {
        const struct contact *c = &s->c[i - 1], *next = &s->c[i];
        int order = contact_key_order(contact_key(c), contact_key(next));
        if (order < 0) continue;
        if (order == 0)
            return failure_set(failure, EX_DATAERR,
                               "contact %lld: of bodies %d and %d, as the one before", (long long)i,
                               next->a, next->b);
        bool same_pair = c->a == next->a && c->b == next->b;
        return failure_set(failure, EX_DATAERR, "contact %lld: not sorted by its %s", (long long)i,
                           same_pair ? "feature and shift" : "bodies");
    }
    for (int64_t i = 0; s->found && i < s->n; i++)
        if (s->found[i].status < LOCAL_FREE || s->found[i].status > STATUS_SUMMED)
            return failure_set(failure, EX_DATAERR, "contact %lld: status is %d", (long long)i,
                               s->found[i].status);
    return 0;
}

/* The bases of the contacts from row `first` on; t2 has to be n x t1. */
static int read_bases(struct source *r, int64_t first, struct contacts *s, struct failure *failure)
{
    vec3(*basis)[3] = malloc((size_t)(s->n + 1) * sizeof *basis);
    if (!basis) return failure_set(failure, EX_SOFTWARE, "no memory for /contacts/frame");
    int e = source_rows(r, "/contacts/frame", (struct slab){ COLUMN_F64, first, s->n, 9 }, basis,
                        failure);
    for (int64_t i = 0; !e && i < s->n; i++) {
        struct contact *c = &s->c[i];
        c->n = basis[i][0], c->t1 = basis[i][1];
        if (!(v3_norm(v3_sub(contact_t2(c), basis[i][2])) < 1e-6))
            e = failure_set(failure, EX_DATAERR,
                            "contact %lld: frame is not right-handed and orthonormal",
                            (long long)i);
    }
    free(basis);
    return e;
}

static int read_moments(struct source *r, int64_t first, struct contacts *s,
                        struct failure *failure)
{
    if (contacts_alloc_moment(s)) return failure_set(failure, EX_SOFTWARE, "no memory for moments");
    return source_rows(r, LAYOUT_MOMENT, (struct slab){ COLUMN_F64, first, s->n, 3 }, s->moment,
                       failure);
}

int contact_rows_read(struct contact_rows *r, struct frame *f, struct failure *failure)
{
    int64_t at = table_read_row(r->step, r->blocks, f->packing.step), first;
    struct contacts *s = &f->contacts;
    if (at < 0) return 0;
    first = r->start[at], s->n = r->count[at];
    if (first < 0 || s->n < 0 || first > INT32_MAX || s->n > INT32_MAX)
        return failure_set(failure, EX_DATAERR, "/contacts: start or count is out of range");
    uint64_t shape[4];
    if (source_shape(r->source, "/contacts/body", shape) != 2 ||
        (uint64_t)(first + s->n) > shape[0])
        return failure_set(failure, EX_DATAERR,
                           "/contacts/body: fewer than the %lld contacts of its frames",
                           (long long)(first + s->n));
    s->room = s->n ? s->n : 1;
    s->c = calloc((size_t)s->room, sizeof *s->c);
    if (!s->c) return failure_set(failure, EX_SOFTWARE, "no memory for the contacts");
    bool solved = source_has(r->source, "/contacts/reaction");
    if (solved && contacts_alloc_found(s))
        return failure_set(failure, EX_SOFTWARE, "no memory for reactions");
    if (f->packing.law && contacts_alloc_laws(s))
        return failure_set(failure, EX_SOFTWARE, "no memory for the ties");
    const struct packing *p = &f->packing;
    if (table_read_columns(r->source, "/contacts", "", first, RECORDS(contact_fields, s->n, s->c),
                           failure) ||
        read_bases(r->source, first, s, failure) ||
        table_read_columns(r->source, "/contacts", "", first,
                           RECORDS_OF(p, contact_key_fields, s->n, s->c), failure) ||
        (s->law && table_read_columns(r->source, "/contacts", "", first,
                                      RECORDS_OF(p, contact_law_fields, s->n, s->law), failure)) ||
        (solved && table_read_columns(r->source, "/contacts", "", first,
                                      RECORDS(found_fields, s->n, s->found), failure)) ||
        (solved && packing_rolls(&f->packing) && read_moments(r->source, first, s, failure)))
        return failure->status;
    int64_t n = f->distributed ? f->distributed->n : f->packing.n;
    if (contacts_check(s, n, f->packing.walls, failure) || check_order(s, failure) ||
        check_shifts(s, &f->packing.cell, failure))
        return failure->status;
    int moved;
    if (source_attribute(r->source, "/contacts", "moved",
                         (struct numbers){ COLUMN_I32, -1, &moved }, failure))
        return failure->status;
    f->moved = moved;
    f->forces = source_has(r->source, LAYOUT_FORCE);
    f->detected = true;
    return 0;
}

void contact_rows_close(struct contact_rows *r)
{
    free(r->step), free(r->start), free(r->count);
    *r = (struct contact_rows){ 0 };
}

/* ---- to a document ---- */

static int write_bases(struct table_write *s, const struct contacts *t, struct failure *failure)
{
    const hsize_t shape[3] = { (hsize_t)t->n, 3, 3 };
    vec3(*basis)[3] = malloc((size_t)(t->n + 1) * sizeof *basis);
    if (!basis) return failure_set(failure, EX_SOFTWARE, "no memory for /contacts/frame");
    for (int64_t i = 0; i < t->n; i++) {
        const struct contact *c = &t->c[i];
        basis[i][0] = c->n, basis[i][1] = c->t1, basis[i][2] = contact_t2(c);
    }
    int e = table_write_rows(
        s, (struct dataset){ "/contacts/frame", COLUMN_F64, 3, shape, CHUNK_CONTACTS, basis, "1" },
        failure);
    free(basis);
    return e;
}

/* All of them 0 where no contact of the frame rolls */
static int write_moments(struct table_write *s, const struct contacts *t, struct failure *failure)
{
    const hsize_t shape[2] = { (hsize_t)t->n, 3 };
    double(*none)[3] = t->moment ? NULL : calloc((size_t)t->n + 1, sizeof *none);
    if (!t->moment && !none) return failure_set(failure, EX_SOFTWARE, "no memory for moments");
    int e = table_write_rows(s,
                             (struct dataset){ LAYOUT_MOMENT, COLUMN_F64, 2, shape, CHUNK_CONTACTS,
                                               none ? none : t->moment, "N m s" },
                             failure);
    free(none);
    return e;
}

static int contact_rows_write_forces(struct table_write *s, const struct contacts *t, double dt,
                                     struct failure *failure)
{
    const hsize_t shape[2] = { (hsize_t)t->n, 3 };
    vec3 *force = malloc((size_t)(t->n + 1) * sizeof *force);
    if (!force) return failure_set(failure, EX_SOFTWARE, "no memory for %s", LAYOUT_FORCE);
    for (int64_t i = 0; i < t->n; i++)
        force[i] = v3_scale(1 / dt, contact_in_space(&t->c[i], t->found[i].r));
    int e = table_write_rows(
        s, (struct dataset){ LAYOUT_FORCE, COLUMN_F64, 2, shape, CHUNK_CONTACTS, force, "N" },
        failure);
    free(force);
    return e;
}

int contact_rows_write(struct table_write *s, const struct frame *f, struct failure *failure)
{
    bool first = !table_write_grows(s, "/contacts/start");
    const struct contacts *t = &f->contacts;
    // a column of a trajectory is one of all its contacts, or of none
    bool forces = t->found && (first ? f->forces : table_write_grows(s, LAYOUT_FORCE));
    if (table_write_span(s, "/contacts", s->contacts, t->n, failure) ||
        table_write_columns(s, "/contacts", "", RECORDS(contact_fields, t->n, t->c), CHUNK_CONTACTS,
                            failure) ||
        write_bases(s, t, failure) ||
        table_write_columns(s, "/contacts", "",
                            RECORDS_OF(&f->packing, contact_key_fields, t->n, t->c), CHUNK_CONTACTS,
                            failure) ||
        (f->packing.law &&
         table_write_columns(s, "/contacts", "",
                             RECORDS_OF(&f->packing, contact_law_fields, t->n, t->law),
                             CHUNK_CONTACTS, failure)) ||
        (t->found && table_write_columns(s, "/contacts", "", RECORDS(found_fields, t->n, t->found),
                                         CHUNK_CONTACTS, failure)) ||
        (t->found && packing_rolls(&f->packing) && write_moments(s, t, failure)) ||
        (t->found && forces && contact_rows_write_forces(s, t, f->packing.dt, failure)) ||
        table_write_number(s, "/contacts/step", COLUMN_I64, &f->packing.step, NULL, failure))
        return failure->status;
    if (s->growing) s->contacts += t->n;
    int moved = f->moved;
    return !first
               ? 0
               : h5_attr(s->file, "/contacts", "moved", h5_scalar(H5T_NATIVE_INT, &moved), failure);
}

static const char group[] = "/nsd/memory";

int memory_rows_open(struct memory_rows *r, struct source *source, struct failure *failure)
{
    int64_t n, m;
    uint64_t shape[4];
    *r = (struct memory_rows){ .source = source };
    if (!source_has(source, group)) return 0;
    r->step = table_read_steps(source, "/nsd/memory/step", &r->blocks, failure);
    if (failure->status) return failure->status;
    n = source_shape(source, "/nsd/memory/start", shape) == 1 ? (int64_t)shape[0] : 0;
    m = source_shape(source, "/nsd/memory/count", shape) == 1 ? (int64_t)shape[0] : 0;
    if (r->blocks > n) r->blocks = n; // a killed writer may have extended only some columns
    if (r->blocks > m) r->blocks = m;
    r->blocks = table_read_rising(r->step, r->blocks);
    return 0;
}

int memory_rows_read(struct memory_rows *r, struct packing *p, struct failure *failure)
{
    int64_t at = table_read_row(r->step, r->blocks, p->step);
    struct span span = { 0, 0 };
    // before its first contact a document has no rows
    bool any = source_has(r->source, "/nsd/memory/body");
    if (at < 0) return 0;
    if (any &&
        table_read_span(r->source, (struct table_spans){ group, "body", 2 }, at, &span, failure))
        return failure->status;
    const int64_t start = span.start, count = span.count;
    struct memory *m = &p->memory;
    m->recall = calloc((size_t)count + 1, sizeof *m->recall);
    if (!m->recall) return failure_set(failure, EX_SOFTWARE, "no memory for the last reactions");
    m->on = true, m->n = count, m->room = count + 1;
    if (!any) return 0;
    if (table_read_columns(r->source, group, "", start,
                           RECORDS_OF(p, recall_fields, count, m->recall), failure))
        return failure->status;
    return memory_check(m, p->n, p->walls, failure);
}

void memory_rows_close(struct memory_rows *r)
{
    free(r->step);
    *r = (struct memory_rows){ 0 };
}

/* ---- to a document ---- */

int memory_rows_write(struct table_write *s, const struct packing *p, struct failure *failure)
{
    const struct memory *m = &p->memory;
    if (!m->on) return 0;
    if (table_write_span(s, "/nsd/memory", s->memory, m->n, failure) ||
        table_write_columns(s, group, "", RECORDS_OF(p, recall_fields, m->n, m->recall),
                            CHUNK_CONTACTS, failure) ||
        table_write_number(s, "/nsd/memory/step", COLUMN_I64, &p->step, NULL, failure))
        return failure->status;
    if (s->growing) s->memory += m->n;
    return 0;
}
