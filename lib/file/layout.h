/*
 * file/layout.h: which dataset holds which member of which struct: one table for each group, by which
 * file/frame_read.c reads and file/frame_write.c writes. nsd-format(5) says the same in words.
 */
#ifndef NSD_LAYOUT_H
#define NSD_LAYOUT_H

#include "file/frame.h"
#include "file/h5.h"

#include <stddef.h>
#include <stdio.h>

/* The dataset of a column of bodies, /particles/all/NAME [N][width], or where the bodies move NAME/value
   [F][N][width]; a row of width 1 has no dimension of its own, but in NAME/value [state/body_columns.h]. */
static inline void layout_body_path(const struct body_column *b, char path[80])
{
    snprintf(path, 80, "/particles/all/%s%s", b->column.name,
             b->traits & BODY_MOVES ? "/value" : "");
}

/* Where the cell is periodic: members of struct cell, [F][3][3] */
static const struct column layout_cell[] = {
    { "box/edges", "m", COLUMN_F64, 9, offsetof(struct cell, edge) },
    { "box/rate", "m s-1", COLUMN_F64, 9, offsetof(struct cell, rate) },
    { 0 },
};

/* /particles/boundary/body/NAME [B][width]: members of struct wall. In version 1 all were planes, in
   /walls/plane, and their loads in /walls/load. Shapes are there where any is no plane, or vanishes. */
static const struct column layout_boundary[] = {
    { "shape", "1", COLUMN_I32, 1, offsetof(struct wall, shape) },
    { "side", "1", COLUMN_I32, 1, offsetof(struct wall, side) },
    { "along", "1", COLUMN_F64, 3, offsetof(struct wall, along) },
    { "size", "m", COLUMN_F64, 3, offsetof(struct wall, size) },
    { "arc", "rad", COLUMN_F64, 1, offsetof(struct wall, arc) },
    { "elements", "1", COLUMN_I32, 2, offsetof(struct wall, first_element) },
    { "until", "s", COLUMN_F64, 1, offsetof(struct wall, until) },
    { 0 },
};
/* The same where any has a weld tolerance of its own */
static const struct column layout_weld[] = {
    { "weld", "m", COLUMN_F64, 1, offsetof(struct wall, weld) },
    { 0 },
};
/* The same where any has a coefficient of wear */
static const struct column layout_wear[] = {
    { "wear", "Pa-1", COLUMN_F64, 1, offsetof(struct wall, wear) },
    { 0 },
};
/* The same where the surface of any moves along itself */
static const struct column layout_belt[] = {
    { "belt", "m s-1", COLUMN_F64, 3, offsetof(struct wall, belt) },
    { 0 },
};
static const struct column layout_plane[] = {
    { "point", "m", COLUMN_F64, 3, offsetof(struct wall, x) },
    { "normal", "1", COLUMN_F64, 3, offsetof(struct wall, n) },
    { "velocity", "m s-1", COLUMN_F64, 3, offsetof(struct wall, v) },
    { "species", "1", COLUMN_I32, 1, offsetof(struct wall, kind) },
    { 0 },
};

/* /nsd/names/NAME [R][width], where any boundary has a name: members of struct named */
static const struct column layout_names[] = {
    { "name", "1", COLUMN_I32, 1, offsetof(struct named, name) },
    { "boundary", "1", COLUMN_I32, 1, offsetof(struct named, boundary) },
    { "faces", "1", COLUMN_I32, 2, offsetof(struct named, first) },
    { 0 },
};

/* /particles/boundary/load/NAME [B][width] where any yields: members of struct wall */
static const struct column layout_loads[] = {
    { "way", "1", COLUMN_I32, 1, offsetof(struct wall, load.way) },
    { "axis", "1", COLUMN_F64, 3, offsetof(struct wall, load.axis) },
    { "point", "m", COLUMN_F64, 3, offsetof(struct wall, load.point) },
    { "mass", "kg, kg m2", COLUMN_F64, 1, offsetof(struct wall, load.mass) },
    { "force", "N, N m", COLUMN_F64, 1, offsetof(struct wall, load.force) },
    { 0 },
};

