/* The formats, and an export from its start to its end. */
#include <glib/gi18n.h>

#include "ui/export/private.h"

const SporeExportFormat spore_export_formats[] = {
    {"bundle", SPORE_EXPORT_NO_MOMENT, ".sporez", N_("Bundle"),
     N_("the scene and the files that its run needs in one .sporez file, which spore and the editor open like a scene"),
     spore_export_bundle},
    {"runtime", SPORE_EXPORT_NO_MOMENT, ".run", N_("Runtime file"),
     N_("the compiled scene in one file, which libspore and spore-player load without GLib and XML, and run to the "
        "same bits"),
     spore_export_runtime},
    {"player", SPORE_EXPORT_NO_MOMENT, NULL, N_("Player"),
     N_("a folder with the runtime file and spore-player, which runs where nothing but the C library is: ./play there"),
     spore_export_player},
    {"vtk", SPORE_EXPORT_SERIES, ".pvd", N_("VTK series"),
     N_("a series over time that ParaView opens, F.pvd with a folder beside it, or a folder: surfaces, tetrahedra with "
        "displacement and strain, lines, particles, all with velocities"),
     spore_export_vtk},
    {"gltf", SPORE_EXPORT_SERIES, ".glb", N_("glTF"),
     N_("one .glb file: surfaces with materials and pictures; over time, rigid bodies as tracks, others as morph "
        "targets of few key "
        "frames"),
     spore_export_gltf},
    {"obj", SPORE_EXPORT_ONE_MOMENT, ".obj", N_("OBJ"),
     N_("the surfaces at a moment, in metres: an object for each body, F.mtl with the colours, and F-BODY.png with its "
        "picture"),
     spore_export_obj},
    {"ply", SPORE_EXPORT_ONE_MOMENT, ".ply", N_("PLY"),
     N_("the surfaces at a moment, in metres: one mesh with colours"), spore_export_ply},
    {"stl", SPORE_EXPORT_ONE_MOMENT, ".stl", N_("STL"), N_("the surfaces at a moment, in metres: one mesh"),
     spore_export_stl},
    {"mjcf", SPORE_EXPORT_ONE_MOMENT, ".xml", N_("MuJoCo"),
     N_("rigid bodies at a moment for MuJoCo 2.2: spheres, masses, springs, ball joints"), spore_export_mjcf},
    {"sofa", SPORE_EXPORT_NO_MOMENT, ".scn", N_("SOFA"),
     N_("the start of the scene for SOFA (.scn): rigid bodies, tetrahedra and springs, with masses, spheres and pins"),
     spore_export_sofa},
    {NULL},
};

gboolean spore_export_run(SporeExport *export, const SporeExportFormat *format, GError **error) {
  g_return_val_if_fail(export->document && export->output, FALSE);
  g_return_val_if_fail(!export->stride || format->moments == SPORE_EXPORT_SERIES, FALSE);
  g_return_val_if_fail(!export->steps || format->moments != SPORE_EXPORT_NO_MOMENT, FALSE);
  return format->write(export, error);
}
