/* A recording that is kept in a scene leads the tools that were recorded, and no others, in a run of the scene. */
#include "core/author/instrument_edits.h"
#include "core/author/track_edits.h"
#include "core/scene/compile.h"
#include "tests/scene/fixture.h"

static const char scene_text[] =
    "<spore version=\"1.0\"><assets><mesh name=\"cube\" file=\"cube.off\"/></assets><bodies>"
    "<body name=\"wall\" role=\"unmovable\"><visual mesh=\"cube\"/></body></bodies></spore>\n";

static void test_kept(void) {
  char *folder = fixture_scene_folder_new(scene_text);
  SporeDocument *document = fixture_load(folder);
  GError *error = NULL;
  const SporeInstrumentKind *probe = spore_instrument_find("probe");
  g_assert_nonnull(spore_edit_add_instrument(document, probe, "led", (SporeInstrumentPlaces){NULL, NULL}, NULL));
  g_assert_nonnull(spore_edit_add_instrument(document, probe, "other", (SporeInstrumentPlaces){NULL, NULL}, NULL));
  g_autofree char *before = fixture_format(document);
  SporeTrack recording = {0};
  g_assert_null(spore_edit_keep_track(document, &recording, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "nothing was recorded");
  SporeTrackChannel *channel = spore_track_add_channel(&recording, "led");
  SporeDeviceState state = {.position = {0.25, 0.5, 0.75}, .orientation = {1, 0, 0, 0}};
  g_assert_true(spore_track_append(channel, 0, &state));
  SporeObject *track = spore_edit_keep_track(document, &recording, &error);
  g_assert_no_error(error);
  g_assert_cmpstr(spore_object_text(spore_document_by_path(document, "tools/led"), "device"), ==,
                  spore_object_name(track));
  g_assert_cmpstr(spore_object_text(spore_document_by_path(document, "tools/other"), "device"), ==, "mouse");
  SporeSimulation *simulation = spore_simulation_new(document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  guint32 body = spore_simulation_body_of(simulation, spore_document_find(document, "body", "led"));
  while (spore_world_time_s(simulation->world) < 0.3) spore_world_step(simulation->world); /* it goes there */
  g_assert_cmpfloat_with_epsilon(spore_world_q(simulation->world, body)[0], 0.25, 1e-3);
  spore_simulation_free(simulation);
  spore_document_undo(document);
  g_autofree char *after = fixture_format(document);
  g_assert_cmpstr(after, ==, before);
  spore_track_clear(&recording);
  spore_document_free(document);
  fixture_folder_free(folder);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/tracks/kept", test_kept);
  return g_test_run();
}
