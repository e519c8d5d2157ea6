#include "state/fields.h"

#include "state/breakage.h"
#include "state/packing.h"
#include "state/report.h"

#include <math.h>

/* ---- a packing: what all frames share, attributes of /nsd ---- */

const struct field packing_fields[] = {
    FIELD(struct packing, dim, I32, 1, "dim", "1", FIELD_SAME),
    FIELD(struct packing, theta, F64, 1, "theta", "1", FIELD_SAME, .range = FIELD_FRACTION),
    FIELD(struct packing, g, F64, 3, "gravity", "m s-2", FIELD_SAME | FIELD_STEERED,
          .range = FIELD_FINITE),
    FIELD(struct packing, seed, I64, 1, "seed", "1", FIELD_SAME),
    FIELD(struct packing, pulls_most, F64, 1, "acceleration of the forces", "m s-2", FIELD_SAME),
    { 0 },
};

/* ---- the cell ---- */

const struct field cell_fields[] = {
    FIELD(struct packing, cell.repeats, I8, 3, "periodic", "1", FIELD_SAME),
    FIELD(struct packing, cell.origin, F64, 3, "origin", "m", FIELD_SAME),
    FIELD(struct packing, cell.mass, F64, 9, "mass", "kg", FIELD_SAME),
    FIELD(struct packing, cell.stress, F64, 9, "stress", "Pa", FIELD_SAME),
    FIELD(struct packing, cell.size_mass, F64, 1, "size_mass", "kg m2", FIELD_SAME),
    FIELD(struct packing, cell.mean, F64, 1, "mean", "Pa", FIELD_SAME),
    { 0 },
};
_Static_assert(sizeof(bool) == 1, "flags are bytes in documents");

/* Where the cell is periodic: members of struct cell, [F][3][3] */
const struct field box_fields[] = {
    FIELD(struct cell, edge, F64, 9, "box/edges", "m", FIELD_MOVES),
    FIELD(struct cell, rate, F64, 9, "box/rate", "m s-1", FIELD_MOVES),
    { 0 },
};

const struct field gradient_fields[] = {
    FIELD(struct cell_gradient, t, F64, 1, "time", "s", FIELD_SAME),
    FIELD(struct cell_gradient, L, F64, 9, "gradient", "s-1", FIELD_SAME),
    { 0 },
};

const struct field factor_fields[] = {
    FIELD(struct cell_factor, t, F64, 2, "factor", "s; 1", FIELD_SAME),
    { 0 },
};

/* ---- walls: /particles/boundary/body/NAME [walls][width] ---- */

/* Planes that are there for ever need no table of shapes. */
static bool any_shapes(const void *of)
{
    const struct packing *p = of;
    for (int32_t w = 0; w < p->walls; w++)
        if (p->wall[w].shape != WALL_PLANE || p->wall[w].until < INFINITY) return true;
    return false;
}

const struct field wall_fields[] = {
    FIELD(struct wall, x, F64, 3, "point", "m", FIELD_SAME | FIELD_STEERED),
    FIELD(struct wall, n, F64, 3, "normal", "1", FIELD_SAME),
    FIELD(struct wall, v, F64, 3, "velocity", "m s-1", FIELD_SAME | FIELD_STEERED),
    FIELD(struct wall, material, I32, 1, "species", "1", FIELD_SAME),
    FIELD(struct wall, shape, I32, 1, "shape", "1", FIELD_SAME, .when = any_shapes),
    FIELD(struct wall, side, I32, 1, "side", "1", FIELD_SAME, .when = any_shapes),
    FIELD(struct wall, along, F64, 3, "along", "1", FIELD_SAME, .when = any_shapes),
    FIELD(struct wall, size, F64, 3, "size", "m", FIELD_SAME, .when = any_shapes),
    FIELD(struct wall, arc, F64, 1, "arc", "rad", FIELD_SAME, .when = any_shapes),
    FIELD(struct wall, first_element, I32, 2, "elements", "1", FIELD_SAME, .when = any_shapes),
    FIELD(struct wall, until, F64, 1, "until", "s", FIELD_SAME, .when = any_shapes),
    FIELD(struct wall, weld, F64, 1, "weld", "m", FIELD_SAME | FIELD_OPTIONAL),
    FIELD(struct wall, wear, F64, 1, "wear", "Pa-1", FIELD_SAME | FIELD_OPTIONAL,
          .range = FIELD_NOT_NEGATIVE),
    FIELD(struct wall, belt, F64, 3, "belt", "m s-1", FIELD_SAME | FIELD_OPTIONAL,
          .range = FIELD_FINITE),
    { 0 },
};

