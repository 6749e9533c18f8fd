/* A framebuffer with colour and depth, as textures or as renderbuffers. */
#include <glib/gi18n.h>

#include "ui/render/passes.h"

static GLuint make_texture(GLenum format, int width, int height, gboolean depth) {
  gboolean stencil = format == GL_DEPTH24_STENCIL8;
  GLenum content = stencil ? GL_DEPTH_STENCIL : depth ? GL_DEPTH_COMPONENT : GL_RGBA;
  GLuint texture;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, (GLint)format, width, height, 0, content,
               stencil ? GL_UNSIGNED_INT_24_8
               : depth ? GL_UNSIGNED_INT
                       : GL_UNSIGNED_BYTE,
               NULL);
  GLint filter = depth ? GL_NEAREST : GL_LINEAR;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

static GLuint attach(const SporeTarget *target, GLenum point, GLenum format, gboolean depth) {
  GLuint name;
  if (target->samples == 0) {
    name = make_texture(format, target->width, target->height, depth);
    glFramebufferTexture2D(GL_FRAMEBUFFER, point, GL_TEXTURE_2D, name, 0);
  } else {
    glGenRenderbuffers(1, &name);
    glBindRenderbuffer(GL_RENDERBUFFER, name);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, target->samples, format, target->width, target->height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, point, GL_RENDERBUFFER, name);
  }
  return name;
}

gboolean spore_target_prepare(SporeTarget *target, int width, int height, int samples, GLenum colour_format,
                              GLenum depth_format, GError **error) {
  if (target->framebuffer && target->width == width && target->height == height && target->samples == samples)
    return TRUE;
  spore_target_clear(target);
  while (glGetError() != GL_NO_ERROR) {
  }
  target->width = width, target->height = height, target->samples = samples;
  glGenFramebuffers(1, &target->framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
  if (colour_format) target->colour = attach(target, GL_COLOR_ATTACHMENT0, colour_format, FALSE);
  else glDrawBuffer(GL_NONE), glReadBuffer(GL_NONE);
  GLenum point = depth_format == GL_DEPTH24_STENCIL8 ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT;
  if (depth_format) target->depth = attach(target, point, depth_format, TRUE);
  GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER), code = glGetError();
  if (status == GL_FRAMEBUFFER_COMPLETE && code == GL_NO_ERROR) return TRUE;
  spore_target_clear(target);
  return spore_error_raise(error, SPORE_ERROR_MEMORY, _("graphics"),
                           _("a picture of %d x %d pixels cannot be made (status %#x, error %#x); a size within the "
                             "graphics memory was expected; ask for a smaller one"),
                           width, height, status, code);
}

void spore_target_bind(const SporeTarget *target) {
  glBindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
  glViewport(0, 0, target->width, target->height);
}

void spore_target_clear(SporeTarget *target) {
  if (target->samples == 0) {
    glDeleteTextures(1, &target->colour);
    glDeleteTextures(1, &target->depth);
  } else {
    glDeleteRenderbuffers(1, &target->colour);
    glDeleteRenderbuffers(1, &target->depth);
  }
  glDeleteFramebuffers(1, &target->framebuffer);
  *target = (SporeTarget){0};
}
