/* Numbers as text, always in the C locale's form (a point, no grouping), whatever the locale of the program. */
#ifndef SPORE_BASE_NUMBER_H
#define SPORE_BASE_NUMBER_H

#include <stddef.h>

#define SPORE_NUMBER_TEXT 32 /* bytes that any formatted number fits in */

/* Reads one decimal number ([+-] digits [. digits] [e [+-] digits]; no hexadecimal, inf or nan) from the start of
 * `text`, which need not end in NUL. Returns its length in bytes, 0 where there is none or it is longer than 1000.
 * What is too large gives an infinity: the caller checks. */
size_t spore_number_read(const char *text, size_t size, double *value);

/* Shortest text that reads back to the same bits; returns its length. Not finite: "inf", "-inf", "nan". */
int spore_number_format(double value, char text[SPORE_NUMBER_TEXT]);
/* The same of the value rounded to so many significant digits, from 1 on. */
int spore_number_format_rounded(double value, int digits, char text[SPORE_NUMBER_TEXT]);

#endif
