#include "io/copy.h"

#include "io/h5.h"

#include <stdio.h>
#include <string.h>

struct copy {
    hid_t to;          /* -1: nothing is copied, only looked for */
    const char *group; /* where in `to` */
    const char *const *known;
    bool whole; /* the origin has one frame: what depends on time is copied too */
    bool plain; /* no checksum vouches for the origin: not by H5Ocopy */
    int depth;
    struct why *why;
};

static herr_t copy_link(hid_t from, const char *name, const H5L_info_t *info, void *data);

/* Copies a group, level by level, or a dataset: numbers and texts only. */
static herr_t copy_plain(struct copy *c, hid_t from, const char *name, const char *path)
{
    static const char *const none[] = { NULL };
    H5O_info_t info;
    if (H5Oget_info_by_name2(from, name, &info, H5O_INFO_BASIC, H5P_DEFAULT) < 0) return -1;
    if (info.type == H5O_TYPE_DATASET)
        return h5_copy_plain(from, name, c->to, path, c->why) ? -1 : 0;
    if (info.type != H5O_TYPE_GROUP || c->depth > 8) return 0; // a group in itself
    struct copy in = { c->to, path, none, c->whole, true, c->depth + 1, c->why };
    if (h5_group(c->to, path, c->why)) return -1;
    hid_t group = H5Gopen2(from, name, H5P_DEFAULT);
    herr_t e = group < 0 ? -1 : H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, NULL, copy_link, &in);
    if (group >= 0) H5Gclose(group);
    return e;
}

static herr_t copy_link(hid_t from, const char *name, const H5L_info_t *info, void *data)
{
    struct copy *c = data;
    char path[400];
    (void)info;
    for (const char *const *k = c->known; *k; k++)
        if (!strcmp(*k, name)) return 0;
    snprintf(path, sizeof path, "%s/%s", name, "step");
    if (!c->whole && h5_has(from, path)) return 0;
    if (c->to < 0) return 1;
    snprintf(path, sizeof path, "%s%s%s", c->group, c->group[1] ? "/" : "", name);
    if (h5_has(c->to, path)) return 0;
    herr_t e;
    if (c->plain) {
        e = copy_plain(c, from, name, path);
    } else {
        hid_t link = H5Pcreate(H5P_LINK_CREATE);
        H5Pset_create_intermediate_group(link, 1);
        e = H5Ocopy(from, name, c->to, path, H5P_DEFAULT, link);
        H5Pclose(link);
    }
    return e < 0 ? why_set(c->why, EX_DATAERR, "%s: cannot be copied", path), -1 : 0;
}

/* Copies what is unknown; with to < 0, returns 1 where there is something. */
static int visit(hid_t to, const struct frame *f, struct why *why)
{
    static const char *const root[] = { "h5md",     "nsd",         "particles", "walls",
                                        "contacts", "observables", "solution",  NULL };
    static const char *const exported[] = { "h5md",     "nsd",         "particles",
                                            "walls",    "contacts",    "observables",
                                            "solution", "fclib_local", "fclib_global",
                                            NULL };
    static const char *const all[] = { "box",         "position", "velocity", "angular_velocity",
                                       "orientation", "radius",   "mass",     "inertia",
                                       "id",          "species",  NULL };
    static const char *const particles[] = { "all", NULL }, *const walls[] = { "plane", NULL };
    static const char *const observables[] = { "solver", NULL };
    static const char *const nsd[] = { "history", "scene", "material", NULL };
    const struct {
        const char *group;
        const char *const *known;
    } where[] = { { "/", f->stale ? exported : root }, { "/particles", particles },
                  { "/particles/all", all },           { "/walls", walls },
                  { "/observables", observables },     { "/nsd", nsd } };
    hsize_t shape[4] = { 1 };
    if (!f->origin) return 0;
    h5_shape(f->origin, "/particles/all/position/step", shape);
    for (size_t i = 0; i < sizeof where / sizeof where[0]; i++) {
        if (!h5_has(f->origin, where[i].group)) continue;
        struct copy c = { to, where[i].group, where[i].known, shape[0] <= 1, f->unchecked, 0, why };
        // a foreign document is its problem
        if (f->foreign && i == 0) c.known = root;
        hid_t group = H5Gopen2(f->origin, where[i].group, H5P_DEFAULT);
        herr_t found = H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, NULL, copy_link, &c);
        H5Gclose(group);
        if (why->status || found > 0) return found > 0;
    }
    return 0;
}

int copy_unknown(int64_t file, const struct frame *f, struct why *why)
{
    visit(file, f, why);
    return why->status;
}

bool copy_wanted(const struct frame *f)
{
    struct why why = { 0 };
    return visit(-1, f, &why) || why.status;
}
