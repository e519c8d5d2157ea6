#include "file/breakage_tables.h"

#include "state/breakable.h"

static const char group[] = "/nsd/breakage";

int breakage_tables_read(struct source *s, int64_t k, struct packing *p, struct failure *failure)
{
    if (!source_has(s, group)) return 0;
    if (breakage_alloc(p, failure) ||
        table_read_columns(s, group, "", 0, RECORDS(breakage_fields, p->materials, p->breakage),
                           failure) ||
        table_read_frame(s, group, k, RECORDS(broken_fields, p->materials, p->broken), failure))
        return failure->status;
    return records_check(RECORDS(broken_fields, p->materials, p->broken), group, failure);
}

int breakage_tables_write_static(struct table_write *s, const struct packing *p,
                                 struct failure *failure)
{
    return p->breakage ? table_write_once(
                             s, group, RECORDS(breakage_fields, p->materials, p->breakage), failure)
                       : 0;
}

int breakage_tables_write(struct table_write *s, const struct packing *p, struct failure *failure)
{
    return p->breakage
               ? table_write_frame(s, group, RECORDS(broken_fields, p->materials, p->broken),
                                   CHUNK_FRAMES, failure)
               : 0;
}

int breakage_tables_link(struct table_write *s, const struct packing *p, struct failure *failure)
{
    const char *step = "/particles/all/position/step", *time = "/particles/all/position/time";
    return p->breakage && (table_write_link(s, step, "step", group, broken_fields, failure) ||
                           table_write_link(s, time, "time", group, broken_fields, failure))
               ? failure->status
               : 0;
}
