/* Links: a cross where each holds, a line between ends that are apart, in a colour of each kind. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/author/link_edits.h"
#include "core/math/colour.h"
#include "core/sim/link/link_type.h"
#include "ui/render/stage_body.h"

#define CROSS_SHARE 0.005 /* half of a cross's size, as a part of the scene's diagonal */
#define LINE_PIXELS 2.5f

/* Apart from each other for the colour-blind as well (after Okabe and Ito), and from the orange of contact forces. By
 * the order of spore_link_types; the seam, which becomes many of them, is last. */
static const struct {
  const char *name;
  float colour[3]; /* of a screen */
} hues[SPORE_STAGE_LINK_KINDS] = {
    {N_("white"), {0.95f, 0.95f, 0.95f}},      {N_("yellow"), {0.94f, 0.89f, 0.26f}},
    {N_("light blue"), {0.34f, 0.71f, 0.91f}}, {N_("green"), {0, 0.62f, 0.45f}},
    {N_("red"), {0.84f, 0.25f, 0.1f}},         {N_("pink"), {0.8f, 0.47f, 0.65f}},
    {N_("grey"), {0.55f, 0.55f, 0.55f}},       {N_("dark blue"), {0, 0.3f, 0.75f}},
};

typedef struct Link {
  guint kind;
  const char *label; /* of its kind, translated */
  char *name;
  gsize first, count; /* links of the world; a seam has many; count 0: a link that does not move, or no world */
  guint place_count;
  SporeVec3 places[SPORE_LINK_MOST_ENDS]; /* at time 0 */
  guint broken;                           /* how many of `count` */
  double load;                            /* N, of all of `count` */
} Link;

static void clear_link(gpointer data) { g_free(((Link *)data)->name); }

GArray *spore_stage_links_new(void) {
  GArray *links = g_array_new(FALSE, FALSE, sizeof(Link));
  g_array_set_clear_func(links, clear_link);
  return links;
}

static guint kind_of(const SporeObject *object) {
  const SporeLinkType *type = spore_link_type_find(spore_object_type(object)->element);
  guint kind = 0;
  while (spore_link_types[kind] && spore_link_types[kind] != type) kind++;
  return MIN(kind, SPORE_STAGE_LINK_KINDS - 1);
}

static void find_in_world(const SporeWorld *world, Link *link) {
  gsize count = spore_world_link_count(world);
  for (gsize i = 0; i < count; i++) {
    if (!g_str_equal(spore_world_link_name(world, i), link->name)) continue;
    if (!link->count++) link->first = i;
  }
}

static void remove_lines(SporeStage *stage) {
  for (guint i = 0; i < SPORE_STAGE_LINK_KINDS; i++)
    if (stage->link_handles[i]) spore_renderer_remove(stage->renderer, stage->link_handles[i]);
  memset(stage->link_handles, 0, sizeof stage->link_handles);
}

static void add_lines(SporeStage *stage, guint kind) {
  float colour[3];
  for (int k = 0; k < 3; k++) colour[k] = (float)spore_linear_light(hues[kind].colour[k]);
  if (!stage->link_handles[kind])
    stage->link_handles[kind] = spore_renderer_add_lines(stage->renderer, NULL, 0, colour, LINE_PIXELS);
}

void spore_stage_links_clear(SporeStage *stage) {
  remove_lines(stage);
  g_array_set_size(stage->links, 0);
}

static void append_line(GArray *points, SporeVec3 from, SporeVec3 to) {
  double line[6];
  spore_vec3_store(line, from);
  spore_vec3_store(line + 3, to);
  g_array_append_vals(points, line, 6);
}

static void append_cross(GArray *points, SporeVec3 at, double half) {
  const SporeVec3 arms[] = {{half, 0, 0}, {0, half, 0}, {0, 0, half}};
  for (gsize i = 0; i < G_N_ELEMENTS(arms); i++)
    append_line(points, spore_vec3_sub(at, arms[i]), spore_vec3_add(at, arms[i]));
}

static void append_ends(GArray *points, SporeVec3 from, SporeVec3 to, double half) {
  append_cross(points, from, half);
  if (!(spore_vec3_distance(from, to) > 0.5 * half)) return;
  append_cross(points, to, half);
  append_line(points, from, to);
}