/* The same, where the load of any is a pressure */
static const struct column layout_spread[] = {
    { "spread", "1", COLUMN_I32, 1, offsetof(struct wall, load.spread) },
    { 0 },
};

/* The same, where a strain rate moves any wall of a room */
static const struct column layout_rate[] = {
    { "rate", "s-1", COLUMN_F64, 1, offsetof(struct wall, load.rate) },
    { 0 },
};

/* /particles/boundary/load/NAME/value [F][B], the same */
static const struct column layout_yield[] = {
    { "speed", "m s-1, rad s-1", COLUMN_F64, 1, offsetof(struct wall, load.speed) },
    { "travel", "m, rad", COLUMN_F64, 1, offsetof(struct wall, load.travel) },
    { 0 },
};

/* /particles/boundary/drive/NAME and, where a load is one in time, push/NAME [D][width]: members of
   struct drive */
static const struct column layout_drive[] = {
    { "boundary", "1", COLUMN_I32, 1, offsetof(struct drive, boundary) },
    { "turns", "1", COLUMN_I32, 1, offsetof(struct drive, turns) },
    { "signal", "1", COLUMN_I32, 1, offsetof(struct drive, signal) },
    { "axis", "1", COLUMN_F64, 3, offsetof(struct drive, axis) },
    { "point", "m", COLUMN_F64, 3, offsetof(struct drive, point) },
    { "value", "m s-1, rad s-1, m, rad", COLUMN_F64, 1, offsetof(struct drive, value) },
    { "frequency", "s-1", COLUMN_F64, 1, offsetof(struct drive, frequency) },
    { "phase", "rad", COLUMN_F64, 1, offsetof(struct drive, phase) },
    { "from", "s", COLUMN_F64, 1, offsetof(struct drive, from) },
    { "until", "s", COLUMN_F64, 1, offsetof(struct drive, until) },
    { "clock", "s", COLUMN_F64, 1, offsetof(struct drive, clock) },
    { "rows", "1", COLUMN_I32, 2, offsetof(struct drive, first) },
    { 0 },
};

/* /particles/boundary/sums/NAME/value [F][faces][width] where they are kept: members of struct face_sums */
static const struct column layout_sums[] = {
    { "impulse", "N s", COLUMN_F64, 3, offsetof(struct face_sums, impulse) },
    { "moment", "N m s", COLUMN_F64, 3, offsetof(struct face_sums, moment) },
    { "normal", "N s", COLUMN_F64, 1, offsetof(struct face_sums, normal) },
    { "tangential", "N s", COLUMN_F64, 1, offsetof(struct face_sums, tangential) },
    { "work", "J", COLUMN_F64, 1, offsetof(struct face_sums, work) },
    { "friction", "J", COLUMN_F64, 1, offsetof(struct face_sums, friction) },
    { "rub", "J", COLUMN_F64, 1, offsetof(struct face_sums, rub) },
    { 0 },
};

/* /nsd/force/NAME [D][width], forces and torques on bodies: members of struct drive, and their tables in /nsd/force/row */
static const struct column layout_pull[] = {
    { "id", "1", COLUMN_I32, 1, offsetof(struct drive, boundary) },
    { "turns", "1", COLUMN_I32, 1, offsetof(struct drive, turns) },
    { "signal", "1", COLUMN_I32, 1, offsetof(struct drive, signal) },
    { "axis", "1", COLUMN_F64, 3, offsetof(struct drive, axis) },
    { "value", "N, N m", COLUMN_F64, 1, offsetof(struct drive, value) },
    { "frequency", "s-1", COLUMN_F64, 1, offsetof(struct drive, frequency) },
    { "phase", "rad", COLUMN_F64, 1, offsetof(struct drive, phase) },
    { "from", "s", COLUMN_F64, 1, offsetof(struct drive, from) },
    { "until", "s", COLUMN_F64, 1, offsetof(struct drive, until) },
    { "rows", "1", COLUMN_I32, 2, offsetof(struct drive, first) },
    { 0 },
};

