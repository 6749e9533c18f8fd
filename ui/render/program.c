/* Shader programs: each is compiled in its variants when it is first needed. */
#include <gio/gio.h>
#include <glib/gi18n.h>

#include "ui/render/colour_scale.h"
#include "ui/render/passes.h"
#include "ui/render/shaders.h"

#define PREFIX "/spore/shaders/"

typedef struct ProgramSource {
  const char *vertex, *fragment, *define; /* define: put before both, may be NULL */
} ProgramSource;

/* A driver that draws on processors computes both ways of every condition, whichever is taken. So what most surfaces
 * need has a program without the rest. */
static const ProgramSource sources[SPORE_PROGRAM_COUNT] = {
    [SPORE_PROGRAM_SURFACE] = {"surface.vert", "surface.frag"},
    [SPORE_PROGRAM_TEXTURED_SURFACE] = {"surface.vert", "surface.frag", "#define TEXTURED\n"},
    [SPORE_PROGRAM_TISSUE] = {"surface.vert", "surface.frag", "#define ONLY 0\n"},
    [SPORE_PROGRAM_TEXTURED_TISSUE] = {"surface.vert", "surface.frag", "#define ONLY 0\n#define TEXTURED\n"},
    [SPORE_PROGRAM_METAL] = {"surface.vert", "surface.frag", "#define ONLY 1\n"},
    [SPORE_PROGRAM_LIQUID] = {"surface.vert", "surface.frag", "#define ONLY 2\n"},
    [SPORE_PROGRAM_SPHERE] = {"sphere.vert", "sphere.frag"},
    [SPORE_PROGRAM_HIDDEN_SPHERE] = {"sphere.vert", "sphere.frag", "#define HIDDEN\n"},
    [SPORE_PROGRAM_PUFF] = {"puff.vert", "puff.frag"},
    [SPORE_PROGRAM_LINE] = {"line.vert", "line.frag"},
    [SPORE_PROGRAM_BACKGROUND] = {"screen.vert", "background.frag"},
    [SPORE_PROGRAM_OCCLUSION] = {"screen.vert", "occlusion.frag"},
    [SPORE_PROGRAM_SMOOTH] = {"screen.vert", "smooth.frag"},
    [SPORE_PROGRAM_GLOW] = {"screen.vert", "glow.frag"},
    [SPORE_PROGRAM_COMPOSITE] = {"screen.vert", "composite.frag"},
    [SPORE_PROGRAM_LENS] = {"screen.vert", "lens.frag"},
    [SPORE_PROGRAM_DRY_LENS] = {"screen.vert", "lens.frag", "#define DRY\n"},
};

/* A narrow specular lobe of the film sparkles with one sample a pixel, so the fast variant widens the lobe. */
static const char *const preamble[SPORE_VARIANT_COUNT] = {
    [SPORE_VARIANT_FAST] = "#version 330 core\n#define QUALITY 0\n#define DEPTH_ONLY 0\n#define FILM_ALPHA 0.03\n",
    [SPORE_VARIANT_FULL] = "#version 330 core\n#define QUALITY 1\n#define DEPTH_ONLY 0\n#define FILM_ALPHA 0.018\n",
    [SPORE_VARIANT_DEPTH] = "#version 330 core\n#define QUALITY 1\n#define DEPTH_ONLY 1\n",
    [SPORE_VARIANT_SHADOW] = "#version 330 core\n#define QUALITY 1\n#define DEPTH_ONLY 2\n",
};

static GBytes *shader_text(const char *name) {
  char *path = g_strconcat(PREFIX, name, NULL);
  GBytes *text = g_resource_lookup_data(spore_shaders_get_resource(), path, G_RESOURCE_LOOKUP_FLAGS_NONE, NULL);
  g_free(path);
  g_assert(text);
  return text;
}

static gboolean refused(const char *name, const char *log, GError **error) {
  return spore_error_raise(
      error, SPORE_ERROR_UNSUPPORTED, name,
      _("the graphics driver refuses the shader: %s; OpenGL 3.3 was expected; update the driver, or "
        "set LIBGL_ALWAYS_SOFTWARE=1"),
      log);
}