/* snapshot NULL, or of time 0: where the author has put the link. */
static void append_link(GArray *points, Link *link, const SporeSnapshot *snapshot, double half) {
  link->broken = 0, link->load = 0;
  for (gsize i = link->first; snapshot && i < link->first + link->count; i++) {
    link->broken += snapshot->links[i].broken;
    link->load += snapshot->links[i].load;
  }
  if (!snapshot || !link->count || snapshot->step == 0) {
    append_ends(points, link->places[0], link->places[link->place_count - 1], half);
    return;
  }
  for (gsize i = link->first; i < link->first + link->count; i++)
    if (!snapshot->links[i].broken) append_ends(points, snapshot->links[i].a, snapshot->links[i].b, half);
}

static gboolean are_shown(const SporeStage *stage, const SporeSnapshot *snapshot) {
  return stage->options.links || (stage->marks_links && (!snapshot || snapshot->step == 0));
}

void spore_stage_show_links(SporeStage *stage, const SporeSnapshot *snapshot) {
  double lower[3], upper[3];
  gboolean shown = are_shown(stage, snapshot);
  if (shown) spore_stage_bounds(stage, lower, upper);
  for (guint kind = 0; kind < SPORE_STAGE_LINK_KINDS; kind++) {
    guint handle = stage->link_handles[kind];
    if (handle) spore_renderer_set_visible(stage->renderer, handle, shown);
    if (!handle || !shown) continue;
    double half = CROSS_SHARE * spore_vec3_distance(spore_vec3_load(lower), spore_vec3_load(upper));
    g_autoptr(GArray) points = g_array_new(FALSE, FALSE, sizeof(double));
    for (guint i = 0; i < stage->links->len; i++) {
      Link *link = &g_array_index(stage->links, Link, i);
      if (link->kind == kind) append_link(points, link, snapshot, half);
    }
    spore_renderer_move_lines(stage->renderer, handle, (const double *)(void *)points->data, points->len / 6);
  }
}

void spore_stage_links_rebuild(SporeStage *stage) {
  const SporeObject *links = spore_document_section(stage->document, "links");
  for (guint i = 0; i < spore_object_child_count(links); i++) {
    const SporeObject *object = spore_object_child(links, i);
    Link link = {.kind = kind_of(object), .label = _(spore_object_type(object)->label)};
    link.place_count = spore_link_places(stage->document, object, link.places);
    if (!link.place_count) continue;
    link.name = g_strdup(spore_object_name(object));
    if (stage->simulation) find_in_world(stage->simulation->world, &link);
    add_lines(stage, link.kind);
    g_array_append_val(stage->links, link);
  }
  spore_stage_show_links(stage, NULL);
}

void spore_stage_mark_links(SporeStage *stage, gboolean marked) {
  stage->marks_links = marked;
  if (!stage->simulation) spore_stage_show_links(stage, NULL); /* no update comes */
}

/* The kinds that the scene has, each with its colour. */
static void list_kinds(const SporeStage *stage, SporeStageLegend *legend) {
  for (guint kind = 0; kind < SPORE_STAGE_LINK_KINDS; kind++) {
    guint count = 0;
    const char *label = NULL;
    for (guint i = 0; i < stage->links->len; i++) {
      const Link *link = &g_array_index(stage->links, Link, i);
      if (link->kind == kind) count++, label = link->label;
    }
    if (!count) continue;
    SporeStageKey *key = &legend->keys[legend->key_count++];
    for (int k = 0; k < 3; k++) key->colour[k] = hues[kind].colour[k];
    key->text = g_strdup_printf(_("%s (%s): %u"), label, _(hues[kind].name), count);
  }
}

/* What bears most now, and how many broke. NULL: nothing bears anything. */
static char *tell_loads(const SporeStage *stage) {
  const Link *most = NULL;
  guint broken = 0;
  for (guint i = 0; i < stage->links->len; i++) {
    const Link *link = &g_array_index(stage->links, Link, i);
    broken += link->broken > 0;
    if (link->load > (most ? most->load : 0)) most = link;
  }
  g_autofree char *bears = most ? g_strdup_printf(_("most now: %.3g N on \"%s\""), most->load, most->name) : NULL;
  g_autofree char *broke = broken ? g_strdup_printf(ngettext("%u broke", "%u broke", broken), broken) : NULL;
  if (bears && broke) return g_strdup_printf("%s; %s", broke, bears);
  return bears ? g_steal_pointer(&bears) : g_steal_pointer(&broke);
}

gboolean spore_stage_link_legend(const SporeStage *stage, SporeStageLegend *legend) {
  *legend = (SporeStageLegend){0};
  if (!stage->options.links) return FALSE;
  legend->label = g_strdup(_("Links"));
  list_kinds(stage, legend);
  legend->without = legend->key_count ? tell_loads(stage) : g_strdup(_("the scene has none"));
  return TRUE;
}
