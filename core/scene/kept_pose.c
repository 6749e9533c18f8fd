/* Writes and reads kept poses, and tells whether they still are of their bodies. */
#include "core/scene/kept_pose.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/hash.h"

#define HEAD "spore-pose 1\n"
#define NUMBERS_A_LOOK 4096 /* between two looks at whether to go on */
#define FRAME 7             /* numbers of a frame: position, quaternion wxyz */

/* Doubles in the q of a body, without those of spare nodes. */
static gsize numbers_of(const SporeModel *model) { return model ? model->q_count - 3 * model->spare_count : FRAME; }

/* Hash of what a state of the body is a state of: the model, and where it puts its nodes. Coordinates count as floats:
 * machines may differ in the last bit. */
static guint64 hash_of(const SporeModel *model) {
  const SporePose still = {{0, 0, 0}, {1, 0, 0, 0}};
  if (!model) return SPORE_HASH_INIT;
  gsize count = numbers_of(model);
  g_autofree double *q = g_new0(double, model->q_room), *v = g_new0(double, 3 * model->block_room);
  guint64 hash = spore_hash(SPORE_HASH_INIT, model->type->name, strlen(model->type->name) + 1);
  model->type->place(model, still, (SporeVec3){0, 0, 0}, (SporeVec3){0, 0, 0}, q, v);
  for (gsize i = 0; i < count; i++) {
    float place = (float)q[i] + 0.0f;
    hash = spore_hash(hash, &place, sizeof place);
  }
  return hash;
}

static void append_number(GString *text, double number, char after) {
  char digits[G_ASCII_DTOSTR_BUF_SIZE];
  g_string_append(text, g_ascii_dtostr(digits, sizeof digits, number));
  g_string_append_c(text, after);
}

SporeKeptPose spore_kept_pose_take(const SporeModel *model, SporePose frame, const double *q) {
  SporeKeptPose pose = {.hash = hash_of(model), .frame = frame, .count = numbers_of(model)};
  pose.q = g_memdup2(q, pose.count * sizeof *q);
  return pose;
}

void spore_kept_pose_clear(SporeKeptPose *pose) { g_clear_pointer(&pose->q, g_free); }

char *spore_kept_pose_format(const SporeKeptPose *pose, const SporeProgress *progress, gsize *size, GError **error) {
  const SporePose *frame = &pose->frame;
  const double at[FRAME] = {frame->position.x,    frame->position.y,    frame->position.z,   frame->orientation.w,
                            frame->orientation.x, frame->orientation.y, frame->orientation.z};
  g_autoptr(GString) text = g_string_new(HEAD);
  g_string_append_printf(text, "of %016" G_GINT64_MODIFIER "x\nat ", pose->hash);
  for (int i = 0; i < FRAME; i++) append_number(text, at[i], i < FRAME - 1 ? ' ' : '\n');
  g_string_append_printf(text, "numbers %" G_GSIZE_FORMAT "\n", pose->count);
  for (gsize i = 0; i < pose->count; i++) {
    if (i % NUMBERS_A_LOOK == 0 && !spore_progress(progress, (double)i / (double)pose->count, NULL)) {
      spore_error_raise(error, SPORE_ERROR_CANCELLED, NULL, "%s", _("cancelled"));
      return NULL;
    }
    append_number(text, pose->q[i], '\n');
  }
  *size = text->len;
  return g_string_free(g_steal_pointer(&text), FALSE);
}

/* Reading. */

typedef struct Reader {
  const char *place, *at;
  gsize line;
  GError **error;
} Reader;

static gboolean refuse(const Reader *reader, const char *expected) {
  return spore_error_raise(reader->error, SPORE_ERROR_INPUT, reader->place,
                           _("line %zu: expected %s; keep the pose again, or take kept_pose out"), reader->line,
                           expected);
}

/* Takes a word and the blank behind it. */
static gboolean take_word(Reader *reader, const char *word) {
  if (!g_str_has_prefix(reader->at, word)) return refuse(reader, word);
  reader->at += strlen(word);
  return TRUE;
}

/* Takes `count` finite numbers with `between` behind each but the last, which a line's end follows. */
static gboolean take_numbers(Reader *reader, double *numbers, gsize count, char between) {
  for (gsize i = 0; i < count; i++) {
    char *stop, after = i + 1 < count ? between : '\n';
    numbers[i] = g_ascii_strtod(reader->at, &stop);
    if (g_ascii_isspace(*reader->at) || stop == reader->at || !isfinite(numbers[i]) || *stop != after)
      return refuse(reader, _("a finite number"));
    if (after == '\n') reader->line++;
    reader->at = stop + 1;
  }
  return TRUE;
}

static gboolean take_hash(Reader *reader, guint64 *hash) {
  char *stop;
  if (!take_word(reader, "of ")) return FALSE;
  *hash = g_ascii_strtoull(reader->at, &stop, 16);
  if (stop != reader->at + 16 || *stop != '\n') return refuse(reader, _("16 hexadecimal digits"));
  reader->at = stop + 1;
  reader->line++;
  return TRUE;
}

static gboolean is_unit(const double w[4]) {
  return fabs(w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + w[3] * w[3] - 1) < 1e-6;
}

/* What a file holds. */
typedef struct Kept {
  guint64 hash;
  double at[FRAME], *q;
  gsize count;
} Kept;