/* /particles/boundary/load/NAME [walls][width], where any wall yields; of those that move NAME/value [frames][walls] */
const struct field load_fields[] = {
    FIELD(struct wall, load.way, I32, 1, "way", "1", FIELD_SAME),
    FIELD(struct wall, load.axis, F64, 3, "axis", "1", FIELD_SAME),
    FIELD(struct wall, load.point, F64, 3, "point", "m", FIELD_SAME),
    FIELD(struct wall, load.mass, F64, 1, "mass", "kg, kg m2", FIELD_SAME),
    FIELD(struct wall, load.force, F64, 1, "force", "N, N m", FIELD_SAME),
    FIELD(struct wall, load.spread, I32, 1, "spread", "1", FIELD_SAME | FIELD_OPTIONAL),
    FIELD(struct wall, load.rate, F64, 1, "rate", "s-1", FIELD_SAME | FIELD_OPTIONAL),
    { 0 },
};
const struct field load_motion_fields[] = {
    FIELD(struct wall, load.speed, F64, 1, "speed", "m s-1, rad s-1", FIELD_MOVES),
    FIELD(struct wall, load.travel, F64, 1, "travel", "m, rad", FIELD_MOVES),
    { 0 },
};

/* /particles/boundary/drive/NAME and, where a load is one in time, push/NAME [drives][width] */
const struct field drive_fields[] = {
    FIELD(struct drive, wall, I32, 1, "boundary", "1", FIELD_SAME),
    FIELD(struct drive, turns, I32, 1, "turns", "1", FIELD_SAME),
    FIELD(struct drive, signal, I32, 1, "signal", "1", FIELD_SAME),
    FIELD(struct drive, axis, F64, 3, "axis", "1", FIELD_SAME),
    FIELD(struct drive, point, F64, 3, "point", "m", FIELD_SAME),
    FIELD(struct drive, value, F64, 1, "value", "m s-1, rad s-1, m, rad", FIELD_SAME),
    FIELD(struct drive, frequency, F64, 1, "frequency", "s-1", FIELD_SAME),
    FIELD(struct drive, phase, F64, 1, "phase", "rad", FIELD_SAME),
    FIELD(struct drive, from, F64, 1, "from", "s", FIELD_SAME),
    FIELD(struct drive, until, F64, 1, "until", "s", FIELD_SAME),
    FIELD(struct drive, clock, F64, 1, "clock", "s", FIELD_SAME),
    FIELD(struct drive, first, I32, 2, "rows", "1", FIELD_SAME),
    { 0 },
};

/* /nsd/force/NAME [forces][width]: forces and torques on bodies, and their tables in /nsd/force/row */
const struct field pull_fields[] = {
    FIELD(struct drive, wall, I32, 1, "id", "1", FIELD_SAME),
    FIELD(struct drive, turns, I32, 1, "turns", "1", FIELD_SAME),
    FIELD(struct drive, signal, I32, 1, "signal", "1", FIELD_SAME),
    FIELD(struct drive, axis, F64, 3, "axis", "1", FIELD_SAME),
    FIELD(struct drive, value, F64, 1, "value", "N, N m", FIELD_SAME),
    FIELD(struct drive, frequency, F64, 1, "frequency", "s-1", FIELD_SAME),
    FIELD(struct drive, phase, F64, 1, "phase", "rad", FIELD_SAME),
    FIELD(struct drive, from, F64, 1, "from", "s", FIELD_SAME),
    FIELD(struct drive, until, F64, 1, "until", "s", FIELD_SAME),
    FIELD(struct drive, first, I32, 2, "rows", "1", FIELD_SAME),
    { 0 },
};

