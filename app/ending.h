/* How the programs end where they cannot go on. */
#ifndef SPORE_APP_ENDING_H
#define SPORE_APP_ENDING_H

/* From here on, a fatal message of GLib (no memory) and an abort end the program with status 3 and one line, and
 * withdraw files that are not whole; a file that meets a limit of size is an error of writing. Called before anything
 * asks for memory. */
void spore_ending_prepare(void);
/* The line is in the user's language from here on. Called after spore_catalogue_start. */
void spore_ending_translate(void);
/* SIGINT, SIGTERM and SIGHUP end the program as ever from here on, but withdraw files that are not whole. */
void spore_ending_on_signals(void);

#endif
