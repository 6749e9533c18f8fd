/* Numbers as people type and read them: with the decimal mark of their language, lengths in mm, angles in degrees,
 * flows in ml/min. */
#ifndef SPORE_UI_DOCUMENT_NUMBER_TEXT_H
#define SPORE_UI_DOCUMENT_NUMBER_TEXT_H

/* The decimal mark of the locale. */
const char *spore_number_mark(void);
/* The text as a scene's file has it. Where the mark is a comma, "0,003" and "1,5 0 2" are numbers with decimals, and a
 * point is taken as well; commas may also part the numbers of a vector: "1, 2, 3", "1.5,2,3". g_free. */
char *spore_number_text_read(const char *typed, const char *mark);
/* A text of a scene's file, with that mark. g_free. */
char *spore_number_text_show(const char *text, const char *mark);
/* The text of a scene's file with each number times ten to the power of `digits`, exactly: the decimal point moves.
 * What is no decimal number stays. g_free. */
char *spore_number_text_shift(const char *text, int digits);
/* Cuts a unit of length from the end of what was typed, and tells how far the decimal point of metres lies from that
 * of the unit: m 0, cm -2, mm -3, um and µm -6. Without one: -3, since the window shows lengths in mm. */
int spore_number_text_cut_length(char *typed);
/* The text of a scene's file, radians, in degrees: the shortest that stand for each number as it is written, so that
 * 0.5236 is 30. What is no number stays. g_free. */
char *spore_number_text_degrees(const char *text);
/* The reverse; spore_number_text_degrees makes the same degrees of it again. g_free. */
char *spore_number_text_radians(const char *text);
/* Cuts "°", "deg" or "rad" from the end of what was typed. TRUE: these are degrees, as the window shows angles;
 * FALSE: radians. */
int spore_number_text_cut_angle(char *typed);
/* The text of a scene's file, m^3/s, in ml/min, as short as angles are; and the reverse. g_free. */
char *spore_number_text_flow(const char *text);
char *spore_number_text_from_flow(const char *text);
/* Cuts "ml/min" or "l/min" from the end of what was typed, and tells how far the decimal point of ml/min lies from that
 * of the unit: l/min 3, else 0, since the window shows flows in ml/min. */
int spore_number_text_cut_flow(char *typed);

#endif