const struct field drive_row_fields[] = {
    FIELD(struct drive_row, t, F64, 2, "row", "s; m, rad", FIELD_SAME),
    { 0 },
};

/* /particles/boundary/mesh/NAME [n][3] */
typedef int32_t corners[3];
const struct field vertex_fields[] = {
    { .name = "vertex", .units = "m", .type = COLUMN_F64, .width = 3, .traits = FIELD_SAME },
    { 0 },
};
const struct field element_fields[] = {
    { .name = "element", .units = NULL, .type = COLUMN_I32, .width = 3, .traits = FIELD_SAME },
    { 0 },
};

/* /nsd/names/NAME [rows][width], where any wall has a name */
const struct field named_fields[] = {
    FIELD(struct named, name, I32, 1, "name", "1", FIELD_SAME),
    FIELD(struct named, wall, I32, 1, "boundary", "1", FIELD_SAME),
    FIELD(struct named, first, I32, 2, "faces", "1", FIELD_SAME),
    { 0 },
};

/* ---- materials: /nsd/law/NAME [materials][materials] where any pair has a law beyond friction and restitution ---- */

#define MATERIAL(member, name, unit, key, most, ...)                                               \
    FIELD(struct packing, member, F64, 1, name, unit, FIELD_SAME,                                  \
          .range = (most) == 1 ? FIELD_FRACTION : FIELD_NOT_NEGATIVE),
#define OPTIONAL(member, name, unit, key, most, ...)                                               \
    FIELD(struct packing, member, F64, 1, name, unit, FIELD_SAME | FIELD_OPTIONAL,                 \
          .range = (most) == 1 ? FIELD_FRACTION : FIELD_NOT_NEGATIVE),
/* /nsd/material/NAME [materials][materials]: pointers in struct packing */
const struct field material_fields[] = {
    EACH_PAIR_COLUMN(MATERIAL) EACH_OPTIONAL_PAIR_COLUMN(OPTIONAL){ 0 },
};
#undef MATERIAL
#undef OPTIONAL

