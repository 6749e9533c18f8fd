/* Merges the recorded tracks of a scene, and opens the devices that play them to the bodies. */
#include "core/scene/compile_private.h"

#include <glib/gi18n.h>
#include <string.h>

static gboolean copy_channel(SporeCompiler *compiler, SporeTrack *track, const SporeTrackChannel *from,
                             const char *name) {
  SporeTrackChannel *channel = spore_track_add_channel(track, name);
  for (size_t i = 0; channel && i < from->count; i++)
    if (!spore_track_append(channel, from->time_s[i], &from->states[i])) channel = NULL;
  return channel || spore_error_raise(compiler->error, SPORE_ERROR_MEMORY, NULL, "%s",
                                      _("not enough memory for the recorded input; close something or shorten it"));
}

/* The channel that drives `body`: the channel of that name, or else the only channel of the track. */
static const SporeTrackChannel *channel_for(const SporeTrack *track, const char *body) {
  const SporeTrackChannel *channel = spore_track_channel(track, body);
  return !channel && track->channel_count == 1 ? &track->channels[0] : channel;
}

static gboolean add_track(SporeCompiler *compiler, SporeTrack *merged, const SporeObject *device, const char *body) {
  const char *file = spore_object_text(device, "file");
  g_autoptr(GError) unreadable = NULL;
  g_autoptr(GBytes) content = file ? spore_document_read_asset(compiler->document, file, &unreadable) : NULL;
  SporeError fault = SPORE_ERROR_INIT;
  if (unreadable) {
    spore_error_set(&fault, (SporeErrorCode)unreadable->code, NULL, "%s", unreadable->message);
    return spore_compiler_pass_on(compiler, device, &fault);
  }
  if (!content) return spore_compiler_refuse(compiler, device, _("the track has no file; set it"));
  gsize size;
  const char *text = g_bytes_get_data(content, &size);
  SporeTrack track = {0};
  gboolean done;
  if (!spore_track_parse(&track, file, text, size, &fault)) {
    done = spore_compiler_pass_on(compiler, device, &fault);
  } else {
    const SporeTrackChannel *channel = channel_for(&track, body);
    done = channel
               ? copy_channel(compiler, merged, channel, body)
               : spore_compiler_refuse(compiler, device,
                                       _("the track has no channel \"%s\"; expected one of the body's name; record it "
                                         "or rename the channel"),
                                       body);
  }
  spore_track_clear(&track);
  return done;
}

static gboolean add_input(SporeCompiler *compiler, SporeTrack *merged, const SporeTrack *input,
                          const SporeObject *probe) {
  SporeObject *body, *device;
  if (spore_parameter_find(spore_object_type(probe)->table, "device") < 0) return TRUE;
  if (!spore_compiler_resolve(compiler, probe, "body", &body) ||
      !spore_compiler_resolve(compiler, probe, "device", &device))
    return FALSE;
  if (!body) return TRUE; /* `spore check` reports it */
  const char *name = spore_object_name(body);
  if ((int)spore_object_number(body, "role") != SPORE_ACTIVE)
    return spore_compiler_refuse(
        compiler, probe,
        _("the tool's body \"%s\" is not active; expected role=\"active\"; change its role or choose "
          "another body"),
        name);
  if (!device || strcmp(spore_object_type(device)->element, "track") != 0) return TRUE;
  if (input && spore_track_channel(input, name)) return TRUE;
  if (spore_track_channel(merged, name))
    return spore_compiler_refuse(compiler, probe, _("two tools move the body \"%s\"; expected one; remove one"), name);
  return add_track(compiler, merged, device, name);
}

gboolean spore_compiler_merge_input(SporeCompiler *compiler, SporeTrack *merged, const SporeTrack *input) {
  for (size_t i = 0; input && i < input->channel_count; i++) {
    const char *name = input->channels[i].name;
    const SporeObject *body = spore_document_find(compiler->document, "body", name);
    if (!body || (int)spore_object_number(body, "role") != SPORE_ACTIVE)
      return spore_error_raise(
          compiler->error, SPORE_ERROR_INPUT, NULL,
          _("the input track moves \"%s\"; expected the name of an active body of the scene; rename the "
            "channel or use the track's own scene"),
          name);
    if (!copy_channel(compiler, merged, &input->channels[i], name)) return FALSE;
  }
  const SporeObject *tools = spore_document_section(compiler->document, "tools");
  for (guint i = 0; i < spore_object_child_count(tools); i++)
    if (!add_input(compiler, merged, input, spore_object_child(tools, i))) return FALSE;
  return TRUE;
}

gboolean spore_compiler_open_devices(SporeCompiler *compiler, SporeSimulation *simulation) {
  SporeTrack *track = simulation->track;
  for (size_t i = 0; i < track->channel_count; i++) {
    SporeDevice *device = spore_track_device_create(&track->channels[i]);
    if (!device)
      return spore_error_raise(compiler->error, SPORE_ERROR_MEMORY, NULL, "%s",
                               _("not enough memory for the recorded input; close something or shorten it"));
    g_ptr_array_add(simulation->devices, device);
    spore_world_set_device(simulation->world, spore_world_find_body(simulation->world, track->channels[i].name),
                           device);
  }
  if (track->channel_count == 0) g_clear_pointer(&simulation->track, g_free);
  return TRUE;
}