/* The whole file. Numbers are bounded by the bytes that there are. */
static gboolean read_text(Reader *reader, gsize size, Kept *kept) {
  double count;
  if (!take_word(reader, HEAD)) return FALSE;
  reader->line = 2;
  if (!take_hash(reader, &kept->hash) || !take_word(reader, "at ") || !take_numbers(reader, kept->at, FRAME, ' ') ||
      !take_word(reader, "numbers ") || !take_numbers(reader, &count, 1, ' '))
    return FALSE;
  if (!is_unit(kept->at + 3)) return refuse(reader, _("an orientation of unit length"));
  if (!(count >= 3 && count <= (double)size && floor(count) == count))
    return refuse(reader, _("as many numbers as the file has"));
  kept->count = (gsize)count;
  kept->q = g_new(double, kept->count);
  return take_numbers(reader, kept->q, kept->count, '\n') && (*reader->at == '\0' || refuse(reader, _("its end")));
}

static gboolean read_file(SporeDocument *document, const char *file, Kept *kept, GError **error) {
  g_autoptr(GBytes) content = spore_document_read_asset(document, file, error);
  if (!content) return FALSE;
  gsize size;
  const char *bytes = g_bytes_get_data(content, &size);
  g_autofree char *text = g_strndup(bytes, size);
  Reader reader = {.place = file, .at = text, .line = 1, .error = error};
  return read_text(&reader, size, kept);
}

/* Moves nodes and frame as the scene has moved the body's frame since. Nothing changes, to the bit, where it stands as
 * it did. */
static void follow_frame(const SporeModel *model, SporePose frame, Kept *kept) {
  const SporePose old = spore_pose_load(kept->at);
  if (memcmp(&old, &frame, sizeof old) == 0) return;
  gsize nodes = model ? model->node_count - model->spare_count : 1;
  gsize turn = !model ? 3 : model->type->inertia ? 3 * model->node_count : SIZE_MAX;
  SporeQuat turned = spore_quat_multiply(frame.orientation, spore_quat_conjugate(old.orientation));
  for (gsize i = 0; i < nodes; i++)
    spore_vec3_store(kept->q + 3 * i,
                     spore_pose_apply(frame, spore_pose_apply_inverse(old, spore_vec3_load(kept->q + 3 * i))));
  if (turn != SIZE_MAX)
    spore_quat_store(kept->q + turn,
                     spore_quat_normalise(spore_quat_multiply(turned, spore_quat_load(kept->q + turn))));
}

static double volume_of(const double *nodes, const guint32 *corner) {
  SporeVec3 a = spore_vec3_load(nodes + 3 * (gsize)corner[0]);
  SporeVec3 b = spore_vec3_sub(spore_vec3_load(nodes + 3 * (gsize)corner[1]), a);
  SporeVec3 c = spore_vec3_sub(spore_vec3_load(nodes + 3 * (gsize)corner[2]), a);
  SporeVec3 d = spore_vec3_sub(spore_vec3_load(nodes + 3 * (gsize)corner[3]), a);
  return spore_vec3_dot(spore_vec3_cross(b, c), d);
}

gsize spore_kept_pose_inverted(SporeDocument *document, const SporeObject *body, const SporeModel *model,
                               const double *q) {
  const SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  SporeObject *asset = model && mechanical ? spore_object_reference(mechanical, "geometry") : NULL;
  if (!asset || model->type->geometry != SPORE_GEOMETRY_TETRAHEDRA) return 0;
  const SporeTetrahedralMesh *mesh = spore_document_tetrahedra(document, asset, NULL);
  gsize inverted = 0;
  if (!mesh || mesh->vertex_count != model->node_count - model->spare_count) return 0;
  for (gsize i = 0; i < mesh->tetrahedron_count; i++) {
    const guint32 *corner = mesh->tetrahedra + 4 * i;
    inverted += volume_of(q, corner) * volume_of(mesh->vertices, corner) <= 0;
  }
  return inverted;
}

/* Particles that are out of the world stay there: their poses do not go with the frame. */
static gboolean is_of(const Kept *kept, const SporeModel *model, SporePose frame) {
  const SporePose old = spore_pose_load(kept->at);
  gboolean moved = memcmp(&old, &frame, sizeof old) != 0;
  return kept->count == numbers_of(model) && kept->hash == hash_of(model) &&
         !(moved && model && model->type->particles);
}

gboolean spore_kept_pose_read(SporeDocument *document, const SporeObject *body, const SporeModel *model,
                              SporePose frame, SporeKeptPoseState *state, double **q, gsize *count, GError **error) {
  const char *file = spore_object_text(body, "kept_pose");
  Kept kept = {0};
  *state = SPORE_POSE_NONE, *q = NULL, *count = 0;
  if (!file) return TRUE;
  if (!read_file(document, file, &kept, error)) {
    g_free(kept.q);
    return FALSE;
  }
  *state = is_of(&kept, model, frame) ? SPORE_POSE_FRESH : SPORE_POSE_STALE;
  if (*state == SPORE_POSE_FRESH) follow_frame(model, frame, &kept);
  gsize inverted = *state == SPORE_POSE_FRESH ? spore_kept_pose_inverted(document, body, model, kept.q) : 0;
  if (*state == SPORE_POSE_FRESH && inverted == 0) *q = g_steal_pointer(&kept.q), *count = kept.count;
  g_free(kept.q);
  return inverted == 0 ||
         spore_error_raise(error, SPORE_ERROR_INPUT, file,
                           _("%zu tetrahedra of \"%s\" are inside out in it; expected none; keep another pose, or take "
                             "kept_pose out"),
                           inverted, spore_object_name(body));
}

guint spore_document_kept_poses(const SporeDocument *document) {
  const SporeObject *bodies = spore_document_section(document, "bodies");
  guint kept = 0;
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    kept += spore_object_text(spore_object_child(bodies, i), "kept_pose") != NULL;
  return kept;
}
