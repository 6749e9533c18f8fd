/* Checks of textures: their files are there, of a size that is drawn, and fit the mesh. */
#include <glib/gi18n.h>

#include "core/scene/check_private.h"
#include "core/scene/texture.h"

static void check_body(SporeCheck *check, SporeObject *body) {
  const SporeObject *visual = spore_object_child_of(body, "visual");
  if (!visual) return;
  g_autoptr(GError) error = NULL;
  SporeTexture texture;
  if (spore_texture_read(check->document, visual, &texture, &error)) spore_texture_clear(&texture);
  if (error) spore_check_say_error(check, SPORE_WARNING, visual, error);
  else if (!spore_object_text(visual, "texture") && spore_object_text(visual, "texture_places")) {
    spore_check_say(check, SPORE_NOTE, visual, _("name a texture, or remove texture_places"),
                    _("\"%s\" has places in a texture, and no texture"), spore_object_name(body));
    spore_check_offer_set(check, visual, "texture_places", NULL);
  }
}

void spore_check_textures(SporeCheck *check) { spore_check_each(check, "bodies", NULL, check_body); }