/* /particles/boundary/NAME [B][width], where any moves NAME/value [F][B][width]: where they are. It
   follows from the tables above, and is not read. */
struct boundary_motion {
    vec3 x; /* m: the point of reference */
    quat q; /* from the orientation in which the shape is described */
    vec3 v; /* m/s: of that point */
    vec3 w; /* rad/s */
};
static const struct column layout_boundary_motion[] = {
    { "position", "m", COLUMN_F64, 3, offsetof(struct boundary_motion, x) },
    { "orientation", "1", COLUMN_F64, 4, offsetof(struct boundary_motion, q) },
    { "velocity", "m s-1", COLUMN_F64, 3, offsetof(struct boundary_motion, v) },
    { "angular_velocity", "rad s-1", COLUMN_F64, 3, offsetof(struct boundary_motion, w) },
    { 0 },
};

/* /nsd/material/NAME [kinds][kinds]: pointers in struct packing */
static const struct column layout_material[] = {
#define MATERIAL(member, name, unit, ...)                                                          \
    { name, unit, COLUMN_F64, 1, offsetof(struct packing, member) },
    EACH_PAIR_COLUMN(MATERIAL){ 0 },
};
/* The same where any pair has another number than 0 */
static const struct column layout_optional_material[] = {
    EACH_OPTIONAL_PAIR_COLUMN(MATERIAL){ 0 },
};
#undef MATERIAL

/* /nsd/law/NAME [kinds][kinds] where any pair has a law beyond these: members of struct pair_law */
static const struct column layout_law[] = {
    { "cohesion", "N", COLUMN_F64, 1, offsetof(struct pair_law, cohesion) },
    { "range", "m", COLUMN_F64, 1, offsetof(struct pair_law, range) },
    { "volume", "m3", COLUMN_F64, 1, offsetof(struct pair_law, volume) },
    { "tension", "N m-1", COLUMN_F64, 1, offsetof(struct pair_law, tension) },
    { "wetting", "rad", COLUMN_F64, 1, offsetof(struct pair_law, wetting) },
    { "mu_r", "m", COLUMN_F64, 1, offsetof(struct pair_law, mu_r) },
    { "mu_p", "m", COLUMN_F64, 1, offsetof(struct pair_law, mu_p) },
    { "c_n", "N m-3", COLUMN_F64, 1, offsetof(struct pair_law, cn) },
    { "c_t", "N m-3", COLUMN_F64, 1, offsetof(struct pair_law, ct) },
    { "w", "J m-2", COLUMN_F64, 1, offsetof(struct pair_law, w) },
    { "eta", "N s m-1", COLUMN_F64, 1, offsetof(struct pair_law, eta) },
    { "area", "m2", COLUMN_F64, 1, offsetof(struct pair_law, area) },
    { "beta", "1", COLUMN_F64, 1, offsetof(struct pair_law, beta) },
    { "made", "s", COLUMN_F64, 1, offsetof(struct pair_law, made) },
    { "forever", "1", COLUMN_F64, 1, offsetof(struct pair_law, forever) },
    { 0 },
};

/* The same where it is said of some pair whether its impacts are bounded */
static const struct column layout_impact[] = {
    { "impact", "1", COLUMN_F64, 1, offsetof(struct pair_law, impact) },
    { 0 },
};

/* The same where contacts of some pair have a stiffness */
static const struct column layout_springs[] = {
    { "k_n", "N m-1", COLUMN_F64, 1, offsetof(struct pair_law, kn) },
    { "k_t", "N m-1", COLUMN_F64, 1, offsetof(struct pair_law, kt) },
    { 0 },
};

/* /nsd/bonds/NAME [B][width], of frame k rows start[k] .. start[k] + count[k] - 1: members of struct
   bond */
