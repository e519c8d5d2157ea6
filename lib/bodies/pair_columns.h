/*
 * bodies/pair_columns.h: the table of the contact law's parameters, numbers that each pair of kinds of
 * material has. A row makes a symmetric matrix of struct packing, [kinds * kinds], the number of struct
 * contact that is taken from it, a key of scenes, and the datasets of both.
 */
#ifndef NSD_PAIR_COLUMNS_H
#define NSD_PAIR_COLUMNS_H

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

#define PAIR_POINTER(member, ...)              double *member;
#define PAIR_NUMBER(member, ...)               double member;
#define PAIR_KEY(member, name, unit, key, ...) " " key

#endif
