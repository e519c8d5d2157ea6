/*
 * base/mark.h: the byte order mark that some programs put in front of UTF-8, EF BB BF, which is no part of the
 * text.
 */
#ifndef NSD_MARK_H
#define NSD_MARK_H

#include <stddef.h>
#include <string.h>

/* How many bytes of a text are such a mark: 3 or 0 */
static inline size_t mark_length(const char *text, size_t length)
{
    return length >= 3 && !memcmp(text, "\xef\xbb\xbf", 3) ? 3 : 0;
}

#endif
