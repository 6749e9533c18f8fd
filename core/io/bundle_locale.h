/* libarchive turns names into the encoding of the thread's locale; in a bundle they are UTF-8, whatever the user's
 * locale is. */
#ifndef SPORE_IO_BUNDLE_LOCALE_H
#define SPORE_IO_BUNDLE_LOCALE_H

#include <locale.h>

typedef struct SporeBundleLocale {
  locale_t own, before; /* own 0: the system has none, and nothing was changed */
} SporeBundleLocale;

/* Gives the thread its own locale, with UTF-8 as its encoding, until spore_bundle_locale_end. */
static inline SporeBundleLocale spore_bundle_locale_begin(void) {
  SporeBundleLocale locale = {0};
  locale_t copy = duplocale(uselocale((locale_t)0));
  if (copy) locale.own = newlocale(LC_CTYPE_MASK, "C.UTF-8", copy);
  if (locale.own) locale.before = uselocale(locale.own);
  else if (copy) freelocale(copy);
  return locale;
}

static inline void spore_bundle_locale_end(SporeBundleLocale locale) {
  if (!locale.own) return;
  uselocale(locale.before);
  freelocale(locale.own);
}

#endif
