/* What the formats share: a format is one row of the table in export.c, and one function. */
#ifndef SPORE_UI_EXPORT_PRIVATE_H
#define SPORE_UI_EXPORT_PRIVATE_H

#include "core/io/surface_write.h"
#include "core/scene/drawing.h"
#include "ui/export/export.h"

/* Writes the export's file whole or not at all. The content stays the caller's. */
gboolean spore_export_write(SporeExport *export, const void *content, gsize size, GError **error);
/* Tells of a file that was written already. */
void spore_export_wrote(SporeExport *export, const char *file, gsize bytes);
/* Adds a sentence, translated: what the scene holds and the format cannot. Takes over the text. */
void spore_export_lose(SporeExport *export, char *sentence);
/* Says that bodies begin as modelled, where poses were kept. */
void spore_export_lose_poses(SporeExport *export);
/* The same: what the scene holds and the file does not need. */
void spore_export_leave_out(SporeExport *export, char *sentence);

/* The scene's runtime file (core/runtime/runtime.h): *size bytes, spore_free. Tells what is lost. NULL with a GError.
 */
gpointer spore_export_format_runtime(SporeExport *export, gsize *size, GError **error);

/* Moments. */

/* What a format does with the scene at a moment. FALSE with a GError. */
typedef gboolean (*SporeExportMoment)(gpointer data, const SporeDrawing *drawing, double time_s, GError **error);
/* Runs the scene for the export's steps, and shows it at time 0 and each stride from there on, or where that is 0 at
 * the end alone. Tells how much of the run was not solved. FALSE with a GError; SPORE_ERROR_CANCELLED when the cancel
 * was asked. */
gboolean spore_export_show(SporeExport *export, SporeExportMoment moment, gpointer data, GError **error);
/* Adds the sections of the scene that no other program knows: tools, devices, exercise and so on. links: these too. */
void spore_export_lose_sections(SporeExport *export, gboolean links);
/* Adds what no picture of a scene holds: links, tools, how bodies move, and so on. colours: the format has these;
 * materials: it has pictures and opacity as well. */
void spore_export_lose_physics(SporeExport *export, gboolean colours, gboolean materials);
/* What the part looks like, without its mesh: with its picture and the places of its triangles, where it has them. */
SporeNamedSurface spore_export_surface(const SporeDrawnPart *part);

/* For formats of XML that hold bodies. */

/* Appends NAME="number number ...", after a space. */
void spore_export_attribute(GString *text, const char *name, const double *values, gsize count);
/* Where points (count x 3, m, in the body's frame at rest) lie in what carries the body now: its own frame, where it is
 * rigid and moves, else the world. *places: count x 3, g_free. */
gboolean spore_export_place(const SporeWorld *world, guint body, const double *points, gsize count, double **places,
                            GError **error);

/* Inertia of a rigid body at q (7), kg m^2, in the frame of the body. */
SporeMat3 spore_export_inertia(const SporeModel *rigid, const double *q);

/* Says that there is nothing to write. Returns FALSE. */
gboolean spore_export_refuse_empty(const SporeExport *export, GError **error);

/* The formats. Each writes export->output; FALSE with a GError, and then nothing is written. */
gboolean spore_export_bundle(SporeExport *export, GError **error);
gboolean spore_export_player(SporeExport *export, GError **error);
gboolean spore_export_runtime(SporeExport *export, GError **error);
gboolean spore_export_gltf(SporeExport *export, GError **error);
gboolean spore_export_mjcf(SporeExport *export, GError **error);
gboolean spore_export_obj(SporeExport *export, GError **error);
gboolean spore_export_ply(SporeExport *export, GError **error);
gboolean spore_export_sofa(SporeExport *export, GError **error);
gboolean spore_export_stl(SporeExport *export, GError **error);
gboolean spore_export_vtk(SporeExport *export, GError **error);

#endif
