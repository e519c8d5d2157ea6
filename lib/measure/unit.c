#include "measure/unit.h"

#include "measure/measures.h"

#include <string.h>

const char *measure_unit(const char *name, int dim)
{
    static const char *const plane[][2] = { { "Pa", "N/m" }, { "m2", "m" }, { "m3", "m2" } };
    const char *dot = strchr(name, '.');
    const struct measure *m = dot ? measure_named(name, (size_t)(dot - name)) : NULL;
    for (const struct quantity *q = m ? m->quantity : NULL; q && q->name; q++) {
        size_t n = strlen(q->name);
        if (strncmp(dot + 1, q->name, n) != 0 || (dot[1 + n] && dot[1 + n] != '.')) continue;
        for (int k = 0; dim == 2 && k < 3; k++)
            if (!strcmp(q->unit, plane[k][0])) return plane[k][1];
        return strcmp(q->unit, "1") != 0 ? q->unit : "";
    }
    return "";
}
