/* convert/ondem.c: ON-DEM's exchange format [convert/ondem_write.h]: grains, planes across an axis, contacts; one frame. */
#include "convert/format.h"
#include "convert/ondem_write.h"

#include <stdlib.h>

static int write_ondem(FILE *out, const struct export_frame *m, enum part part, bool first,
                       struct failure *failure)
{
    size_t size = 0;
    (void)part, (void)first;
    if (m->packing->dim == 2) // which would come back as balls
        return failure_set(failure, EX_DATAERR, "discs: ON-DEM's format is for 3D; --to gsd writes discs");
    void *bytes = ondem_write(m->packing, m->contacts, &size, failure);
    if (!bytes) return failure->status;
    fwrite(bytes, 1, size, out);
    free(bytes);
    return 0;
}

const struct format format_ondem = {
    .name = "ondem",
    .ending = "vtkhdf",
    .help = "ON-DEM exchange format, for other DEM programs and ParaView",
    .binary = true,
    .write = write_ondem,
};
