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
static inline void layout_body_path(const struct field *b, char path[80])
{
    snprintf(path, 80, "/particles/all/%s%s", b->name, b->traits & FIELD_MOVES ? "/value" : "");
}

/* Where the cell is periodic: members of struct cell, [F][3][3] */
static const struct field layout_cell[] = {
    FIELD(struct cell, edge, F64, 9, "box/edges", "m", 0),
    FIELD(struct cell, rate, F64, 9, "box/rate", "m s-1", 0),
    { 0 },
};

/* /particles/boundary/body/NAME [B][width]: members of struct wall. In version 1 all were planes, in
   /walls/plane, and their loads in /walls/load. Shapes are there where any is no plane, or vanishes. */
static const struct field layout_boundary[] = {
    FIELD(struct wall, shape, I32, 1, "shape", "1", 0),
    FIELD(struct wall, side, I32, 1, "side", "1", 0),
    FIELD(struct wall, along, F64, 3, "along", "1", 0),
    FIELD(struct wall, size, F64, 3, "size", "m", 0),
    FIELD(struct wall, arc, F64, 1, "arc", "rad", 0),
    FIELD(struct wall, first_element, I32, 2, "elements", "1", 0),
    FIELD(struct wall, until, F64, 1, "until", "s", 0),
    { 0 },
};
/* The same where any has a weld tolerance of its own */
static const struct field layout_weld[] = {
    FIELD(struct wall, weld, F64, 1, "weld", "m", 0),
    { 0 },
};
/* The same where any has a coefficient of wear */
static const struct field layout_wear[] = {
    FIELD(struct wall, wear, F64, 1, "wear", "Pa-1", 0),
    { 0 },
};
/* The same where the surface of any moves along itself */
static const struct field layout_belt[] = {
    FIELD(struct wall, belt, F64, 3, "belt", "m s-1", 0),
    { 0 },
};
static const struct field layout_plane[] = {
    FIELD(struct wall, x, F64, 3, "point", "m", 0),
    FIELD(struct wall, n, F64, 3, "normal", "1", 0),
    FIELD(struct wall, v, F64, 3, "velocity", "m s-1", 0),
    FIELD(struct wall, kind, I32, 1, "species", "1", 0),
    { 0 },
};

/* /nsd/names/NAME [R][width], where any boundary has a name: members of struct named */
static const struct field layout_names[] = {
    FIELD(struct named, name, I32, 1, "name", "1", 0),
    FIELD(struct named, boundary, I32, 1, "boundary", "1", 0),
    FIELD(struct named, first, I32, 2, "faces", "1", 0),
    { 0 },
};

/* /particles/boundary/load/NAME [B][width] where any yields: members of struct wall */
static const struct field layout_loads[] = {
    FIELD(struct wall, load.way, I32, 1, "way", "1", 0),
    FIELD(struct wall, load.axis, F64, 3, "axis", "1", 0),
    FIELD(struct wall, load.point, F64, 3, "point", "m", 0),
    FIELD(struct wall, load.mass, F64, 1, "mass", "kg, kg m2", 0),
    FIELD(struct wall, load.force, F64, 1, "force", "N, N m", 0),
    { 0 },
};

/* The same, where the load of any is a pressure */
static const struct field layout_spread[] = {
    FIELD(struct wall, load.spread, I32, 1, "spread", "1", 0),
    { 0 },
};

/* The same, where a strain rate moves any wall of a room */
static const struct field layout_rate[] = {
    FIELD(struct wall, load.rate, F64, 1, "rate", "s-1", 0),
    { 0 },
};

/* /particles/boundary/load/NAME/value [F][B], the same */
static const struct field layout_yield[] = {
    FIELD(struct wall, load.speed, F64, 1, "speed", "m s-1, rad s-1", 0),
    FIELD(struct wall, load.travel, F64, 1, "travel", "m, rad", 0),
    { 0 },
};

/* /particles/boundary/drive/NAME and, where a load is one in time, push/NAME [D][width]: members of
   struct drive */
static const struct field layout_drive[] = {
    FIELD(struct drive, boundary, I32, 1, "boundary", "1", 0),
    FIELD(struct drive, turns, I32, 1, "turns", "1", 0),
    FIELD(struct drive, signal, I32, 1, "signal", "1", 0),
    FIELD(struct drive, axis, F64, 3, "axis", "1", 0),
    FIELD(struct drive, point, F64, 3, "point", "m", 0),
    FIELD(struct drive, value, F64, 1, "value", "m s-1, rad s-1, m, rad", 0),
    FIELD(struct drive, frequency, F64, 1, "frequency", "s-1", 0),
    FIELD(struct drive, phase, F64, 1, "phase", "rad", 0),
    FIELD(struct drive, from, F64, 1, "from", "s", 0),
    FIELD(struct drive, until, F64, 1, "until", "s", 0),
    FIELD(struct drive, clock, F64, 1, "clock", "s", 0),
    FIELD(struct drive, first, I32, 2, "rows", "1", 0),
    { 0 },
};

