/* draw/page_parts.c: the assembler takes the files in as they are [draw/page_parts.h]. */
#include "draw/page_parts.h"

#define TAKE_IN(name, file)                                                                        \
    __asm__(".section .rodata\n.hidden " name "\n.globl " name "\n" name                           \
            ": .incbin \"lib/draw/page/" file "\"\n.byte 0\n.previous\n")

TAKE_IN("nsd_page_html", "page.html");
TAKE_IN("nsd_page_css", "page.css");
TAKE_IN("nsd_page_js", "page.js");
TAKE_IN("nsd_page_three", "three.module.min.js");
TAKE_IN("nsd_page_licence", "LICENSE.three");

extern const char nsd_page_html[], nsd_page_css[], nsd_page_js[], nsd_page_three[],
    nsd_page_licence[];

const char *page_part(enum page_text which)
{
    static const char *const part[] = { nsd_page_html, nsd_page_css, nsd_page_js, nsd_page_three,
                                        nsd_page_licence };
    return part[which];
}