static const struct column layout_bonds[] = {
    { "body", "1", COLUMN_I32, 2, offsetof(struct bond, a) },
    { "feature", "1", COLUMN_I32, 1, offsetof(struct bond, feature) },
    { "shift", "1", COLUMN_I8, 3, offsetof(struct bond, shift) },
    { "wet", "1", COLUMN_I8, 1, offsetof(struct bond, wet) },
    { "beta", "1", COLUMN_F64, 1, offsetof(struct bond, beta) },
    { "gap", "m", COLUMN_F64, 1, offsetof(struct bond, gap) },
    { "normal", "1", COLUMN_F64, 3, offsetof(struct bond, n) },
    { "slip", "m", COLUMN_F64, 3, offsetof(struct bond, slip) },
    { 0 },
};

/* /nsd/memory/NAME [K][width], of each frame that has it `count` rows from `start` on: members of struct recall; with
   features, shifts and moments where contacts have any */
static const struct column layout_memory[] = {
    { "body", "1", COLUMN_I32, 2, offsetof(struct recall, a) },
    { "impulse", "N s", COLUMN_F64, 3, offsetof(struct recall, r) },
    { 0 },
};
static const struct column layout_memory_features[] = {
    { "feature", "1", COLUMN_I32, 1, offsetof(struct recall, feature) },
    { 0 },
};
static const struct column layout_memory_shifts[] = {
    { "shift", "1", COLUMN_I8, 3, offsetof(struct recall, shift) },
    { 0 },
};
static const struct column layout_memory_moments[] = {
    { "moment", "N m s", COLUMN_F64, 3, offsetof(struct recall, m) },
    { 0 },
};

/* Of bonds where contacts have a stiffness */
static const struct column layout_pressed[] = {
    { "pressed", "1", COLUMN_I8, 1, offsetof(struct bond, pressed) },
    { "rest", "m", COLUMN_F64, 1, offsetof(struct bond, rest) },
    { 0 },
};

/* Of bonds where there are shapes */
static const struct column layout_anchors[] = {
    { "area", "m2", COLUMN_F64, 1, offsetof(struct bond, area) },
    { "anchor_a", "m", COLUMN_F64, 3, offsetof(struct bond, at_a) },
    { "anchor_b", "m", COLUMN_F64, 3, offsetof(struct bond, at_b) },
    { "axis", "1", COLUMN_F64, 3, offsetof(struct bond, axis) },
    { 0 },
};

/* /contacts/NAME [S][width]: members of struct contact; /contacts/frame, its
   basis, is handled apart */
static const struct column layout_contacts[] = {
    { "body", "1", COLUMN_I32, 2, offsetof(struct contact, a) },
    { "point", "m", COLUMN_F64, 3, offsetof(struct contact, x) },
    { "gap", "m", COLUMN_F64, 1, offsetof(struct contact, gap) },
#define NUMBER(member, name, unit, ...)                                                            \
    { name, unit, COLUMN_F64, 1, offsetof(struct contact, member) },
    EACH_PAIR_COLUMN(NUMBER)
#undef NUMBER
        { 0 },
};

/* The same where the cell repeats */
static const struct column layout_shifts[] = {
    { "shift", "1", COLUMN_I8, 3, offsetof(struct contact, shift) },
    { 0 },
};

/* The same where there is a mesh */
static const struct column layout_features[] = {
    { "feature", "1", COLUMN_I32, 1, offsetof(struct contact, feature) },
    { 0 },
};

/* The same where pairs have laws beyond friction and restitution: members of struct contact_law */
static const struct column layout_contact_laws[] = {
    { "pull", "N", COLUMN_F64, 1, offsetof(struct contact_law, pull) },
    { "stiffness", "N m-1", COLUMN_F64, 2, offsetof(struct contact_law, stiff) },
    { "jump", "m", COLUMN_F64, 3, offsetof(struct contact_law, jump) },
    { "beta", "1", COLUMN_F64, 1, offsetof(struct contact_law, beta) },
    { "offset", "m s-1", COLUMN_F64, 1, offsetof(struct contact_law, offset) },
    { "mu_r", "m", COLUMN_F64, 1, offsetof(struct contact_law, mu_r) },
    { "mu_p", "m", COLUMN_F64, 1, offsetof(struct contact_law, mu_p) },
    { "tie", "1", COLUMN_I8, 1, offsetof(struct contact_law, state) },
    { 0 },
};

