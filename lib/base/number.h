/*
 * base/number.h: numbers as text, with a decimal point in every locale: the library is in programs that have called setlocale(),
 * as Python programs do.
 */
#ifndef NSD_NUMBER_H
#define NSD_NUMBER_H

#include <stddef.h>

/* As strtod() */
double number_read(const char *text, char **end);
/* As snprintf() with %.*g or %.*e; form: 'g' or 'e' */
void number_write(char *text, size_t room, int digits, char form, double x);

#endif
