/* draw/page_parts.h: the texts of draw/page/, which are part of the program. */
#ifndef NSD_PAGE_PARTS_H
#define NSD_PAGE_PARTS_H

enum page_text { PAGE_HTML, PAGE_CSS, PAGE_JS, PAGE_THREE, PAGE_LICENCE };

/* The text of a file */
const char *page_part(enum page_text which);

#endif
