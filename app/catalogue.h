/* Translations, from the installed catalogue or the build tree's. */
#ifndef SPORE_APP_CATALOGUE_H
#define SPORE_APP_CATALOGUE_H

/* Sets the locale (numbers stay in the C locale), binds the catalogue, and hands gettext to the kernel. */
void spore_catalogue_start(void);

#endif
