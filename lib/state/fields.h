/*
 * state/fields.h: the tables of fields [base/field.h] of what a frame has: of a packing's parts [state/part.h], its
 * contacts and its report. nsd-format(5) says the same in words. Rows stand in the order in which their datasets are made.
 * A new member of a struct is a row in state/field_tables.c, and the place that uses it.
 */
#pragma once

#include "base/field.h"

extern const struct field packing_fields[], cell_fields[]; /* of struct packing */
extern const struct field box_fields[];                    /* of struct cell: its edges */

extern const struct field wall_fields[], load_fields[], load_motion_fields[]; /* of struct wall */
extern const struct field drive_fields[], pull_fields[]; /* of struct drive: of walls, of bodies */
extern const struct field drive_row_fields[], gradient_fields[], factor_fields[];
extern const struct field vertex_fields[], element_fields[], named_fields[], law_fields[];
extern const struct field breakage_fields[], broken_fields[];
extern const struct field
    material_fields[]; /* of struct packing: pointers to [materials][materials] */

extern const struct field bond_fields[], recall_fields[], sum_fields[];
extern const struct field poured_fields[], removed_fields[], event_fields[];

/* Of struct contact, of its law and of what a solver finds at it */
extern const struct field contact_fields[], contact_key_fields[], contact_law_fields[],
    found_fields[];

/* Of struct report */
extern const struct field report_fields[], terms_fields[], velocity_fields[], balance_fields[];
extern const struct field bond_balance_fields[], spring_balance_fields[], gain_balance_fields[],
    peculiar_balance_fields[], projection_balance_fields[], small_step_fields[];

/* Terms that the balances of some packings have, and where struct report says that it has them: a bool */
struct balance_part {
    const struct field *fields;
    size_t flag;
};
enum { BALANCE_PARTS = 8 };
extern const struct balance_part balance_parts[BALANCE_PARTS + 1];
static inline bool balance_part_has(const struct balance_part *part, const void *report)
{
    return *(const bool *)((const char *)report + part->flag);
}
static inline bool *balance_part_flag(const struct balance_part *part, void *report)
{
    return (bool *)((char *)report + part->flag);
}
