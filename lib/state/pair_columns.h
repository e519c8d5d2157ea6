/*
 * state/pair_columns.h: the table of the contact law's parameters, numbers that each pair of materials has. A row makes a symmetric matrix of struct packing, [materials * materials], a key of scenes and a dataset; and
 * of the first table the number of struct contact that is taken from it, and its dataset.
 */
#pragma once

/*
 * X(member, name in documents, unit, key in scenes, upper limit, its range in words); the lower limit is 0
 *
 *   mu      friction
 *   en, et  normal and tangential restitution
 */
#define EACH_PAIR_COLUMN(X)                                                                        \
    X(mu, "mu", "1", "mu", INFINITY, "must not be negative")                                       \
    X(en, "en", "1", "e_n", 1, "must lie in [0, 1]")                                               \
    X(et, "et", "1", "e_t", 1, "must lie in [0, 1]")

/*
 * The same of numbers that only the packing has, 0 where nobody has said otherwise. A document has the dataset where any
 * pair has another number; without it all are 0. Scenes have the first two as numbers, and "acts": false for an inert
 * pair.
 *
 *   mu_s, v_s  static friction, and the sliding speed up to which it is that [contact/contact_law.h]
 *   inert      1: the pair has no contacts; 0
 */
#define STATIC_FRICTION_COLUMNS(X)                                                                 \
    X(mu_s, "mu_s", "1", "mu_s", INFINITY, "must not be negative")                                 \
    X(v_s, "v_s", "m s-1", "v_s", INFINITY, "must not be negative")
#define EACH_OPTIONAL_PAIR_COLUMN(X)                                                               \
    STATIC_FRICTION_COLUMNS(X) X(inert, "inert", "1", "acts", 1, "must lie in [0, 1]")
#define EVERY_PAIR_COLUMN(X) EACH_PAIR_COLUMN(X) EACH_OPTIONAL_PAIR_COLUMN(X)
/* Those whose keys in scenes are numbers */
#define EACH_PAIR_NUMBER(X) EACH_PAIR_COLUMN(X) STATIC_FRICTION_COLUMNS(X)

#define PAIR_POINTER(member, ...)              double *member;
#define PAIR_NUMBER(member, ...)               double member;
#define PAIR_KEY(member, name, unit, key, ...) " " key
