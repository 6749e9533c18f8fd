/* Where the user's data folder keeps what belongs to a scene's file and is not in it. No GTK. */
#ifndef SPORE_UI_DOCUMENT_SCENE_PLACE_H
#define SPORE_UI_DOCUMENT_SCENE_PLACE_H

/* $XDG_DATA_HOME/spore/FOLDER/NAME-HASH.EXTENSION: two scenes of one name have files of their own. g_free. */
char *spore_scene_place(const char *scene, const char *folder, const char *extension);

#endif
