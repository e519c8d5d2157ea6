/* scene/mesh_file.c: meshes by libassimp [scene/mesh_file.h]. */
#include "scene/mesh_file.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What is called of libassimp: found when it is loaded */
static struct {
    const struct aiScene *(*import)(const char *path, unsigned flags);
    void (*release)(const struct aiScene *file);
    const char *(*error)(void);
    void (*identity)(struct aiMatrix4x4 *m);
    void (*multiply)(struct aiMatrix4x4 *m, const struct aiMatrix4x4 *by);
} assimp;

/* Our own functions have the types of its headers: see to it that they are the same. */
#define FIND(member, name)                                                                         \
    do {                                                                                           \
        assimp.member = 0 ? (name) : NULL;                                                         \
        *(void **)&assimp.member = dlsym(library, #name);                                          \
        missing |= !assimp.member;                                                                 \
    } while (0)

/* Never closed: a process reads its files at once, and ends. */
static int load(struct why *why)
{
    bool missing = false;
    if (assimp.import) return 0;
    void *library = dlopen("libassimp.so.5", RTLD_NOW); // the one of the headers in use
    if (!library) library = dlopen("libassimp.so", RTLD_NOW);
    if (!library) return why_set(why, EX_SOFTWARE, "meshes are read by libassimp: %s", dlerror());
    FIND(import, aiImportFile);
    FIND(release, aiReleaseImport);
    FIND(error, aiGetErrorString);
    FIND(identity, aiIdentityMatrix4);
    FIND(multiply, aiMultiplyMatrix4);
    return missing ? why_set(why, EX_SOFTWARE, "meshes are read by libassimp: not this one") : 0;
}

static vec3 vertex_of(const struct aiVector3D *v, const struct aiMatrix4x4 *m, double scale)
{
    const double x = (double)v->x, y = (double)v->y, z = (double)v->z;
    return v3_scale(scale,
                    v3((double)m->a1 * x + (double)m->a2 * y + (double)m->a3 * z + (double)m->a4,
                       (double)m->b1 * x + (double)m->b2 * y + (double)m->b3 * z + (double)m->b4,
                       (double)m->c1 * x + (double)m->c2 * y + (double)m->c3 * z + (double)m->c4));
}

/* What is gathered from a file's tree of nodes */
struct gather {
    const struct aiScene *file;
    struct mesh *mesh;
    double scale;
    struct why *why;
};

static int add_mesh(const struct gather *g, const struct aiMesh *m, const struct aiMatrix4x4 *at)
{
    vec3 *vertex;
    int32_t(*element)[3], first = g->mesh->vertices, n = 0;
    if (m->mNumVertices > 1 << 28 || m->mNumFaces > 1 << 28)
        return why_set(g->why, EX_DATAERR, "more triangles than a mesh may have");
    if (mesh_grow(g->mesh, (int32_t)m->mNumVertices, (int32_t)m->mNumFaces, &vertex, &element,
                  g->why))
        return g->why->status;
    for (unsigned i = 0; i < m->mNumVertices; i++)
        vertex[i] = vertex_of(&m->mVertices[i], at, g->scale);
    for (unsigned i = 0; i < m->mNumFaces; i++) {
        const struct aiFace *f = &m->mFaces[i];
        if (f->mNumIndices != 3) continue; // points and lines
        const unsigned *v = f->mIndices;
        if (v[0] >= m->mNumVertices || v[1] >= m->mNumVertices || v[2] >= m->mNumVertices)
            return why_set(g->why, EX_DATAERR, "a triangle of vertices that are not there");
        vec3 a = v3_sub(vertex[v[1]], vertex[v[0]]), b = v3_sub(vertex[v[2]], vertex[v[0]]);
        if (!(v3_norm(v3_cross(a, b)) > 0)) continue;
        for (int k = 0; k < 3; k++) element[n][k] = first + (int32_t)v[k];
        n++;
    }
    g->mesh->elements -= (int32_t)m->mNumFaces - n;
    return 0;
}

static struct aiMatrix4x4 product(const struct aiMatrix4x4 *a, const struct aiMatrix4x4 *b)
{
    struct aiMatrix4x4 c = *a;
    assimp.multiply(&c, b);
    return c;
}

static int add_node(const struct gather *g, const struct aiNode *node, const struct aiMatrix4x4 *up)
{
    struct aiMatrix4x4 at = product(up, &node->mTransformation);
    for (unsigned k = 0; k < node->mNumMeshes; k++)
        if (node->mMeshes[k] < g->file->mNumMeshes &&
            add_mesh(g, g->file->mMeshes[node->mMeshes[k]], &at))
            return 1;
    for (unsigned k = 0; k < node->mNumChildren; k++)
        if (add_node(g, node->mChildren[k], &at)) return 1;
    return 0;
}

static int read_path(struct mesh *to, const char *path, double scale, struct why *why)
{
    if (access(path, R_OK)) return why_set(why, EX_NOINPUT, "%s: cannot be read", path);
    if (load(why)) return why->status;
    const struct aiScene *file = assimp.import(path, aiProcess_Triangulate);
    if (!file || !file->mRootNode) {
        why_set(why, EX_DATAERR, "%s: %s", path, assimp.error());
        assimp.release(file);
        return why->status;
    }
    struct aiMatrix4x4 one;
    assimp.identity(&one);
    const struct gather g = { file, to, scale, why };
    int32_t before = to->elements;
    add_node(&g, file->mRootNode, &one);
    assimp.release(file);
    if (why->status) return why->status;
    return to->elements > before ? 0 : why_set(why, EX_DATAERR, "%s: no triangles", path);
}

int mesh_file_read(struct mesh *to, const char *dir, const char *name, double scale,
                   struct why *why)
{
    char *path = scene_path(dir, name);
    if (!path) return why_set(why, EX_SOFTWARE, "no memory for a name");
    read_path(to, path, scale, why);
    free(path);
    return why->status;
}

int mesh_files_read(struct scene *s, const char *dir, struct why *why)
{
    for (int32_t k = 0; k < s->meshes && !why->status; k++) {
        const struct scene_mesh *m = &s->mesh_file[k];
        struct wall *w = &s->wall[m->wall];
        w->first_element = s->mesh.elements;
        if (mesh_file_read(&s->mesh, dir, m->file, m->scale, why)) return why->status;
        w->elements = s->mesh.elements - w->first_element;
    }
    return 0;
}
