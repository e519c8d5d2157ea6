/* Scenes: JSON text as nsd-gen gets it; what is not large is built. */
#include "fuzz.h"
#include "scene/scene_build.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct scene scene;
    struct packing packing = { 0 };
    struct failure failure = { 0 };
    char *text = malloc(size + 1); // the parser gets no byte behind its text
    if (!text) abort();
    memcpy(text, data, size);
    int e = scene_parse(&scene, text, size, NULL, &failure);
    free(text);
    if (e) {
        if (!failure.status || !failure.text[0] || strchr(failure.text, '\n')) abort();
        return 0;
    }
    int64_t bodies = 0;
    bool table = false;
    for (int64_t g = 0; g < scene.groups; g++) {
        bodies += scene.bodies[g].count < 1000 ? scene.bodies[g].count : 1000;
        table |= scene.bodies[g].from == SCENE_TABLE;
    }
    if (bodies < 1000 && !table && !scene_build(&packing, &scene, NULL, &failure) &&
        packing_check(&packing, &(struct failure){ 0 }))
        abort(); // what is built is what a reader takes
    packing_free(&packing);
    scene_free(&scene);
    return 0;
}
