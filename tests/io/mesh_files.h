/* Contents of mesh files, made from a mesh. */
#ifndef SPORE_TESTS_IO_MESH_FILES_H
#define SPORE_TESTS_IO_MESH_FILES_H

#include <glib.h>

#include "core/mesh/mesh.h"

GByteArray *file_stl_text(const SporeTriangleMesh *mesh);
GByteArray *file_stl(const SporeTriangleMesh *mesh);
/* head: lines before the vertices, e.g. a material library. */
GByteArray *file_obj(const SporeTriangleMesh *mesh, const char *head);
GByteArray *file_ply_text(const SporeTriangleMesh *mesh);
GByteArray *file_ply(const SporeTriangleMesh *mesh);

/* glTF 2.0 whose one node stretches by 2 along x, then moves by (1, 2, 3). uri: of the buffer; NULL embeds it. */
GByteArray *file_gltf(const SporeTriangleMesh *mesh, const char *uri);
/* The content of that buffer. */
GByteArray *file_gltf_buffer(const SporeTriangleMesh *mesh);
GByteArray *file_glb(const SporeTriangleMesh *mesh);

#endif
