/* What each piece of the surface is to the solid: it bounds the solid, lies inside, or encloses nothing. */
#include "core/generate/tetrahedra/shells.h"

#include <glib/gi18n.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/tetrahedra/private.h"
#include "core/mesh/common.h"

#define BESIDE 1e-4 /* of the diagonal: distance from the surface at which its two sides are tested */
#define FEW 0.02    /* share of a piece's points that is let pass */
/* Volume over area^1.5 of an open piece that holds something: .02 of a tube 50 widths long, 0 of a flat one. */
#define HOLDS 0.002

#define THIN 0.1 /* of a piece's least extent: a wall no farther inside than this is a second wall */

const char *const spore_piece_role_names[] = {"bounds", "merged", "inside", "cavity", "sheet", NULL};
const char *const spore_piece_wall_names[] = {"none", "open", "lumen", "doubled", "closed", "turned", NULL};

/* A piece while it is looked at. */
typedef struct Look {
  const SporePiece *piece;
  SporePieceShell shell;
  bool inner[SPORE_PIECE_SAMPLES]; /* the solid is on both sides of the point */
  size_t inner_count;
} Look;

static int by_area(const void *a, const void *b) {
  const SporePiece *one = *(const SporePiece *const *)a, *other = *(const SporePiece *const *)b;
  if (one->area != other->area) return one->area > other->area ? -1 : 1;
  return one < other ? -1 : 1;
}

/* Classifies the points of a piece by the solid on their two sides. */
static SporePieceRole role_of(const SporeTetrahedraWork *work, Look *look) {
  const size_t few = (size_t)(FEW * SPORE_PIECE_SAMPLES);
  size_t none = 0;
  for (size_t i = 0; i < SPORE_PIECE_SAMPLES; i++) {
    SporeVec3 p = spore_vec3_load(look->shell.points + 3 * i), n = look->shell.normals[i];
    bool behind = spore_bvh_inside(work->tree, spore_vec3_add_scaled(p, -BESIDE, n));
    bool before = spore_bvh_inside(work->tree, spore_vec3_add_scaled(p, BESIDE, n));
    look->inner[i] = behind && before;
    look->inner_count += look->inner[i];
    none += !behind && !before;
  }
  if (2 * none > SPORE_PIECE_SAMPLES) return SPORE_PIECE_SHEET;
  if (look->inner_count + few >= SPORE_PIECE_SAMPLES) return SPORE_PIECE_INSIDE;
  if (look->inner_count > few) return SPORE_PIECE_MERGED;
  return look->piece->closed && look->piece->volume < 0 ? SPORE_PIECE_CAVITY : SPORE_PIECE_BOUNDS;
}

/* Finds the piece around what lies inside: of those that hold nearly the most points, the one of the least area. all:
 * of all points of the piece. Returns how many points that piece holds at least. */
static size_t find_around(const Look *looks, size_t count, size_t own, bool all, SporeTetrahedraPiece *told) {
  const Look *look = looks + own;
  size_t most = 0;
  for (size_t other = 0; other < count; other++) {
    size_t held = 0;
    if (other == own) continue;
    for (size_t i = 0; i < SPORE_PIECE_SAMPLES; i++)
      if (all || look->inner[i])
        held += fabs(spore_bvh_winding(looks[other].shell.tree, spore_vec3_load(look->shell.points + 3 * i))) > 0.5;
    if (!held || held + (size_t)(FEW * SPORE_PIECE_SAMPLES) < most) continue;
    told->in = (int)other;
    most = held > most ? held : most;
  }
  if (told->in < 0) return 0;
  told->depth[0] = HUGE_VAL;
  for (size_t i = 0; i < SPORE_PIECE_SAMPLES; i++) {
    if (!all && !look->inner[i]) continue;
    double depth =
        spore_bvh_distance(looks[told->in].shell.tree, spore_vec3_load(look->shell.points + 3 * i), NULL, NULL);
    told->depth[0] = fmin(told->depth[0], depth);
    told->depth[1] = fmax(told->depth[1], depth);
  }
  return most;
}

