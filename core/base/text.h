/* Marks for texts a user sees, inside the kernel's rooms (C files only, never headers). xgettext looks for both. */
#ifndef SPORE_BASE_TEXT_H
#define SPORE_BASE_TEXT_H

#include "core/base/error.h"

#define _(text) spore_translate(text)
#define N_(text) text

#endif
