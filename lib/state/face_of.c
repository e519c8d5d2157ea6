#include "state/face_of.h"

#include "shape/mesh.h"

int face_of_init(struct wall_faces *f, const struct packing *p, bool meshes,
                 struct failure *failure)
{
    return wall_faces_init(f, p->walls, p->wall, meshes ? &p->mesh : NULL, failure);
}

int32_t face_of_contact(const struct wall_faces *f, const struct packing *p,
                        const struct contact *c, double ahead)
{
    int32_t w = -1 - c->a, best = 0;
    const struct wall *wall = &p->wall[w];
    struct touch touch[TOUCHES_MOST];
    if (!f->surface || wall->shape != WALL_MESH) return 0;
    // the contact's point is in the middle of what gap or overlap there is
    struct pose pose = wall_pose(p, wall, p->t + ahead);
    vec3 x = v3_sub(quat_turn_back(pose.q, v3_sub(c->x, pose.shift)), wall->x);
    double reach = fabs(c->gap) + 1e-3 * p->radius[c->b];
    int n = 0;
    for (int k = 0; k < 8 && !n; k++, reach *= 4)
        n = surface_touches(&f->surface[w], x, reach, touch);
    for (int k = 1; k < n; k++)
        if (fabs(touch[k].distance) < fabs(touch[best].distance)) best = k;
    return n ? touch[best].feature / SURFACE_FEATURES : 0;
}

double face_of_area(const struct packing *p, int32_t wall, int32_t face)
{
    const struct wall *w = &p->wall[wall];
    const double *s = w->size;
    double angle = w->arc > 0 ? w->arc : 2 * M_PI;
    bool flat = p->dim == 2;
    switch (w->shape) {
    case WALL_RECTANGLE:
        return flat ? s[0] : s[0] * s[1];
    case WALL_DISC:
        return M_PI * (s[1] * s[1] - s[0] * s[0]);
    case WALL_CYLINDER:
        if (flat) return angle * s[0];
        return s[2] > 0 ? angle * s[0] * s[2] : INFINITY;
    case WALL_CONE:
        return 0.5 * angle * (s[0] + s[1]) * hypot(s[2], s[1] - s[0]);
    case WALL_SPHERE:
        return 4 * M_PI * s[0] * s[0];
    case WALL_MESH: {
        const int32_t *e = p->mesh.element[w->first_element + face];
        vec3 a = v3_sub(p->mesh.vertex[e[1]], p->mesh.vertex[e[0]]);
        if (flat) return v3_norm(a);
        return 0.5 * v3_norm(v3_cross(a, v3_sub(p->mesh.vertex[e[2]], p->mesh.vertex[e[0]])));
    }
    case WALL_PLANE: {
        const double area = wall_face(p, w, p->t);
        return area > 0 ? area : INFINITY;
    }
    default:
        return INFINITY;
    }
}