/* Whether a piece with holes, which has solid on one side of it, lies wholly inside another one, which is then told. */
static bool is_open_within(const Look *looks, size_t count, size_t own, SporeTetrahedraPiece *told) {
  const size_t few = (size_t)(FEW * SPORE_PIECE_SAMPLES);
  SporeTetrahedraPiece found = *told;
  if (!looks[own].piece->holes || find_around(looks, count, own, true, &found) + few < SPORE_PIECE_SAMPLES)
    return false;
  *told = found;
  return true;
}

/* Whether an open piece inside another one cuts what it holds out of the solid: one that is flat holds nothing, though
 * beside it the winding number may be below one half. */
static bool cuts_out(const Look *look) {
  SporeVec3 middle = {0, 0, 0};
  double reach = 0;
  for (size_t i = 0; i < SPORE_PIECE_SAMPLES; i++)
    middle = spore_vec3_add_scaled(middle, 1.0 / SPORE_PIECE_SAMPLES, spore_vec3_load(look->shell.points + 3 * i));
  for (size_t i = 0; i < SPORE_PIECE_SAMPLES; i++)
    reach +=
        spore_vec3_dot(spore_vec3_sub(spore_vec3_load(look->shell.points + 3 * i), middle), look->shell.normals[i]);
  const double area = look->piece->area, volume = area * reach / (3 * SPORE_PIECE_SAMPLES);
  return look->inner_count + (size_t)(FEW * SPORE_PIECE_SAMPLES) < SPORE_PIECE_SAMPLES &&
         fabs(volume) > HOLDS * pow(area, 1.5);
}

/* The wall that a piece with a place inside another one is there. */
static SporePieceWall wall_of(const Look *look, const SporeTetrahedraPiece *told, bool hollow) {
  const double least = fmin(told->size[0], fmin(told->size[1], told->size[2]));
  if (told->in < 0 || told->role == SPORE_PIECE_MERGED) return SPORE_WALL_NONE;
  if (told->role == SPORE_PIECE_CAVITY) return hollow ? SPORE_WALL_NONE : SPORE_WALL_TURNED;
  if (look->piece->holes) return SPORE_WALL_OPEN;
  return told->depth[1] <= THIN * least ? SPORE_WALL_DOUBLED : SPORE_WALL_CLOSED;
}

static void tell(const SporeTetrahedraWork *work, Look *look, SporeTetrahedraPiece *told) {
  const SporePiece *piece = look->piece;
  *told = (SporeTetrahedraPiece){.in = -1,
                                 .merged = -1,
                                 .thickness = piece->closed ? 4 * fabs(piece->volume) / piece->area : 0,
                                 .triangles = piece->triangles,
                                 .holes = piece->holes,
                                 .open_edges = piece->open_edges,
                                 .area = piece->area,
                                 .role = role_of(work, look)};
  for (int k = 0; k < 3; k++) told->size[k] = piece->upper[k] - piece->lower[k];
  told->inside_share = (double)look->inner_count / SPORE_PIECE_SAMPLES;
  const char *end = told->name;
  if (work->options.part_names) g_strlcpy(told->name, work->options.part_names[piece->part], sizeof told->name);
  if (!g_utf8_validate(told->name, -1, &end)) told->name[end - told->name] = '\0'; /* cut within a letter */
}

static bool look_at(SporeTetrahedraWork *work, Look *looks, SporeError *error) {
  const size_t count = work->piece_count;
  for (size_t i = 0; i < count; i++) {
    if (!spore_tetrahedra_progress(work, (double)i / (double)count, _("looking at the pieces"), error)) return false;
    tell(work, looks + i, work->piece + i);
  }
  for (size_t i = 0; i < count; i++) {
    SporeTetrahedraPiece *told = work->piece + i;
    if (told->role == SPORE_PIECE_SHEET) continue;
    if (!spore_tetrahedra_progress(work, 1, _("looking at the pieces"), error)) return false;
    const bool open = told->role != SPORE_PIECE_INSIDE && is_open_within(looks, count, i, told);
    if (told->role == SPORE_PIECE_BOUNDS && !open) continue;
    const bool all = told->role == SPORE_PIECE_CAVITY || open;
    if (!open) find_around(looks, count, i, all, told);
    if (open) told->wall = cuts_out(looks + i) ? SPORE_WALL_LUMEN : SPORE_WALL_OPEN;
    if (told->wall == SPORE_WALL_OPEN) told->role = SPORE_PIECE_INSIDE;
    if (told->wall == SPORE_WALL_NONE) told->wall = wall_of(looks + i, told, work->options.hollow);
    work->mixed = work->mixed || (!all && told->in >= 0);
  }
  return true;
}

