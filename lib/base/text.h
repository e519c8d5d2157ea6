/*
 * base/text.h: numbers as text, with a decimal point in every locale: the library is in programs that have called setlocale(), as
 * Python programs do. And a text in memory, written as a stream. open_memstream() does the same, but where memory is exhausted it
 * drops what does not fit, and neither ferror() nor fclose() reports it.
 */
#pragma once

#include <stdbool.h>
#include <stdio.h>

/* As strtod() */
double number_read(const char *text, char **end);
/* As snprintf() with %.*g or %.*e; form: 'g' or 'e' */
void number_write(char *text, size_t room, int digits, char form, double x);

/* With the fewest digits, of 15 to 17, that are read as the same number */
enum { NUMBER_ROOM = 32 };
void number_shortest(char text[NUMBER_ROOM], double x);

struct text {
    char *bytes;
    size_t size, room;
    bool lost; /* some of it, for lack of memory */
};

/* NULL: no memory. The text stays where it is until text_close(). */
FILE *text_open(struct text *text);
/* Closes the stream, or NULL. Returns all bytes that were written, with a zero behind them, to be freed, and their number in *size;
   NULL: no memory */
char *text_close(struct text *text, FILE *stream, size_t *size);
