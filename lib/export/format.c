#include "export/format.h"

#include <string.h>

static const struct format *const formats[] = {
    &format_vtp, &format_vtu, &format_xyz, &format_lammps, &format_csv, &format_tsv, &format_stl,
};

const struct format *format_at(int k)
{
    int count = sizeof formats / sizeof *formats;
    return k >= 0 && k < count ? formats[k] : NULL;
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