/* The largest pieces of the surface, each by itself. */
typedef struct Looks {
  SporePieces pieces;
  Look *look; /* count */
  size_t count;
} Looks;

static void clear_looks(Looks *looks) {
  for (size_t i = 0; looks->look && i < looks->count; i++) spore_piece_shell_clear(&looks->look[i].shell);
  spore_free(looks->look);
  spore_pieces_clear(&looks->pieces);
}

static bool open_shells(const SporeTetrahedraWork *work, Looks *looks, SporeError *error) {
  for (size_t i = 0; i < looks->count; i++)
    if (!spore_tetrahedra_progress(work, 0, _("looking at the pieces"), error) ||
        !spore_piece_shell(&looks->look[i].shell, &work->surface, &looks->pieces,
                           (size_t)(looks->look[i].piece - looks->pieces.pieces), error))
      return false;
  return true;
}

/* parts: as of spore_pieces_find. False: no memory or cancelled; *looks can then only be cleared. */
static bool open_looks(const SporeTetrahedraWork *work, const uint32_t *parts, Looks *looks, SporeError *error) {
  *looks = (Looks){0};
  if (!spore_pieces_find(&looks->pieces, &work->surface, parts, error)) return false;
  const size_t all = looks->pieces.count;
  const SporePiece **order = SPORE_NEW_ARRAY(const SporePiece *, all);
  looks->count = MIN(all, SPORE_TETRAHEDRA_PIECES);
  looks->look = SPORE_NEW_ARRAY(Look, looks->count);
  bool done = (order && looks->look) || spore_mesh_no_memory(error);
  for (size_t i = 0; done && i < all; i++) order[i] = looks->pieces.pieces + i;
  if (done) qsort(order, all, sizeof *order, by_area);
  for (size_t i = 0; done && i < looks->count; i++) looks->look[i].piece = order[i];
  spore_free(order);
  return done && open_shells(work, looks, error);
}

bool spore_tetrahedra_look_at_pieces(SporeTetrahedraWork *work, SporeError *error) {
  Looks looks;
  bool done = open_looks(work, work->parts, &looks, error);
  work->pieces = looks.pieces.count;
  work->piece_count = looks.count;
  done = done && look_at(work, looks.look, error);
  clear_looks(&looks);
  return done;
}

bool spore_tetrahedra_piece_trees(const SporeTetrahedraWork *work, SporeBvh **trees, SporeError *error) {
  Looks looks;
  const bool done = open_looks(work, work->parts, &looks, error);
  for (size_t i = 0; done && i < looks.count; i++) {
    trees[i] = looks.look[i].shell.tree;
    looks.look[i].shell.tree = NULL;
  }
  clear_looks(&looks);
  return done;
}

/* Whether the piece lies wholly inside the other one, which is closed. */
static bool is_within(const Look *look, const Look *other) {
  return other->piece->closed && spore_piece_fits(look->piece, other->piece) &&
         spore_piece_points_in(&look->shell, &other->shell) == SPORE_PIECE_SAMPLES;
}

/* Turns the triangles of the marked pieces round. */
static void turn(SporeTriangleMesh *surface, const uint32_t *of, const bool *marked) {
  for (size_t t = 0; t < surface->triangle_count; t++) {
    uint32_t *corner = surface->triangles + 3 * t, kept = corner[1];
    if (marked[of[t]]) corner[1] = corner[2], corner[2] = kept;
  }
}

