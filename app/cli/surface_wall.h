/* A hollow organ from a solid one, for spore surface. */
#ifndef SPORE_APP_CLI_SURFACE_WALL_H
#define SPORE_APP_CLI_SURFACE_WALL_H

#include "app/cli/cli.h"

typedef struct SporeWallOptions {
  double thickness;         /* m */
  gint64 detail;            /* see spore_wall_inner; 0: SPORE_WALL_DETAIL */
  const char *wall, *inner; /* files to write, NULL: none; suffixes that spore_surface_formatter knows */
} SporeWallOptions;

typedef char *(*SporeSurfaceFormatter)(const SporeTriangleMesh *mesh, gsize *size);
/* NULL: the file's name ends in nothing known. */
SporeSurfaceFormatter spore_surface_formatter(const char *file);

/* Reports the wall, and writes the files. made: gets the wall, unless it is NULL; the caller's to clear. */
gboolean spore_surface_make_wall(SporeCli *cli, const char *file, const SporeTriangleMesh *outer,
                                 const SporeWallOptions *options, SporeTriangleMesh *made, GError **error);

#endif