/* The same where contacts have a stiffness */
static const struct column layout_contact_springs[] = {
    { "spring", "N m-1", COLUMN_F64, 2, offsetof(struct contact_law, spring) },
    { "hit", "N s", COLUMN_F64, 3, offsetof(struct contact_law, hit) },
    { 0 },
};

/* /contacts/NAME [S][width] of solved contacts: members of struct found */
static const struct column layout_found[] = {
    { "reaction", "N s", COLUMN_F64, 3, offsetof(struct found, r) },
    { "velocity", "m s-1", COLUMN_F64, 3, offsetof(struct found, u) },
    { "status", "1", COLUMN_I8, 1, offsetof(struct found, status) },
    { 0 },
};

/* [S][3] N m s: the moments of solved contacts on b, in the frame, where there is rolling friction */
#define LAYOUT_MOMENT "/contacts/moment"

/* [S][3] N: the reactions of solved contacts as forces on b, in space; written where asked, not read */
#define LAYOUT_FORCE "/contacts/force"

/*
 * The group of the solver's reports. Not among H5MD's /observables: readers take each member of that
 * for an element with a value in every frame. LAYOUT_REPORT_0_1: where it was until nsd 0.1.
 */
/* Radii: TOL of an automatic time step; of /nsd, only of documents that have one */
#define LAYOUT_TOLERANCE "time_step_tolerance"
/* Where the time step adapts, each frame's: [F], s */
#define LAYOUT_TIME_STEP "/nsd/time_step/value"

#define LAYOUT_REPORT     "/nsd/solver"
#define LAYOUT_REPORT_0_1 "/observables/solver"

/*
 * LAYOUT_REPORT/NAME/value [F][width]: members of struct report. The five numbers of eps are
 * eps_glob, motion, proj, bipotential, penetration.
 */
static const struct column layout_report[] = {
    { "contacts", "1", COLUMN_I64, 1, offsetof(struct report, err.contacts) },
    { "sweeps", "1", COLUMN_I32, 1, offsetof(struct report, sweeps) },
    { "converged", "1", COLUMN_I8, 1, offsetof(struct report, converged) },
    { "eps", "1", COLUMN_F64, 5, offsetof(struct report, err.paper) },
    { "eps_scaled", "1", COLUMN_F64, 5, offsetof(struct report, err.scaled) },
    { "natural", "1", COLUMN_F64, 1, offsetof(struct report, err.natural) },
    { "natural_siconos", "1", COLUMN_F64, 1, offsetof(struct report, err.natural_siconos) },
    { "natural_q", "1", COLUMN_F64, 1, offsetof(struct report, err.natural_q) },
    { "max_penetration", "m s-1", COLUMN_F64, 1, offsetof(struct report, err.max_penetration) },
    { "max_penetration_true", "m s-1", COLUMN_F64, 1,
      offsetof(struct report, err.max_penetration_true) },
    { "max_overlap", "m", COLUMN_F64, 1, offsetof(struct report, err.max_overlap) },
    { "newton", "1", COLUMN_I64, 1, offsetof(struct report, newton) },
    { "safeguarded", "1", COLUMN_I64, 1, offsetof(struct report, safeguarded) },
    { "gave_up", "1", COLUMN_I64, 1, offsetof(struct report, gave_up) },
    { 0 },
};

/* The same where the criterion is velocity */
static const struct column layout_velocity[] = {
    { "velocity", "1", COLUMN_F64, 1, offsetof(struct report, err.velocity) },
    { "velocity_error", "m s-1", COLUMN_F64, 1, offsetof(struct report, err.velocity_error) },
    { "jammed", "1", COLUMN_I64, 1, offsetof(struct report, err.jammed) },
    { 0 },
};

