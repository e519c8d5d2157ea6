#include "convert/format.h"

#include <string.h>

/* NULL ends it; the first is that of a directory. */
static const struct format *const formats[] = {
    &format_vtp, &format_vtu, &format_xyz,         &format_lammps, &format_csv, &format_tsv,
    &format_stl, &format_gsd, &format_lammps_data, &format_ondem,  NULL,
};

const struct format *format_at(int k)
{
    return formats[k];
}

const struct format *format_of_name(const char *name)
{
    size_t n = strlen(name);
    for (int k = 0; format_at(k); k++) {
        size_t m = strlen(format_at(k)->ending);
        if (n > m && name[n - m - 1] == '.' && !strcmp(name + n - m, format_at(k)->ending))
            return format_at(k);
    }
    return NULL;
}
