/*
 * solve/kind.h: the kinds of a contact problem, a table.
 *
 * A kind says what a problem's contacts have in memory, and so which code fills, reads, solves, pushes, judges and
 * mixes them. It is chosen once, when the problem is prepared [solve/problem.h: kind]. A kernel that is compiled
 * for one kind names its row, whose entries are then constants of the compiler.
 *
 * Another kind is a row of EACH_KIND, a function in solve/fill.c that sets a slot's numbers, and a kernel in
 * solve/sweep.c; an array that only it has is a line in EACH_ARRAY and a member of struct problem.
 */
#pragma once

#include <stdbool.h>

/* The members of struct problem that have one element per bundle */
#define EACH_ARRAY(X)                                                                              \
    X(bundle)                                                                                      \
    X(w)                                                                                           \
    X(rho)                                                                                         \
    X(u)                                                                                           \
    X(block)                                                                                       \
    X(lever)                                                                                       \
    X(extra)                                                                                       \
    X(turn)                                                                                        \
    X(rebound)

#define ARRAY_NUMBER(name) ARRAY_##name,
#define ARRAY_BIT(name)    HAS_##name = 1 << ARRAY_##name,
enum array { EACH_ARRAY(ARRAY_NUMBER) ARRAYS };
enum { EACH_ARRAY(ARRAY_BIT) HAS_COMMON = HAS_bundle | HAS_w | HAS_rho | HAS_u };

/*
 * The rows: name of the kind, of the kind of the same contacts without bonds and moments, in words, arrays, and
 * what else is not zero. Each is a constant of its own too, kind_BALLS etc., for a compiler folds its members.
 */
#define EACH_KIND(ROW)                                                                             \
    ROW(FAR_BALLS, FAR_BALLS, "many balls", HAS_COMMON, .ns = 10, .fill = fill_ball)               \
    ROW(BALLS, BALLS, "balls", HAS_COMMON, .near = true, .ns = 10, .fill = fill_ball)              \
    ROW(BONDS, BALLS, "balls with bonds", HAS_COMMON | HAS_extra, .near = true, .extra = true,     \
        .ns = 45, .fill = fill_bond)                                                               \
    ROW(MOMENTS, BALLS, "balls with rolling friction", HAS_COMMON | HAS_extra, .near = true,       \
        .extra = true, .rolls = true, .ns = 115, .fill = fill_bond)                                \
    ROW(LEVERS, LEVERS, "shapes", HAS_COMMON | HAS_block | HAS_lever, .full = true,                \
        .levers = true, .near = true, .ns = 70, .fill = fill_lever)                                \
    ROW(LEVERS_BONDS, LEVERS, "shapes with bonds",                                                 \
        HAS_COMMON | HAS_block | HAS_lever | HAS_extra | HAS_turn, .full = true, .levers = true,   \
        .near = true, .extra = true, .ns = 110, .fill = fill_lever_bond)                           \
    ROW(LEVERS_MOMENTS, LEVERS, "shapes with rolling friction",                                    \
        HAS_COMMON | HAS_block | HAS_lever | HAS_extra | HAS_turn, .full = true, .levers = true,   \
        .near = true, .extra = true, .rolls = true, .ns = 1100, .fill = fill_lever_bond)           \
    ROW(BLOCKS, BLOCKS, "given W", HAS_COMMON | HAS_block, .given_by_W = true, .full = true,       \
        .ns = 30)                                                                                  \
    ROW(DIAGONALS, DIAGONALS, "given W, diagonal W_cc", HAS_COMMON | HAS_block,                    \
        .given_by_W = true, .ns = 30)

#define KIND_NUMBER(id, ...) KIND_##id,
enum problem_kind_id { EACH_KIND(KIND_NUMBER) PROBLEM_KINDS };

struct slot_filling;
typedef void fill_text(const struct slot_filling *f);
fill_text fill_ball, fill_bond, fill_lever, fill_lever_bond; /* [solve/fill.h] */

struct problem_kind {
    enum problem_kind_id id, plain;
    const char *name;
    unsigned arrays; /* HAS_... */
    bool given_by_W; /* there are no bodies, only W */
    bool full;       /* W~_cc is more than diag(w_n, w_t, w_t) */
    bool levers;     /* lever arms are any vectors [solve/bundle.h] */
    bool near;       /* bundles have a struct beside after them */
    bool extra;      /* contacts have bonds or moments [solve/extra.h] */
    bool rolls;      /* some contact has rolling friction */
    bool soft;       /* some contact has a stiffness: said of a problem, not of a row */
    double ns;       /* of a sweep, per contact [bench/results]; of W, see solve/solver.c besides */
    fill_text *fill; /* sets the numbers of a slot; NULL: problem_of_W.c does */
};

#define KIND_ROW(id, plain, ...)                                                                   \
    static const struct problem_kind kind_##id = { KIND_##id, KIND_##plain, __VA_ARGS__ };
EACH_KIND(KIND_ROW)

#define KIND_AT(id, ...) &kind_##id,
static const struct problem_kind *const problem_kinds[PROBLEM_KINDS] = { EACH_KIND(KIND_AT) };

/* The kind of the contacts between bodies */
static inline const struct problem_kind *kind_of_bodies(bool levers, bool bonds, bool rolls,
                                                        bool near)
{
    enum problem_kind_id plain = levers ? KIND_LEVERS : near ? KIND_BALLS : KIND_FAR_BALLS;
    enum problem_kind_id bonded = levers ? KIND_LEVERS_BONDS : KIND_BONDS;
    enum problem_kind_id rolling = levers ? KIND_LEVERS_MOMENTS : KIND_MOMENTS;
    return problem_kinds[rolls ? rolling : bonds ? bonded : plain];
}
