#include "base/renamed.h"

#include <string.h>

static const struct renamed table[] = {
    { "nsd-solve", "global", "solver", true },
    { "nsd-step nsd_set document", "global", "solver", false },
    { "nsd-solve nsd-step nsd_set", "method", "local", false },
    { "nsd-cat nsd-export nsd-info nsd-stat nsd-web", "steps", "frames", false },
    { "nsd-view", "cut", "clip", false },
    { "nsd-view", "boundaries", "walls", true },
    { "surface", "rub", "sliding_work", true },
    { "part", "boundary", "walls", true },
    { "nsd-step", "sums", "wall-loads", true },
    { "nsd-step", "with-boundaries", "with-walls", true },
    { "nsd-detect nsd-solve nsd-step", "overlap", "overlap-rule", true },
    { "nsd_set", "overlap", "overlap-rule", false },
    { "nsd-solve nsd-step", "eps", "tolerance", true },
    { "nsd_set document", "eps", "tolerance", false },
    { "nsd-solve nsd-step nsd_set", "newton-eps", "newton-tolerance", false },
    { "document", "newton_eps", "newton_tolerance", false },
    { "nsd-solve nsd-step nsd_set", "paper", "protocol=paper", false },
    { "scene", "overlap", "allow_overlap", true },
    { "scene", "room", "servo", true },
    { "scene", "kinds", "materials", true },
    { "scene column", "kind", "material", true },
    { "nsd_read", "kind", "material", false },
    { "nsd_read", "boundary_position", "wall_position", false },
    { "nsd_read", "boundary_normal", "wall_normal", false },
    { "nsd_read", "boundary_velocity", "wall_velocity", false },
    { "nsd_read", "boundary_angular_velocity", "wall_angular_velocity", false },
    { "nsd_read", "boundary_force", "wall_force", false },
    { "nsd_read", "boundary_torque", "wall_torque", false },
    { "answer", "boundaries", "walls", true },
    { "measure", "boundaries", "walls", true },
    { "measure", "sums", "wall_loads", true },
    { "measure", "sums_by_name", "wall_loads_by_name", true },
    { "measure", "sums_by_face", "wall_loads_by_face", true },
    { "quantity", "boundary", "wall", true },
    { "quantity", "rub", "sliding_work", true },
};
enum { RENAMED = sizeof table / sizeof table[0] };

static const struct {
    const char *in, *was, *cure;
} gone[] = {
    { "nsd-step nsd_set", "substeps", "small steps, the default, find what fast bodies meet" },
};

const char *gone_find(const char *in, const char *was, size_t n)
{
    for (size_t k = 0; k < sizeof gone / sizeof gone[0]; k++)
        if (words_have(gone[k].in, in, strlen(in)) && words_have(gone[k].was, was, n))
            return gone[k].cure;
    return NULL;
}

bool words_have(const char *words, const char *word, size_t n)
{
    for (const char *s = words; s && *s; s += strcspn(s, " ")) {
        s += strspn(s, " ");
        if (strcspn(s, " ") == n && !memcmp(s, word, n)) return true;
    }
    return false;
}

const struct renamed *renamed_at(int k)
{
    return k < RENAMED ? &table[k] : NULL;
}

const struct renamed *renamed_find(const char *in, const char *was, size_t n)
{
    for (int k = 0; k < RENAMED; k++)
        if (words_have(table[k].in, in, strlen(in)) && words_have(table[k].was, was, n))
            return &table[k];
    return NULL;
}
