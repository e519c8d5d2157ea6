#include "export/pvd.h"

#include <errno.h>
#include <string.h>

static const char head[] =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n"
    "<Collection>\n";
static const char tail[] = "</Collection>\n</VTKFile>\n";

int pvd_begin(struct pvd *l, const char *path, struct why *why)
{
    l->out = output_stream(&l->file, path, why);
    if (!l->out) return why->status;
    fprintf(l->out, "%s%s", head, tail);
    return 0;
}

int pvd_add(struct pvd *l, const char *name, double time, struct why *why)
{
    if (fseek(l->out, -(long)strlen(tail), SEEK_END))
        return why_set(why, EX_IOERR, "%s.pvd: %s", name, strerror(errno));
    fprintf(l->out, "<DataSet timestep=\"%.17g\" part=\"0\" file=\"%s\"/>\n%s", time, name, tail);
    if (fflush(l->out)) return why_set(why, EX_IOERR, "%s: its list: %s", name, strerror(errno));
    return output_place(&l->file, why); // there is something whole in it, with the first
}

int pvd_end(struct pvd *l, struct why *why)
{
    if (l->out) output_stream_close(&l->file, l->out, why);
    l->out = NULL;
    return why->status;
}