/* /particles/boundary/sums/NAME/value [F][faces][width] where they are kept: members of struct face_sums */
static const struct field layout_sums[] = {
    FIELD(struct face_sums, impulse, F64, 3, "impulse", "N s", 0),
    FIELD(struct face_sums, moment, F64, 3, "moment", "N m s", 0),
    FIELD(struct face_sums, normal, F64, 1, "normal", "N s", 0),
    FIELD(struct face_sums, tangential, F64, 1, "tangential", "N s", 0),
    FIELD(struct face_sums, work, F64, 1, "work", "J", 0),
    FIELD(struct face_sums, friction, F64, 1, "friction", "J", 0),
    FIELD(struct face_sums, rub, F64, 1, "rub", "J", 0),
    { 0 },
};

/* /nsd/force/NAME [D][width], forces and torques on bodies: members of struct drive, and their tables in /nsd/force/row */
static const struct field layout_pull[] = {
    FIELD(struct drive, boundary, I32, 1, "id", "1", 0),
    FIELD(struct drive, turns, I32, 1, "turns", "1", 0),
    FIELD(struct drive, signal, I32, 1, "signal", "1", 0),
    FIELD(struct drive, axis, F64, 3, "axis", "1", 0),
    FIELD(struct drive, value, F64, 1, "value", "N, N m", 0),
    FIELD(struct drive, frequency, F64, 1, "frequency", "s-1", 0),
    FIELD(struct drive, phase, F64, 1, "phase", "rad", 0),
    FIELD(struct drive, from, F64, 1, "from", "s", 0),
    FIELD(struct drive, until, F64, 1, "until", "s", 0),
    FIELD(struct drive, first, I32, 2, "rows", "1", 0),
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
static const struct field layout_boundary_motion[] = {
    FIELD(struct boundary_motion, x, F64, 3, "position", "m", 0),
    FIELD(struct boundary_motion, q, F64, 4, "orientation", "1", 0),
    FIELD(struct boundary_motion, v, F64, 3, "velocity", "m s-1", 0),
    FIELD(struct boundary_motion, w, F64, 3, "angular_velocity", "rad s-1", 0),
    { 0 },
};

/* /nsd/material/NAME [kinds][kinds]: pointers in struct packing */
static const struct field layout_material[] = {
#define MATERIAL(member, name, unit, ...) FIELD(struct packing, member, F64, 1, name, unit, 0),
    EACH_PAIR_COLUMN(MATERIAL){ 0 },
};
/* The same where any pair has another number than 0 */
static const struct field layout_optional_material[] = {
    EACH_OPTIONAL_PAIR_COLUMN(MATERIAL){ 0 },
};
#undef MATERIAL

/* /nsd/law/NAME [kinds][kinds] where any pair has a law beyond these: members of struct pair_law */
static const struct field layout_law[] = {
    FIELD(struct pair_law, cohesion, F64, 1, "cohesion", "N", 0),
    FIELD(struct pair_law, range, F64, 1, "range", "m", 0),
    FIELD(struct pair_law, volume, F64, 1, "volume", "m3", 0),
    FIELD(struct pair_law, tension, F64, 1, "tension", "N m-1", 0),
    FIELD(struct pair_law, wetting, F64, 1, "wetting", "rad", 0),
    FIELD(struct pair_law, mu_r, F64, 1, "mu_r", "m", 0),
    FIELD(struct pair_law, mu_p, F64, 1, "mu_p", "m", 0),
    FIELD(struct pair_law, cn, F64, 1, "c_n", "N m-3", 0),
    FIELD(struct pair_law, ct, F64, 1, "c_t", "N m-3", 0),
    FIELD(struct pair_law, w, F64, 1, "w", "J m-2", 0),
    FIELD(struct pair_law, eta, F64, 1, "eta", "N s m-1", 0),
    FIELD(struct pair_law, area, F64, 1, "area", "m2", 0),
    FIELD(struct pair_law, beta, F64, 1, "beta", "1", 0),
    FIELD(struct pair_law, made, F64, 1, "made", "s", 0),
    FIELD(struct pair_law, forever, F64, 1, "forever", "1", 0),
    { 0 },
};

/* The same where it is said of some pair whether its impacts are bounded */
static const struct field layout_impact[] = {
    FIELD(struct pair_law, impact, F64, 1, "impact", "1", 0),
    { 0 },
};

/* /nsd/bonds/NAME [B][width], of frame k rows start[k] .. start[k] + count[k] - 1: members of struct
   bond */
static const struct field layout_bonds[] = {
    FIELD(struct bond, a, I32, 2, "body", "1", 0),
    FIELD(struct bond, feature, I32, 1, "feature", "1", 0),
    FIELD(struct bond, shift, I8, 3, "shift", "1", 0),
    FIELD(struct bond, wet, I8, 1, "wet", "1", 0),
    FIELD(struct bond, beta, F64, 1, "beta", "1", 0),
    FIELD(struct bond, gap, F64, 1, "gap", "m", 0),
    FIELD(struct bond, n, F64, 3, "normal", "1", 0),
    FIELD(struct bond, slip, F64, 3, "slip", "m", 0),
    { 0 },
};

/* /nsd/memory/NAME [K][width], of each frame that has it `count` rows from `start` on: members of struct recall; with
   features, shifts and moments where contacts have any */
static const struct field layout_memory[] = {
    FIELD(struct recall, a, I32, 2, "body", "1", 0),
    FIELD(struct recall, r, F64, 3, "impulse", "N s", 0),
    { 0 },
};
static const struct field layout_memory_features[] = {
    FIELD(struct recall, feature, I32, 1, "feature", "1", 0),
    { 0 },
};
static const struct field layout_memory_shifts[] = {
    FIELD(struct recall, shift, I8, 3, "shift", "1", 0),
    { 0 },
};
static const struct field layout_memory_moments[] = {
    FIELD(struct recall, m, F64, 3, "moment", "N m s", 0),
    { 0 },
};

/* Of bonds where there are shapes */
static const struct field layout_anchors[] = {
    FIELD(struct bond, area, F64, 1, "area", "m2", 0),
    FIELD(struct bond, at_a, F64, 3, "anchor_a", "m", 0),
    FIELD(struct bond, at_b, F64, 3, "anchor_b", "m", 0),
    FIELD(struct bond, axis, F64, 3, "axis", "1", 0),
    { 0 },
};

/* /contacts/NAME [S][width]: members of struct contact; /contacts/frame, its
   basis, is handled apart */
static const struct field layout_contacts[] = {
    FIELD(struct contact, a, I32, 2, "body", "1", 0),
    FIELD(struct contact, x, F64, 3, "point", "m", 0),
    FIELD(struct contact, gap, F64, 1, "gap", "m", 0),
#define NUMBER(member, name, unit, ...) FIELD(struct contact, member, F64, 1, name, unit, 0),
    EACH_PAIR_COLUMN(NUMBER)
#undef NUMBER
        { 0 },
};

/* The same where the cell repeats */
static const struct field layout_shifts[] = {
    FIELD(struct contact, shift, I8, 3, "shift", "1", 0),
    { 0 },
};

/* The same where there is a mesh */
static const struct field layout_features[] = {
    FIELD(struct contact, feature, I32, 1, "feature", "1", 0),
    { 0 },
};

/* The same where pairs have laws beyond friction and restitution: members of struct contact_law */
static const struct field layout_contact_laws[] = {
    FIELD(struct contact_law, pull, F64, 1, "pull", "N", 0),
    FIELD(struct contact_law, stiff, F64, 2, "stiffness", "N m-1", 0),
    FIELD(struct contact_law, jump, F64, 3, "jump", "m", 0),
    FIELD(struct contact_law, beta, F64, 1, "beta", "1", 0),
    FIELD(struct contact_law, offset, F64, 1, "offset", "m s-1", 0),
    FIELD(struct contact_law, mu_r, F64, 1, "mu_r", "m", 0),
    FIELD(struct contact_law, mu_p, F64, 1, "mu_p", "m", 0),
    FIELD(struct contact_law, state, I8, 1, "tie", "1", 0),
    { 0 },
};

/* /contacts/NAME [S][width] of solved contacts: members of struct found */
static const struct field layout_found[] = {
    FIELD(struct found, r, F64, 3, "reaction", "N s", 0),
    FIELD(struct found, u, F64, 3, "velocity", "m s-1", 0),
    FIELD(struct found, status, I8, 1, "status", "1", 0),
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
static const struct field layout_report[] = {
    FIELD(struct report, err.contacts, I64, 1, "contacts", "1", 0),
    FIELD(struct report, sweeps, I32, 1, "sweeps", "1", 0),
    FIELD(struct report, converged, I8, 1, "converged", "1", 0),
    FIELD(struct report, err.paper, F64, 5, "eps", "1", 0),
    FIELD(struct report, err.scaled, F64, 5, "eps_scaled", "1", 0),
    FIELD(struct report, err.natural, F64, 1, "natural", "1", 0),
    FIELD(struct report, err.natural_siconos, F64, 1, "natural_siconos", "1", 0),
    FIELD(struct report, err.natural_q, F64, 1, "natural_q", "1", 0),
    FIELD(struct report, err.max_penetration, F64, 1, "max_penetration", "m s-1", 0),
    FIELD(struct report, err.max_penetration_true, F64, 1, "max_penetration_true", "m s-1", 0),
    FIELD(struct report, err.max_overlap, F64, 1, "max_overlap", "m", 0),
    FIELD(struct report, newton, I64, 1, "newton", "1", 0),
    FIELD(struct report, safeguarded, I64, 1, "safeguarded", "1", 0),
    FIELD(struct report, gave_up, I64, 1, "gave_up", "1", 0),
    { 0 },
};

/* The same where the criterion is velocity */
static const struct field layout_velocity[] = {
    FIELD(struct report, err.velocity, F64, 1, "velocity", "1", 0),
    FIELD(struct report, err.velocity_error, F64, 1, "velocity_error", "m s-1", 0),
    FIELD(struct report, err.jammed, I64, 1, "jammed", "1", 0),
    { 0 },
};

/* /nsd/flow/NAME/value [F][pours], or [removals]: members of struct passage */
static const struct field layout_poured[] = {
    FIELD(struct flow_count, bodies, I64, 1, "poured", "1", 0),
    FIELD(struct flow_count, mass, F64, 1, "poured_mass", "kg", 0),
    { 0 },
};
static const struct field layout_removed[] = {
    FIELD(struct flow_count, bodies, I64, 1, "removed", "1", 0),
    FIELD(struct flow_count, mass, F64, 1, "removed_mass", "kg", 0),
    { 0 },
};

/* /nsd/flow/events/NAME [E][width]: members of struct event */
static const struct field layout_events[] = {
    FIELD(struct event, step, I64, 1, "step", "1", 0),
    FIELD(struct event, t, F64, 1, "time", "s", 0),
    FIELD(struct event, id, I32, 1, "id", "1", 0),
    FIELD(struct event, came, I8, 1, "came", "1", 0),
    FIELD(struct event, which, I32, 1, "which", "1", 0),
    FIELD(struct event, radius, F64, 1, "radius", "m", 0),
    FIELD(struct event, mass, F64, 1, "mass", "kg", 0),
    FIELD(struct event, x, F64, 3, "position", "m", 0),
    FIELD(struct event, v, F64, 3, "velocity", "m s-1", 0),
    { 0 },
};

/* /observables/solver/NAME/value [F][width] where there are bodies: members of struct report */
static const struct field layout_balance[] = {
    FIELD(struct report, balance.kinetic, F64, 1, "kinetic_energy", "J", 0),
    FIELD(struct report, balance.change, F64, 1, "kinetic_change", "J", 0),
    FIELD(struct report, balance.potential, F64, 1, "potential_energy", "J", 0),
    FIELD(struct report, balance.gravity, F64, 1, "work_gravity", "J", 0),
    FIELD(struct report, balance.drives, F64, 1, "work_drives", "J", 0),
    FIELD(struct report, balance.loads, F64, 1, "work_loads", "J", 0),
    FIELD(struct report, balance.dissipation, F64, 1, "dissipation", "J", 0),
    FIELD(struct report, balance.momentum, F64, 3, "momentum", "N s", 0),
    FIELD(struct report, balance.impulse, F64, 3, "boundary_impulse", "N s", 0),
    { 0 },
};

/* The same where pairs have laws beyond friction and restitution */
static const struct field layout_bond_balance[] = {
    FIELD(struct report, balance.bond_change, F64, 1, "bond_change", "J", 0),
    FIELD(struct report, balance.bond_energy, F64, 1, "bond_energy", "J", 0),
    FIELD(struct report, balance.broken, F64, 1, "broken", "J", 0),
    { 0 },
};

/* The same where impacts may gain energy */
static const struct field layout_gain_balance[] = {
    FIELD(struct report, balance.gained, F64, 1, "impact_gain", "J", 0),
    { 0 },
};

/* The same where the cell moves */
static const struct field layout_peculiar_balance[] = {
    FIELD(struct report, balance.peculiar, F64, 1, "peculiar_energy", "J", 0),
    FIELD(struct report, balance.peculiar_change, F64, 1, "peculiar_change", "J", 0),
    { 0 },
};

/* The same where bodies that overlap are moved apart */
static const struct field layout_projection_balance[] = {
    FIELD(struct report, balance.projection, F64, 1, "projection_work", "J", 0),
    FIELD(struct report, balance.spun, F64, 3, "projection_angular_momentum", "N m s", 0),
    { 0 },
};

#endif
