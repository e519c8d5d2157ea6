#include "convert/pvd.h"

#include <errno.h>
#include <string.h>

static const char head[] =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n"
    "<Collection>\n";
static const char tail[] = "</Collection>\n</VTKFile>\n";

int pvd_begin(struct pvd *l, const char *path, struct failure *failure)
{
    l->out = output_stream(&l->file, path, failure);
    if (!l->out) return failure->status;
    fprintf(l->out, "%s%s", head, tail);
    return 0;
}

int pvd_add(struct pvd *l, const char *name, double time, struct failure *failure)
{
    if (fseek(l->out, -(long)strlen(tail), SEEK_END))
        return failure_set(failure, EX_IOERR, "%s.pvd: %s", name, strerror(errno));
    fprintf(l->out, "<DataSet timestep=\"%.17g\" part=\"0\" file=\"%s\"/>\n%s", time, name, tail);
    if (fflush(l->out)) return failure_set(failure, EX_IOERR, "%s: its list: %s", name, strerror(errno));
    return output_place(&l->file, failure); // there is something whole in it, with the first
}

int pvd_end(struct pvd *l, struct failure *failure)
{
    if (l->out) output_stream_close(&l->file, l->out, failure);
    l->out = NULL;
    return failure->status;
}
