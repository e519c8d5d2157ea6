/* scene/scene_paper.c: the paper's examples 2 and 3, and heaps of their proportions. */
#include "scene/scene.h"

#include <stdio.h>

int scene_paper(struct scene *s, int dim, int64_t n, struct failure *failure)
{
    char text[1000], y[64] = "";
    bool two = n == 4;
    double share = (double)n / 500;
    double columns = dim == 2 ? 25 * sqrt(share) : 6 * cbrt(share);
    double half = two ? 0.8e-3 : 0.525e-3 * fmax(1, round(columns)); // m, of the box
    if (dim == 3) snprintf(y, sizeof y, "\"y\": [-%.10g, %.10g], ", half, half);
    int length =
        snprintf(text, sizeof text,
                 "{ \"title\": \"Sedimentation of %lld %s%s\",\n"
                 "  \"comment\": \"The paper gives radii, mu and dt. The rest is ours.\",\n"
                 "  \"dim\": %d, \"dt\": %s, \"seed\": %d, \"gravity\": %s,\n"
                 "  \"density\": 2500, \"mu\": 0.3, \"e_n\": 0, \"e_t\": 0,\n"
                 "  \"bodies\": [{ \"count\": %lld, \"radius\": { \"uniform\": [%s, 5e-4] } }],\n"
                 "  \"walls\": [{ \"box\": { \"x\": [-%.10g, %.10g], %s\"%c\": [0, null] } }] }\n",
                 (long long)n, dim == 2 ? "disc" : "ball", n == 1 ? "" : "s", dim,
                 two ? "1e-4" : "5e-5", two ? 9 : 1, dim == 2 ? "[0, -9.81]" : "[0, 0, -9.81]",
                 (long long)n, two ? "4e-4" : "2.5e-4", half, half, y, dim == 2 ? 'y' : 'z');
    return scene_parse(s, text, (size_t)length, NULL, failure);
}