/* /nsd/flow/NAME/value [F][pours], or [removals]: members of struct passage */
static const struct column layout_poured[] = {
    { "poured", "1", COLUMN_I64, 1, offsetof(struct flow_count, bodies) },
    { "poured_mass", "kg", COLUMN_F64, 1, offsetof(struct flow_count, mass) },
    { 0 },
};
static const struct column layout_removed[] = {
    { "removed", "1", COLUMN_I64, 1, offsetof(struct flow_count, bodies) },
    { "removed_mass", "kg", COLUMN_F64, 1, offsetof(struct flow_count, mass) },
    { 0 },
};

/* /nsd/flow/events/NAME [E][width]: members of struct event */
static const struct column layout_events[] = {
    { "step", "1", COLUMN_I64, 1, offsetof(struct event, step) },
    { "time", "s", COLUMN_F64, 1, offsetof(struct event, t) },
    { "id", "1", COLUMN_I32, 1, offsetof(struct event, id) },
    { "came", "1", COLUMN_I8, 1, offsetof(struct event, came) },
    { "which", "1", COLUMN_I32, 1, offsetof(struct event, which) },
    { "radius", "m", COLUMN_F64, 1, offsetof(struct event, radius) },
    { "mass", "kg", COLUMN_F64, 1, offsetof(struct event, mass) },
    { "position", "m", COLUMN_F64, 3, offsetof(struct event, x) },
    { "velocity", "m s-1", COLUMN_F64, 3, offsetof(struct event, v) },
    { 0 },
};

/* /observables/solver/NAME/value [F][width] where there are bodies: members of struct report */
static const struct column layout_balance[] = {
    { "kinetic_energy", "J", COLUMN_F64, 1, offsetof(struct report, balance.kinetic) },
    { "kinetic_change", "J", COLUMN_F64, 1, offsetof(struct report, balance.change) },
    { "potential_energy", "J", COLUMN_F64, 1, offsetof(struct report, balance.potential) },
    { "work_gravity", "J", COLUMN_F64, 1, offsetof(struct report, balance.gravity) },
    { "work_drives", "J", COLUMN_F64, 1, offsetof(struct report, balance.drives) },
    { "work_loads", "J", COLUMN_F64, 1, offsetof(struct report, balance.loads) },
    { "dissipation", "J", COLUMN_F64, 1, offsetof(struct report, balance.dissipation) },
    { "momentum", "N s", COLUMN_F64, 3, offsetof(struct report, balance.momentum) },
    { "boundary_impulse", "N s", COLUMN_F64, 3, offsetof(struct report, balance.impulse) },
    { 0 },
};

/* The same where pairs have laws beyond friction and restitution */
static const struct column layout_bond_balance[] = {
    { "bond_change", "J", COLUMN_F64, 1, offsetof(struct report, balance.bond_change) },
    { "bond_energy", "J", COLUMN_F64, 1, offsetof(struct report, balance.bond_energy) },
    { "broken", "J", COLUMN_F64, 1, offsetof(struct report, balance.broken) },
    { 0 },
};

/* The same where contacts have a stiffness */
static const struct column layout_spring_balance[] = {
    { "implicit", "J", COLUMN_F64, 1, offsetof(struct report, balance.implicit) },
    { 0 },
};

/* The same where impacts may gain energy */
static const struct column layout_gain_balance[] = {
    { "impact_gain", "J", COLUMN_F64, 1, offsetof(struct report, balance.gained) },
    { 0 },
};

/* The same where the cell moves */
static const struct column layout_peculiar_balance[] = {
    { "peculiar_energy", "J", COLUMN_F64, 1, offsetof(struct report, balance.peculiar) },
    { "peculiar_change", "J", COLUMN_F64, 1, offsetof(struct report, balance.peculiar_change) },
    { 0 },
};

/* The same where bodies that overlap are moved apart */
static const struct column layout_projection_balance[] = {
    { "projection_work", "J", COLUMN_F64, 1, offsetof(struct report, balance.projection) },
    { "projection_angular_momentum", "N m s", COLUMN_F64, 3,
      offsetof(struct report, balance.spun) },
    { 0 },
};

#endif