static GLuint compile_shader(GLenum stage, const char *name, const char *define, SporeVariant variant, GError **error) {
  const char *parts[] = {"frame.glsl", "colour.glsl", "visibility.glsl", "tissue.glsl", name};
  GBytes *texts[G_N_ELEMENTS(parts)];
  g_autofree char *scale = spore_colour_scale_shader();
  const char *strings[G_N_ELEMENTS(parts) + 3] = {preamble[variant], define ? define : "", scale};
  GLint lengths[G_N_ELEMENTS(parts) + 3] = {-1, -1, -1};
  guint count = 3;
  for (guint i = 0; i < G_N_ELEMENTS(parts); i++) {
    gsize size;
    texts[i] = shader_text(parts[i]);
    /* Light is computed in fragments that have a colour. */
    if (i > 0 && i + 1 < G_N_ELEMENTS(parts) && (stage == GL_VERTEX_SHADER || variant >= SPORE_VARIANT_DEPTH)) continue;
    strings[count] = g_bytes_get_data(texts[i], &size);
    lengths[count++] = (GLint)size;
  }
  GLuint shader = glCreateShader(stage);
  glShaderSource(shader, (GLsizei)count, strings, lengths);
  glCompileShader(shader);
  for (guint i = 0; i < G_N_ELEMENTS(parts); i++) g_bytes_unref(texts[i]);
  GLint good;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  char log[1024] = "";
  glGetShaderInfoLog(shader, sizeof log, NULL, log);
  glDeleteShader(shader);
  refused(name, log, error);
  return 0;
}

static GLuint link_program(const ProgramSource *source, SporeVariant variant, GError **error) {
  GLuint vertex = compile_shader(GL_VERTEX_SHADER, source->vertex, source->define, variant, error);
  GLuint fragment = vertex ? compile_shader(GL_FRAGMENT_SHADER, source->fragment, source->define, variant, error) : 0;
  GLuint id = 0;
  if (fragment) {
    GLint good;
    id = glCreateProgram();
    glAttachShader(id, vertex);
    glAttachShader(id, fragment);
    glLinkProgram(id);
    glGetProgramiv(id, GL_LINK_STATUS, &good);
    if (!good) {
      char log[1024] = "";
      glGetProgramInfoLog(id, sizeof log, NULL, log);
      glDeleteProgram(id);
      id = 0;
      refused(source->fragment, log, error);
    }
  }
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  return id;
}

static void set_sampler(GLuint id, const char *name, int unit) {
  GLint location = glGetUniformLocation(id, name);
  if (location >= 0) glUniform1i(location, unit);
}

static void find_uniforms(SporeProgram *program) {
  GLuint id = program->id;
  GLuint block = glGetUniformBlockIndex(id, "Frame");
  if (block != GL_INVALID_INDEX) glUniformBlockBinding(id, block, 0);
  program->offset = glGetUniformLocation(id, "offset");
  program->colour = glGetUniformLocation(id, "colour");
  program->wetness = glGetUniformLocation(id, "wetness");
  program->clearness = glGetUniformLocation(id, "clearness");
  program->mixture = glGetUniformLocation(id, "mixture");
  program->cell = glGetUniformLocation(id, "cell");
  program->selected = glGetUniformLocation(id, "selected");
  program->material = glGetUniformLocation(id, "material");
  program->axis = glGetUniformLocation(id, "axis");
  program->dim = glGetUniformLocation(id, "dim");
  program->width = glGetUniformLocation(id, "width");
  program->near = glGetUniformLocation(id, "near");
  program->fade = glGetUniformLocation(id, "fade");
  program->direction = glGetUniformLocation(id, "direction");
  glUseProgram(id);
  set_sampler(id, "occlusion_map", SPORE_UNIT_OCCLUSION);
  set_sampler(id, "shadow_map", SPORE_UNIT_SHADOW);
  set_sampler(id, "colour_map", SPORE_UNIT_COLOUR);
  set_sampler(id, "depth_map", SPORE_UNIT_DEPTH);
  set_sampler(id, "glow_map", SPORE_UNIT_GLOW);
  set_sampler(id, "texture_map", SPORE_UNIT_TEXTURE);
}

const SporeProgram *spore_programs_get(SporePrograms *programs, SporeProgramKind kind, SporeVariant variant,
                                       GError **error) {
  SporeProgram *program = &programs->programs[kind][variant];
  if (!program->id) {
    program->id = link_program(&sources[kind], variant, error);
    if (!program->id) return NULL;
    find_uniforms(program);
  }
  return program;
}

const char *spore_program_name(SporeProgramKind kind) { return sources[kind].fragment; }

void spore_programs_clear(SporePrograms *programs) {
  for (int kind = 0; kind < SPORE_PROGRAM_COUNT; kind++)
    for (int variant = 0; variant < SPORE_VARIANT_COUNT; variant++)
      if (programs->programs[kind][variant].id) glDeleteProgram(programs->programs[kind][variant].id);
  *programs = (SporePrograms){0};
}