bool spore_tetrahedra_hollow(SporeTetrahedraWork *work, SporeError *error) {
  Looks looks;
  bool done = open_looks(work, NULL, &looks, error);
  bool *marked = done ? SPORE_NEW_ARRAY(bool, looks.pieces.count) : NULL;
  if (done && !marked) done = spore_mesh_no_memory(error);
  for (size_t i = 0; done && i < looks.count; i++) {
    size_t around = 0;
    if (!looks.look[i].piece->closed || looks.look[i].piece->volume < 0) continue;
    for (size_t k = 0; k < looks.count; k++) around += k != i && is_within(looks.look + i, looks.look + k);
    marked[looks.look[i].piece - looks.pieces.pieces] = around % 2 == 1;
    done = spore_tetrahedra_progress(work, 0, _("looking at the pieces"), error);
  }
  if (done) turn(&work->surface, looks.pieces.of, marked);
  spore_free(marked);
  clear_looks(&looks);
  return done;
}

/* Keeps the triangles of the marked pieces. */
static bool keep(SporeTetrahedraWork *work, const uint32_t *of, const bool *marked, SporeError *error) {
  SporeTriangleMesh *surface = &work->surface;
  size_t kept = 0;
  for (size_t t = 0; t < surface->triangle_count; t++) {
    if (!marked[of[t]]) continue;
    memmove(surface->triangles + 3 * kept, surface->triangles + 3 * t, 3 * sizeof *surface->triangles);
    if (work->parts) work->parts[kept] = work->parts[t];
    kept++;
  }
  surface->triangle_count = kept;
  return spore_triangle_mesh_weld_tagged(surface, 0, work->parts, error); /* drops vertices without triangles */
}

bool spore_tetrahedra_keep_largest(SporeTetrahedraWork *work, SporeError *error) {
  Looks looks;
  bool done = open_looks(work, NULL, &looks, error);
  bool *marked = done ? SPORE_NEW_ARRAY(bool, looks.pieces.count) : NULL;
  if (done && !marked) done = spore_mesh_no_memory(error);
  if (done) {
    for (size_t i = 0; i < looks.count; i++)
      marked[looks.look[i].piece - looks.pieces.pieces] = i == 0 || is_within(looks.look + i, looks.look);
    for (size_t i = 0; i < looks.pieces.count; i++) work->unwanted += !marked[i];
    done = keep(work, looks.pieces.of, marked, error);
  }
  spore_free(marked);
  clear_looks(&looks);
  return done;
}

char *spore_tetrahedra_piece_called(const SporeTetrahedraReport *report, int number) {
  const char *name = report->piece[number].name;
  int alike = 0, before = 0;
  for (int i = 0; i < (int)report->piece_count; i++) {
    if (strcmp(report->piece[i].name, name) != 0) continue;
    alike++;
    before += i <= number;
  }
  if (!*name) return g_strdup_printf(_("piece %d"), number + 1);
  return alike > 1 ? g_strdup_printf("%s (%d)", name, before) : g_strdup(name);
}

static char *merged_text(const SporeTetrahedraReport *report, const SporeTetrahedraPiece *piece) {
  g_autofree char *in = piece->in >= 0 ? spore_tetrahedra_piece_called(report, piece->in) : g_strdup(_("others"));
  const double least = 1e3 * piece->depth[0], most = 1e3 * piece->depth[1];
  if (piece->wall == SPORE_WALL_LUMEN)
    return g_strdup_printf(_("an open wall inside %s, turned inward: what it holds is cut out"), in);
  switch (piece->role) {
  case SPORE_PIECE_BOUNDS:
    return g_strdup(_("bounds the solid"));
  case SPORE_PIECE_MERGED:
    return g_strdup_printf(_("merged with what it lies in: %.0f %% of it, most of that in %s"),
                           100 * piece->inside_share, in);
  case SPORE_PIECE_INSIDE:
    if (piece->in < 0) return g_strdup(_("a wall inside the solid: left out"));
    return g_strdup_printf(_("a wall inside %s, %.2g to %.2g mm from its surface: left out"), in, least, most);
  case SPORE_PIECE_CAVITY:
    if (piece->in < 0) return g_strdup(_("bounds a cavity"));
    return g_strdup_printf(_("bounds a cavity in %s, %.2g to %.2g mm from its surface"), in, least, most);
  default:
    return g_strdup(_("a sheet that encloses nothing: left out"));
  }
}