/* key: the law's name and, in its object, the parameter's */
#define LAW(member, name, unit, bounds, json, ...)                                                 \
    FIELD(struct pair_law, member, F64, 1, name, unit, FIELD_SAME __VA_ARGS__,                     \
          .range = FIELD_##bounds, .key = (json))
const struct field law_fields[] = {
    LAW(cohesion, "cohesion", "N", NOT_NEGATIVE, "cohesion.force"),
    LAW(range, "range", "m", NOT_NEGATIVE, "cohesion.range"),
    LAW(volume, "volume", "m3", NOT_NEGATIVE, "capillary.volume"),
    LAW(tension, "tension", "N m-1", NOT_NEGATIVE, "capillary.tension"),
    LAW(wetting, "wetting", "rad", NOT_NEGATIVE, "capillary.wetting"),
    LAW(mu_r, "mu_r", "m", NOT_NEGATIVE, "rolling.mu_r"),
    LAW(mu_p, "mu_p", "m", NOT_NEGATIVE, "rolling.mu_p"),
    LAW(cn, "c_n", "N m-3", NOT_NEGATIVE, "adhesion.c_n"),
    LAW(ct, "c_t", "N m-3", NOT_NEGATIVE, "adhesion.c_t"),
    LAW(w, "w", "J m-2", NOT_NEGATIVE, "adhesion.w"),
    LAW(eta, "eta", "N s m-1", NOT_NEGATIVE, "adhesion.eta"),
    LAW(area, "area", "m2", NOT_NEGATIVE, "adhesion.area"),
    LAW(beta, "beta", "1", FRACTION, "adhesion.beta"),
    LAW(made, "made", "s", FINITE, "adhesion.made"),
    LAW(forever, "forever", "1", FLAG, "adhesion.forever"),
    LAW(impact, "impact", "1", NOT_NEGATIVE, NULL, | FIELD_OPTIONAL),
    LAW(mu_r_ratio, "mu_r_ratio", "1", NOT_NEGATIVE, "rolling.mu_r_ratio", | FIELD_OPTIONAL),
    LAW(mu_p_ratio, "mu_p_ratio", "1", NOT_NEGATIVE, "rolling.mu_p_ratio", | FIELD_OPTIONAL),
    LAW(kn, "k_n", "N m-1", NOT_NEGATIVE, "stiffness.normal", | FIELD_OPTIONAL),
    LAW(kt, "k_t", "N m-1", NOT_NEGATIVE, "stiffness.tangential", | FIELD_OPTIONAL),
    LAW(soft, "compliance", "1", FRACTION, "stiffness.compliance", | FIELD_OPTIONAL),
    { 0 },
};

/* ---- breakage: /nsd/breakage/NAME [materials], and NAME/value [frames][materials] ---- */

#define BREAKS(member, unit, bounds)                                                               \
    FIELD(struct breakage, member, F64, 1, #member, unit, FIELD_SAME, .range = FIELD_##bounds)
#define WORD(member) FIELD(struct breakage, member, I32, 1, #member, "1", FIELD_SAME)
const struct field breakage_fields[] = {
    BREAKS(strength, "Pa, J kg-1", NOT_NEGATIVE),
    BREAKS(size, "m", NOT_NEGATIVE),
    BREAKS(modulus, "1", NOT_NEGATIVE),
    BREAKS(exponent, "1", FINITE),
    BREAKS(least, "J kg-1", NOT_NEGATIVE),
    BREAKS(gamma, "1", NOT_NEGATIVE),
    BREAKS(smallest, "m", NOT_NEGATIVE),
    BREAKS(dust, "m", NOT_NEGATIVE),
    WORD(by),
    WORD(damage),
    WORD(into),
    FIELD(struct breakage, pieces, I64, 1, "pieces", "1", FIELD_SAME),
    { 0 },
};
#undef BREAKS
#undef WORD

#define COUNTS(member, name)                                                                       \
    FIELD(struct broken, member, I64, 1, name, "1", FIELD_MOVES, .range = FIELD_NOT_NEGATIVE)
const struct field broken_fields[] = {
    COUNTS(grains, "broken"),
    COUNTS(originals, "originals"),
    COUNTS(fragments, "fragments"),
    COUNTS(waiting, "waiting"),
    FIELD(struct broken, mass, F64, 1, "mass", "kg", FIELD_MOVES, .range = FIELD_NOT_NEGATIVE),
    FIELD(struct broken, dust, F64, 1, "dust_mass", "kg", FIELD_MOVES, .range = FIELD_NOT_NEGATIVE),
    FIELD(struct broken, momentum, F64, 3, "dust_momentum", "N s", FIELD_MOVES,
          .range = FIELD_FINITE),
    FIELD(struct broken, kinetic, F64, 1, "dust_kinetic", "J", FIELD_MOVES, .range = FIELD_FINITE),
    FIELD(struct broken, potential, F64, 1, "dust_potential", "J", FIELD_MOVES,
          .range = FIELD_FINITE),
    { 0 },
};
#undef COUNTS

/* ---- what lasts of pairs ---- */

static bool has_shapes(const void *of)
{
    return ((const struct packing *)of)->shape;
}

/* Has a row of this packing a feature? */
static bool has_features(const void *of)
{
    const struct packing *p = of;
    return p->mesh.elements || p->shape;
}

static bool has_images(const void *of)
{
    return cell_repeats(&((const struct packing *)of)->cell);
}

static bool has_springs(const void *of)
{
    return packing_has_springs(of);
}

/* Springs whose stiffness is that of the step */
static bool has_compliance(const void *of)
{
    return packing_has_compliance(of);
}

static bool has_rolling(const void *of)
{
    return packing_rolls(of);
}

/* Springs of moments */
static bool has_turning_springs(const void *of)
{
    return packing_has_springs(of) && packing_rolls(of);
}

/* /nsd/bonds/NAME [bonds][width], of each frame `count` rows from `start` on. Places where there are shapes */
const struct field bond_fields[] = {
    FIELD(struct bond, a, I32, 2, "body", "1", FIELD_MOVES),
    FIELD(struct bond, feature, I32, 1, "feature", "1", FIELD_MOVES),
    FIELD(struct bond, shift, I8, 3, "shift", "1", FIELD_MOVES),
    FIELD(struct bond, wet, I8, 1, "wet", "1", FIELD_MOVES),
    FIELD(struct bond, beta, F64, 1, "beta", "1", FIELD_MOVES, .range = FIELD_FRACTION),
    FIELD(struct bond, gap, F64, 1, "gap", "m", FIELD_MOVES, .range = FIELD_FINITE),
    FIELD(struct bond, n, F64, 3, "normal", "1", FIELD_MOVES, .range = FIELD_UNIT),
    FIELD(struct bond, slip, F64, 3, "slip", "m", FIELD_MOVES, .range = FIELD_FINITE),
    FIELD(struct bond, pressed, I8, 1, "pressed", "1", FIELD_MOVES, .when = has_springs,
          .range = FIELD_FLAG),
    FIELD(struct bond, rest, F64, 1, "rest", "m", FIELD_MOVES, .when = has_springs,
          .range = FIELD_FINITE),
    FIELD(struct bond, spring, F64, 1, "spring", "N m-1", FIELD_MOVES, .when = has_compliance,
          .range = FIELD_NOT_NEGATIVE),
    FIELD(struct bond, turn, F64, 3, "turn", "rad", FIELD_MOVES, .when = has_turning_springs,
          .range = FIELD_FINITE),
    FIELD(struct bond, area, F64, 1, "area", "m2", FIELD_MOVES, .when = has_shapes,
          .range = FIELD_NOT_NEGATIVE),
    FIELD(struct bond, at_a, F64, 3, "anchor_a", "m", FIELD_MOVES, .when = has_shapes),
    FIELD(struct bond, at_b, F64, 3, "anchor_b", "m", FIELD_MOVES, .when = has_shapes),
    FIELD(struct bond, axis, F64, 3, "axis", "1", FIELD_MOVES, .when = has_shapes),
    { 0 },
};

/* /nsd/memory/NAME [reactions][width], of each frame that has it `count` rows from `start` on */
const struct field recall_fields[] = {
    FIELD(struct recall, a, I32, 2, "body", "1", FIELD_MOVES),
    FIELD(struct recall, r, F64, 3, "impulse", "N s", FIELD_MOVES, .range = FIELD_FINITE),
    FIELD(struct recall, feature, I32, 1, "feature", "1", FIELD_MOVES, .when = has_features),
    FIELD(struct recall, shift, I8, 3, "shift", "1", FIELD_MOVES, .when = has_images),
    FIELD(struct recall, m, F64, 3, "moment", "N m s", FIELD_MOVES, .when = has_rolling,
          .range = FIELD_FINITE),
    { 0 },
};

/* ---- sums and counts ---- */

/* /particles/boundary/sums/NAME/value [frames][faces][width] where they are kept */
const struct field sum_fields[] = {
    FIELD(struct face_sums, impulse, F64, 3, "impulse", "N s", FIELD_MOVES, .range = FIELD_FINITE),
    FIELD(struct face_sums, moment, F64, 3, "moment", "N m s", FIELD_MOVES, .range = FIELD_FINITE),
    FIELD(struct face_sums, normal, F64, 1, "normal", "N s", FIELD_MOVES, .range = FIELD_FINITE),
    FIELD(struct face_sums, tangential, F64, 1, "tangential", "N s", FIELD_MOVES,
          .range = FIELD_FINITE),
    FIELD(struct face_sums, work, F64, 1, "work", "J", FIELD_MOVES, .range = FIELD_FINITE),
    FIELD(struct face_sums, friction, F64, 1, "friction", "J", FIELD_MOVES, .range = FIELD_FINITE),
    FIELD(struct face_sums, rub, F64, 1, "rub", "J", FIELD_MOVES, .range = FIELD_FINITE),
    { 0 },
};

/* /nsd/flow/NAME/value [frames][pours], or [removals] */
const struct field poured_fields[] = {
    FIELD(struct flow_count, bodies, I64, 1, "poured", "1", FIELD_MOVES,
          .range = FIELD_NOT_NEGATIVE),
    FIELD(struct flow_count, mass, F64, 1, "poured_mass", "kg", FIELD_MOVES,
          .range = FIELD_NOT_NEGATIVE),
    { 0 },
};
const struct field removed_fields[] = {
    FIELD(struct flow_count, bodies, I64, 1, "removed", "1", FIELD_MOVES,
          .range = FIELD_NOT_NEGATIVE),
    FIELD(struct flow_count, mass, F64, 1, "removed_mass", "kg", FIELD_MOVES,
          .range = FIELD_NOT_NEGATIVE),
    { 0 },
};

/* /nsd/flow/events/NAME [events][width], of each frame `count` rows from `start` on */
const struct field event_fields[] = {
    FIELD(struct event, step, I64, 1, "step", "1", FIELD_MOVES),
    FIELD(struct event, t, F64, 1, "time", "s", FIELD_MOVES, .range = FIELD_FINITE),
    FIELD(struct event, id, I32, 1, "id", "1", FIELD_MOVES),
    FIELD(struct event, came, I8, 1, "came", "1", FIELD_MOVES, .range = FIELD_FLAG),
    FIELD(struct event, which, I32, 1, "which", "1", FIELD_MOVES, .range = FIELD_NOT_NEGATIVE),
    FIELD(struct event, radius, F64, 1, "radius", "m", FIELD_MOVES, .range = FIELD_POSITIVE),
    FIELD(struct event, mass, F64, 1, "mass", "kg", FIELD_MOVES, .range = FIELD_NOT_NEGATIVE),
    FIELD(struct event, x, F64, 3, "position", "m", FIELD_MOVES, .range = FIELD_FINITE),
    FIELD(struct event, v, F64, 3, "velocity", "m s-1", FIELD_MOVES, .range = FIELD_FINITE),
    { 0 },
};

/* ---- contacts: /contacts/NAME [contacts][width]; /contacts/frame, their basis, is handled apart ---- */

const struct field contact_fields[] = {
    FIELD(struct contact, a, I32, 2, "body", "1", FIELD_MOVES),
    FIELD(struct contact, x, F64, 3, "point", "m", FIELD_MOVES),
    FIELD(struct contact, gap, F64, 1, "gap", "m", FIELD_MOVES),
#define NUMBER(member, name, unit, ...)                                                            \
    FIELD(struct contact, member, F64, 1, name, unit, FIELD_MOVES),
    EACH_PAIR_COLUMN(NUMBER)
#undef NUMBER
        { 0 },
};

/* Beside the basis: */
const struct field contact_key_fields[] = {
    FIELD(struct contact, shift, I8, 3, "shift", "1", FIELD_MOVES, .when = has_images),
    FIELD(struct contact, feature, I32, 1, "feature", "1", FIELD_MOVES, .when = has_features),
    { 0 },
};

/* Where pairs have laws beyond friction and restitution */
const struct field contact_law_fields[] = {
    FIELD(struct contact_law, pull, F64, 1, "pull", "N", FIELD_MOVES),
    FIELD(struct contact_law, stiff, F64, 2, "stiffness", "N m-1", FIELD_MOVES),
    FIELD(struct contact_law, jump, F64, 3, "jump", "m", FIELD_MOVES),
    FIELD(struct contact_law, beta, F64, 1, "beta", "1", FIELD_MOVES),
    FIELD(struct contact_law, offset, F64, 1, "offset", "m s-1", FIELD_MOVES),
    FIELD(struct contact_law, mu_r, F64, 1, "mu_r", "m", FIELD_MOVES),
    FIELD(struct contact_law, mu_p, F64, 1, "mu_p", "m", FIELD_MOVES),
    FIELD(struct contact_law, state, I8, 1, "tie", "1", FIELD_MOVES),
    FIELD(struct contact_law, spring, F64, 2, "spring", "N m-1", FIELD_MOVES, .when = has_springs),
    FIELD(struct contact_law, hit, F64, 3, "hit", "N s", FIELD_MOVES, .when = has_springs),
    FIELD(struct contact_law, roll, F64, 1, "rolling_stiffness", "N m", FIELD_MOVES,
          .when = has_turning_springs),
    FIELD(struct contact_law, turn, F64, 3, "turn", "rad", FIELD_MOVES,
          .when = has_turning_springs),
    { 0 },
};

const struct field found_fields[] = {
    FIELD(struct found, r, F64, 3, "reaction", "N s", FIELD_MOVES),
    FIELD(struct found, u, F64, 3, "velocity", "m s-1", FIELD_MOVES),
    FIELD(struct found, status, I8, 1, "status", "1", FIELD_MOVES),
    { 0 },
};

/* ---- reports ---- */

/* /nsd/solver/NAME/value [frames][width]; the five numbers of eps are those of terms_fields */
const struct field report_fields[] = {
    FIELD(struct report, err.contacts, I64, 1, "contacts", "1", FIELD_MOVES,
          .range = FIELD_NOT_NEGATIVE),
    FIELD(struct report, sweeps, I32, 1, "sweeps", "1", FIELD_MOVES, .range = FIELD_NOT_NEGATIVE),
    FIELD(struct report, converged, I8, 1, "converged", "1", FIELD_MOVES, .range = FIELD_FLAG),
    FIELD(struct report, err.paper, F64, 5, "eps", "1", FIELD_MOVES),
    FIELD(struct report, err.scaled, F64, 5, "eps_scaled", "1", FIELD_MOVES),
    FIELD(struct report, err.natural, F64, 1, "natural", "1", FIELD_MOVES),
    FIELD(struct report, err.natural_siconos, F64, 1, "natural_siconos", "1", FIELD_MOVES),
    FIELD(struct report, err.natural_q, F64, 1, "natural_q", "1", FIELD_MOVES),
    FIELD(struct report, err.max_penetration, F64, 1, "max_penetration", "m s-1", FIELD_MOVES),
    FIELD(struct report, err.max_penetration_true, F64, 1, "max_penetration_true", "m s-1",
          FIELD_MOVES),
    FIELD(struct report, err.max_overlap, F64, 1, "max_overlap", "m", FIELD_MOVES),
    FIELD(struct report, newton, I64, 1, "newton", "1", FIELD_MOVES, .range = FIELD_NOT_NEGATIVE),
    FIELD(struct report, safeguarded, I64, 1, "safeguarded", "1", FIELD_MOVES,
          .range = FIELD_NOT_NEGATIVE),
    FIELD(struct report, gave_up, I64, 1, "gave_up", "1", FIELD_MOVES, .range = FIELD_NOT_NEGATIVE),
    { 0 },
};

const struct field terms_fields[] = {
    FIELD(struct terms, eps_glob, F64, 1, "eps_glob", "1", FIELD_MOVES),
    FIELD(struct terms, motion, F64, 1, "motion", "1", FIELD_MOVES),
    FIELD(struct terms, proj, F64, 1, "proj", "1", FIELD_MOVES),
    FIELD(struct terms, bipotential, F64, 1, "bipotential", "1", FIELD_MOVES),
    FIELD(struct terms, penetration, F64, 1, "penetration", "1", FIELD_MOVES),
    { 0 },
};

/* The same where the criterion is velocity */
const struct field velocity_fields[] = {
    FIELD(struct report, err.velocity, F64, 1, "velocity", "1", FIELD_MOVES),
    FIELD(struct report, err.velocity_error, F64, 1, "velocity_error", "m s-1", FIELD_MOVES),
    FIELD(struct report, err.jammed, I64, 1, "jammed", "1", FIELD_MOVES,
          .range = FIELD_NOT_NEGATIVE),
    { 0 },
};

/* The same where there are bodies */
const struct field balance_fields[] = {
    FIELD(struct report, balance.kinetic, F64, 1, "kinetic_energy", "J", FIELD_MOVES,
          .key = "kinetic"),
    FIELD(struct report, balance.change, F64, 1, "kinetic_change", "J", FIELD_MOVES,
          .key = "change"),
    FIELD(struct report, balance.potential, F64, 1, "potential_energy", "J", FIELD_MOVES,
          .key = "potential"),
    FIELD(struct report, balance.gravity, F64, 1, "work_gravity", "J", FIELD_MOVES,
          .key = "gravity"),
    FIELD(struct report, balance.drives, F64, 1, "work_drives", "J", FIELD_MOVES, .key = "drives"),
    FIELD(struct report, balance.loads, F64, 1, "work_loads", "J", FIELD_MOVES, .key = "loads"),
    FIELD(struct report, balance.dissipation, F64, 1, "dissipation", "J", FIELD_MOVES),
    FIELD(struct report, balance.momentum, F64, 3, "momentum", "N s", FIELD_MOVES),
    FIELD(struct report, balance.impulse, F64, 3, "boundary_impulse", "N s", FIELD_MOVES,
          .key = "impulse"),
    { 0 },
};

/* The same where pairs have laws beyond friction and restitution */
const struct field bond_balance_fields[] = {
    FIELD(struct report, balance.bond_change, F64, 1, "bond_change", "J", FIELD_MOVES),
    FIELD(struct report, balance.bond_energy, F64, 1, "bond_energy", "J", FIELD_MOVES),
    FIELD(struct report, balance.broken, F64, 1, "broken", "J", FIELD_MOVES),
    { 0 },
};

/* The same where contacts have a stiffness */
const struct field spring_balance_fields[] = {
    FIELD(struct report, balance.implicit, F64, 1, "implicit", "J", FIELD_MOVES),
    FIELD(struct report, balance.rise, F64, 1, "rise", "J", FIELD_MOVES),
    { 0 },
};

/* The same where impacts may gain energy */
const struct field gain_balance_fields[] = {
    FIELD(struct report, balance.gained, F64, 1, "impact_gain", "J", FIELD_MOVES, .key = "gained"),
    { 0 },
};

/* The same where the cell moves */
const struct field peculiar_balance_fields[] = {
    FIELD(struct report, balance.peculiar, F64, 1, "peculiar_energy", "J", FIELD_MOVES,
          .key = "peculiar"),
    FIELD(struct report, balance.peculiar_change, F64, 1, "peculiar_change", "J", FIELD_MOVES),
    { 0 },
};

/* The same where bodies that overlap are moved apart */
const struct field projection_balance_fields[] = {
    FIELD(struct report, balance.projection, F64, 1, "projection_work", "J", FIELD_MOVES,
          .key = "projection"),
    FIELD(struct report, balance.spun, F64, 3, "projection_angular_momentum", "N m s", FIELD_MOVES),
    { 0 },
};

/* The same where grains may break */
static const struct field breaking_balance_fields[] = {
    FIELD(struct report, balance.breaking, F64, 1, "breaking", "J", FIELD_MOVES),
    { 0 },
};

/* The same where small steps are asked for */
const struct field small_step_fields[] = {
    FIELD(struct report, small, I64, 1, "small_steps", "1", FIELD_MOVES,
          .range = FIELD_NOT_NEGATIVE),
    FIELD(struct report, small_limited, I64, 1, "small_steps_limited", "1", FIELD_MOVES,
          .range = FIELD_NOT_NEGATIVE),
    FIELD(struct report, missing_mean, F64, 1, "missing_impulse_mean", "1", FIELD_MOVES),
    FIELD(struct report, missing, F64, 1, "missing_impulse", "1", FIELD_MOVES),
    { 0 },
};

/* The same where the contacts of kept frames are judged by converged ones */
const struct field converged_fields[] = {
    FIELD(struct report, compared, I32, 1, "converged_sweeps", "1", FIELD_MOVES,
          .range = FIELD_NOT_NEGATIVE),
    FIELD(struct report, distance, F64, 1, "reaction_error", "1", FIELD_MOVES),
    { 0 },
};

const struct balance_part balance_parts[BALANCE_PARTS + 1] = {
    { bond_balance_fields, offsetof(struct report, tied) },
    { spring_balance_fields, offsetof(struct report, soft) },
    { gain_balance_fields, offsetof(struct report, may_gain) },
    { projection_balance_fields, offsetof(struct report, projected) },
    { peculiar_balance_fields, offsetof(struct report, sheared) },
    { breaking_balance_fields, offsetof(struct report, breaks) },
    { small_step_fields, offsetof(struct report, fine) },
    { converged_fields, offsetof(struct report, judged) },
    { NULL, 0 },
};
