#include "file/element.h"

#include <stdlib.h>
#include <string.h>

enum {
    MOST_TEXT = 1 << 28, /* bytes of a string */
    MOST_LINES = 4096,   /* strings of a list, */
    MOST_LINE = 4096     /* and bytes of each */
};

void element_describe(hid_t disk, struct object *o)
{
    H5T_class_t class = H5Tget_class(disk);
    size_t size = H5Tget_size(disk);
    bool power = size == 1 || size == 2 || size == 4 || size == 8;
    o->kind = OBJECT_OTHER, o->class = 0, o->size = (uint32_t)size;
    if ((class == H5T_INTEGER || class == H5T_ENUM) && power) {
        hid_t base = class == H5T_ENUM ? H5Tget_super(disk) : -1;
        o->class = H5Tget_sign(base < 0 ? disk : base) == H5T_SGN_NONE ? 'u' : 'i';
        o->kind = OBJECT_NUMBERS;
        if (base >= 0) H5Tclose(base);
    } else if (class == H5T_FLOAT && size >= 2 && size <= 16) {
        o->kind = OBJECT_NUMBERS, o->class = 'f';
        o->size = size == 4 ? 4 : 8;
    } else if (class == H5T_STRING) {
        bool variable = H5Tis_variable_str(disk) > 0;
        o->kind = size && (variable || size <= MOST_TEXT) ? OBJECT_TEXT : OBJECT_OTHER;
        o->class = 's';
        if (variable) o->size = 0;
    }
}

bool element_suits(const struct object *o, enum column_type want)
{
    if (o->kind != OBJECT_NUMBERS) return false;
    return want == COLUMN_F64 || o->class != 'f';
}

const char *element_wanted(enum column_type type)
{
    return type == COLUMN_F64 ? "numbers" : "integers";
}

/* An integer that does not fit the type wanted fails the read instead of becoming another. */
static H5T_conv_ret_t overflow(H5T_conv_except_t what, hid_t from, hid_t to, void *in, void *out,
                               void *data)
{
    (void)from, (void)to, (void)in, (void)out, (void)data;
    return what == H5T_CONV_EXCEPT_RANGE_HI || what == H5T_CONV_EXCEPT_RANGE_LOW
               ? H5T_CONV_ABORT
               : H5T_CONV_UNHANDLED;
}

hid_t element_transfer(void)
{
    static hid_t plist = -1;
    if (plist < 0) {
        plist = H5Pcreate(H5P_DATASET_XFER);
        H5Pset_type_conv_cb(plist, overflow, NULL);
    }
    return plist;
}

hid_t element_type(const struct object *o)
{
    if (o->class != 's') return h5_plain(o->class, o->size);
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, o->size);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

char *element_text(hid_t set, hid_t attr, size_t *length, bool *no_memory)
{
    hid_t disk = set >= 0 ? H5Dget_type(set) : H5Aget_type(attr);
    hid_t space = set >= 0 ? H5Dget_space(set) : H5Aget_space(attr);
    char *out = NULL, *text = NULL;
    bool single = H5Tget_class(disk) == H5T_STRING && H5Sget_simple_extent_npoints(space) == 1;
    if (single && H5Tis_variable_str(disk) > 0) {
        hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, H5T_VARIABLE);
        H5Tset_cset(type, H5Tget_cset(disk));
        herr_t e = set >= 0 ? H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &text)
                            : H5Aread(attr, type, &text);
        if (e >= 0) *no_memory = !(out = strdup(text ? text : ""));
        H5free_memory(text);
        H5Tclose(type);
    } else if (single) {
        *no_memory = !(out = calloc(H5Tget_size(disk) + 1, 1));
        herr_t e = !out       ? 0
                   : set >= 0 ? H5Dread(set, disk, H5S_ALL, H5S_ALL, H5P_DEFAULT, out)
                              : H5Aread(attr, disk, out);
        if (e < 0) free(out), out = NULL;
    }
    if (out) *length = strlen(out);
    H5Sclose(space);
    H5Tclose(disk);
    return out;
}

/* n strings of variable length, or of `width` bytes each, one after another */
static char *element_join(char *const *variable, const char *fixed, size_t width, hssize_t n)
{
    char *out = malloc((size_t)n * (MOST_LINE + 1) + 1), *to = out;
    for (hssize_t k = 0; out && k < n; k++) {
        const char *from = variable ? variable[k] : fixed + (size_t)k * width;
        size_t most = variable || width > MOST_LINE ? MOST_LINE : width;
        size_t length = from ? strnlen(from, most) : 0;
        if (length) memcpy(to, from, length);
        for (size_t i = 0; i < length; i++)
            if (to[i] == '\n') to[i] = '?';
        to += length, *to++ = '\n';
    }
    if (out) *to = 0;
    return out;
}

char *element_lines(hid_t set, size_t *length, bool *no_memory)
{
    hid_t disk = H5Dget_type(set), space = H5Dget_space(set);
    hssize_t n = space < 0 ? -1 : H5Sget_simple_extent_npoints(space);
    bool strings = disk >= 0 && H5Tget_class(disk) == H5T_STRING && n >= 0 && n <= MOST_LINES;
    bool variable = strings && H5Tis_variable_str(disk) > 0;
    size_t width = strings && !variable ? H5Tget_size(disk) : sizeof(char *);
    char *out = NULL, **list = strings && width <= MOST_LINE ? calloc((size_t)n + 1, width) : NULL;
    if (list) {
        hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, H5T_VARIABLE), H5Tset_cset(type, H5Tget_cset(disk));
        if (H5Dread(set, variable ? type : disk, H5S_ALL, H5S_ALL, H5P_DEFAULT, list) >= 0)
            *no_memory = !(out = element_join(variable ? list : NULL,
                                              variable ? NULL : (const char *)list, width, n));
        for (hssize_t k = 0; variable && k < n; k++) H5free_memory(list[k]);
        H5Tclose(type);
    }
    free(list);
    if (out) *length = strlen(out);
    if (space >= 0) H5Sclose(space);
    if (disk >= 0) H5Tclose(disk);
    return out;
}
