/* Opening files by relative names without ever leaving a folder. */
#ifndef SPORE_SCENE_BENEATH_H
#define SPORE_SCENE_BENEATH_H

#include <sys/types.h>

/* open(2) of `path` below the folder `directory` (a descriptor): no "..", absolute path or symbolic link leads out.
 * -1 with errno; EXDEV or ELOOP: the path would leave the folder. */
int spore_open_beneath(int directory, const char *path, int flags, mode_t mode);

/* The same for kernels without openat2 (before Linux 5.6): part by part, refusing every symbolic link. */
int spore_open_beneath_walking(int directory, const char *path, int flags, mode_t mode);

#endif
