/*
 * problem/kind.h: the kinds of a contact problem, a table.
 *
 * A kind says what a problem's contacts have in memory, and so which code fills, reads, solves, pushes, judges and
 * mixes them. It is chosen once, when the problem is prepared [problem/problem.h: kind]. A kernel that is compiled
 * for one kind names its row, whose entries are then constants of the compiler.
 *
 * Another kind is a row here, a function in problem/fill.c that sets a slot's numbers, and a kernel in
 * problem/sweep.c; an array that only it has is a line in EACH_ARRAY and a member of struct problem.
 */
#ifndef NSD_KIND_H
#define NSD_KIND_H

#include <stdbool.h>

/* The members of struct problem that have one element per bundle */
#define EACH_ARRAY(X)                                                                              \
    X(bundle)                                                                                      \
    X(w)                                                                                           \
    X(rho)                                                                                         \
    X(u)                                                                                           \
    X(block)                                                                                       \
    X(lever)                                                                                       \
    X(beyond)                                                                                      \
    X(turn)                                                                                        \
    X(rebound)

#define ARRAY_NUMBER(name) ARRAY_##name,
#define ARRAY_BIT(name)    HAS_##name = 1 << ARRAY_##name,
enum array { EACH_ARRAY(ARRAY_NUMBER) ARRAYS };
enum { EACH_ARRAY(ARRAY_BIT) HAS_COMMON = HAS_bundle | HAS_w | HAS_rho | HAS_u };

enum problem_kind_id {
    KIND_FAR_BALLS,
    KIND_BALLS,
    KIND_BONDS,
    KIND_MOMENTS,
    KIND_LEVERS,
    KIND_LEVERS_BONDS,
    KIND_LEVERS_MOMENTS,
    KIND_BLOCKS,
    KIND_DIAGONALS,
    PROBLEM_KINDS
};

struct slot_filling;
typedef void fill_text(const struct slot_filling *f);
fill_text fill_ball, fill_bond, fill_lever, fill_lever_bond; /* [problem/fill.h] */

struct problem_kind {
    const char *name;
    enum problem_kind_id id,
        plain;       /* plain: the kind of the same contacts without bonds and moments */
    unsigned arrays; /* HAS_... */
    bool given_by_W; /* there are no bodies, only W */
    bool full;       /* W~_cc is more than diag(w_n, w_t, w_t) */
    bool levers;     /* lever arms are any vectors [problem/levers.h] */
    bool near;       /* bundles have a struct beside behind them */
    bool beyond;     /* contacts have bonds or moments [problem/beyond.h] */
    bool rolls;      /* some contact has rolling friction */
    double ns;       /* of a sweep, per contact [bench/results]; of W, see solve/prices.c besides */
    fill_text *fill; /* sets the numbers of a slot; NULL: problem_of_W.c does */
};

static const struct problem_kind problem_kinds[PROBLEM_KINDS] = {
    { "many balls", KIND_FAR_BALLS, KIND_FAR_BALLS, HAS_COMMON, .ns = 10, .fill = fill_ball },
    { "balls", KIND_BALLS, KIND_BALLS, HAS_COMMON, .near = true, .ns = 10, .fill = fill_ball },
    { "balls with bonds", KIND_BONDS, KIND_BALLS, HAS_COMMON | HAS_beyond, .near = true,
      .beyond = true, .ns = 45, .fill = fill_bond },
    { "balls with rolling friction", KIND_MOMENTS, KIND_BALLS, HAS_COMMON | HAS_beyond,
      .near = true, .beyond = true, .rolls = true, .ns = 115, .fill = fill_bond },
    { "shapes", KIND_LEVERS, KIND_LEVERS, HAS_COMMON | HAS_block | HAS_lever, .full = true,
      .levers = true, .near = true, .ns = 70, .fill = fill_lever },
    { "shapes with bonds", KIND_LEVERS_BONDS, KIND_LEVERS,
      HAS_COMMON | HAS_block | HAS_lever | HAS_beyond | HAS_turn, .full = true, .levers = true,
      .near = true, .beyond = true, .ns = 110, .fill = fill_lever_bond },
    { "shapes with rolling friction", KIND_LEVERS_MOMENTS, KIND_LEVERS,
      HAS_COMMON | HAS_block | HAS_lever | HAS_beyond | HAS_turn, .full = true, .levers = true,
      .near = true, .beyond = true, .rolls = true, .ns = 1100, .fill = fill_lever_bond },
    { "given W", KIND_BLOCKS, KIND_BLOCKS, HAS_COMMON | HAS_block, .given_by_W = true, .full = true,
      .ns = 30 },
    { "given W, diagonal W_cc", KIND_DIAGONALS, KIND_DIAGONALS, HAS_COMMON | HAS_block,
      .given_by_W = true, .ns = 30 },
};

/* The kind of the contacts between bodies */
static inline const struct problem_kind *kind_of_bodies(bool levers, bool bonds, bool rolls,
                                                        bool near)
{
    enum problem_kind_id plain = levers ? KIND_LEVERS : near ? KIND_BALLS : KIND_FAR_BALLS;
    enum problem_kind_id bonded = levers ? KIND_LEVERS_BONDS : KIND_BONDS;
    enum problem_kind_id rolling = levers ? KIND_LEVERS_MOMENTS : KIND_MOMENTS;
    return &problem_kinds[rolls ? rolling : bonds ? bonded : plain];
}

#endif
