/* Files of VTK that ParaView opens: what a drawing shows at a moment. Numbers are appended as they lie in memory. */
#ifndef SPORE_IO_VTK_WRITE_H
#define SPORE_IO_VTK_WRITE_H

#include "core/scene/drawing.h"

/* The kind of file of a part: "vtu" of tetrahedra, "vtp" of surfaces, lines and points. */
const char *spore_vtk_suffix(const SporeDrawnPart *part);
/* The content of such a file. Arrays at points: velocity (m/s); of tetrahedra displacement (m); of lines and points
 * radius (m). Arrays at tetrahedra: strain (Green's, six components XX YY ZZ XY YZ XZ, in world axes of time 0) and
 * volume_ratio. g_byte_array_unref. */
GByteArray *spore_vtk_format(const SporeDrawnPart *part, double time_s);

/* A file of several others, "vtm": the names of its blocks, and their files, relative to it. g_free. */
char *spore_vtk_format_blocks(const GPtrArray *names, const GPtrArray *files);
/* A series of files over time, "pvd". times: files->len, s. g_free. */
char *spore_vtk_format_series(const double *times, const GPtrArray *files);

#endif