double spore_tetrahedra_cells_for(const SporeTetrahedraReport *report, const SporeTetrahedraPiece *piece) {
  const double edges = piece->merged < 0 ? SPORE_TETRAHEDRA_SEEN : SPORE_TETRAHEDRA_THIN;
  const double cells = report->volume_given / (SPORE_TETRAHEDRA_CELL * pow(piece->thickness / edges, 3));
  const double step = pow(10, floor(log10(cells)) - 1);
  return step * ceil(cells / step);
}

/* How many cells would do for a piece that has none. */
static char *enough_text(double enough) {
  if (enough > SPORE_TETRAHEDRA_CELLS) return g_strdup(_("no number of cells would do"));
  return g_strdup_printf(_("about %.0f cells in all would do"), enough);
}

/* Why a piece that is kept apart has no cells, and how many would do. */
static char *no_cells_text(const SporeTetrahedraReport *report, const SporeTetrahedraPiece *piece) {
  size_t cells = 0;
  if (!(piece->thickness > 0))
    return g_strdup(_("no cells of its own: it is too thin for them, or its place is that of smaller pieces"));
  for (size_t i = 0; i < report->piece_count; i++) cells += report->piece[i].cells;
  const double enough = spore_tetrahedra_cells_for(report, piece), thickness = 1e3 * piece->thickness;
  g_autofree char *remedy = enough_text(enough);
  if (piece->merged < 0 && enough < (double)cells)
    return g_strdup(_("no cells of its own: its place is that of smaller pieces, or a hollow"));
  if (piece->merged < 0)
    return g_strdup_printf(
        piece->inside_share > 0
            ? _("about %.2g mm thick, too thin for cells of its own: left to what is around it; %s")
            : _("about %.2g mm thick, too thin for cells of its own, and nothing is around it: left out; %s"),
        thickness, remedy);
  g_autofree char *to = spore_tetrahedra_piece_called(report, piece->merged);
  return g_strdup_printf(_("about %.2g mm thick, too thin for cells of its own: merged with %s, which it touches; %s"),
                         thickness, to, remedy);
}

/* What a piece is to the solid, and its cells where pieces are kept apart. */
static char *role_text(const SporeTetrahedraReport *report, const SporeTetrahedraPiece *piece, bool apart) {
  if (!apart || !piece->parted) return merged_text(report, piece);
  g_autofree char *in =
      piece->in >= 0 && report->piece[piece->in].parted ? spore_tetrahedra_piece_called(report, piece->in) : NULL;
  if (!piece->cells) return no_cells_text(report, piece);
  if (!in) return g_strdup_printf(_("cells of its own: %zu"), piece->cells);
  return g_strdup_printf(_("cells of its own: %zu; %.0f %% of it lie inside, most of that in %s"), piece->cells,
                         100 * piece->inside_share, in);
}

void spore_tetrahedra_say_pieces(GString *text, const SporeTetrahedraOptions *options,
                                 const SporeTetrahedraReport *report) {
  if (report->unwanted)
    g_string_append_printf(text, _("pieces left out, as asked: %zu; the largest one is kept, and what lies in it\n"),
                           report->unwanted);
  if (report->piece_count < 2 && !report->piece[0].holes) return;
  for (size_t i = 0; i < report->piece_count; i++) {
    const SporeTetrahedraPiece *piece = report->piece + i;
    g_autofree char *name = spore_tetrahedra_piece_called(report, (int)i),
                    *role = role_text(report, piece, options->apart);
    g_string_append_printf(text, _("%s: %zu triangles, %.3g x %.3g x %.3g mm; %s"), name, piece->triangles,
                           1e3 * piece->size[0], 1e3 * piece->size[1], 1e3 * piece->size[2], role);
    if (piece->holes && piece->role != SPORE_PIECE_SHEET && piece->role != SPORE_PIECE_INSIDE &&
        piece->wall != SPORE_WALL_LUMEN)
      g_string_append_printf(text, _("; holes that are closed: %zu, of %zu open edges"), piece->holes,
                             piece->open_edges);
    g_string_append_c(text, '\n');
  }
  if (report->piece_total > report->piece_count)
    g_string_append_printf(text, _("%zu smaller pieces are not listed\n"), report->piece_total - report->piece_count);
}
