/* An OpenGL context without a window, by EGL. */
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <glib/gi18n.h>
#include <string.h>

#include "ui/render/renderer.h"

struct SporeOffscreen {
  EGLDisplay display;
  EGLContext context;
  char *renderer;
  gboolean software;
};

static gboolean no_opengl(GError **error, const char *what) {
  return spore_error_raise(error, SPORE_ERROR_UNSUPPORTED, _("graphics"),
                           _("%s; pictures need EGL with OpenGL 3.3; install Mesa (libegl1, libgl1-mesa-dri) or the "
                             "graphics card's driver"),
                           what);
}

static EGLDisplay display_of(EGLenum platform, void *native) {
  EGLDisplay display = eglGetPlatformDisplayEXT(platform, native, NULL);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, NULL, NULL)) return display;
  return EGL_NO_DISPLAY;
}

static EGLDisplay device_display(void) {
  EGLDeviceEXT devices[16];
  EGLint count = 0;
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") ||
      !(epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") ||
        epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base")) ||
      !eglQueryDevicesEXT(G_N_ELEMENTS(devices), devices, &count))
    return EGL_NO_DISPLAY;
  for (EGLint i = 0; i < count; i++) {
    EGLDisplay display = display_of(EGL_PLATFORM_DEVICE_EXT, devices[i]);
    if (display != EGL_NO_DISPLAY) return display;
  }
  return EGL_NO_DISPLAY;
}

/* The display belongs to the process, and others may use it (a second context, the toolkit), so it is never terminated.
 * No X server or compositor is needed: Mesa's surfaceless platform is used, else the first device that opens. */
static EGLDisplay open_display(GError **error) {
  /* epoxy ends the process when a function is called that no driver provides. */
  if (!epoxy_has_egl()) {
    no_opengl(error, _("there is no EGL library"));
    return EGL_NO_DISPLAY;
  }
  EGLDisplay display = EGL_NO_DISPLAY;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base")) {
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
      display = display_of(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY);
    if (display == EGL_NO_DISPLAY) display = device_display();
  }
  if (display == EGL_NO_DISPLAY) no_opengl(error, _("EGL finds no driver that draws without a screen"));
  return display;
}

static gboolean create_context(SporeOffscreen *offscreen, GError **error) {
  static const EGLint config_attributes[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  static const EGLint context_attributes[] = {
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  EGLConfig config = NULL;
  EGLint count = 0;
  if (!epoxy_has_egl_extension(offscreen->display, "EGL_KHR_surfaceless_context"))
    return no_opengl(error, _("the driver cannot draw without a surface"));
  if (!eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(offscreen->display, config_attributes, &config, 1, &count) ||
      count < 1)
    return no_opengl(error, _("the driver has no OpenGL"));
  offscreen->context = eglCreateContext(offscreen->display, config, EGL_NO_CONTEXT, context_attributes);
  if (offscreen->context == EGL_NO_CONTEXT) return no_opengl(error, _("the driver has no OpenGL 3.3 core"));
  if (!spore_offscreen_make_current(offscreen)) return no_opengl(error, _("the OpenGL context cannot be used"));
  if (epoxy_gl_version() < 33) return no_opengl(error, _("the driver's OpenGL is older than 3.3"));
  return TRUE;
}

static gboolean is_software(const char *renderer) {
  return strstr(renderer, "llvmpipe") || strstr(renderer, "softpipe") || strstr(renderer, "SWR") ||
         strstr(renderer, "swrast") || strstr(renderer, "SwiftShader");
}

SporeOffscreen *spore_offscreen_new(GError **error) {
  EGLDisplay display = open_display(error);
  if (display == EGL_NO_DISPLAY) return NULL;

  SporeOffscreen *offscreen = g_new0(SporeOffscreen, 1);
  offscreen->display = display;
  offscreen->context = EGL_NO_CONTEXT;
  if (!create_context(offscreen, error)) {
    spore_offscreen_free(offscreen);
    return NULL;
  }
  offscreen->renderer = g_strdup((const char *)glGetString(GL_RENDERER));
  offscreen->software = is_software(offscreen->renderer);
  return offscreen;
}

void spore_offscreen_free(SporeOffscreen *offscreen) {
  if (!offscreen) return;
  if (offscreen->context != EGL_NO_CONTEXT) {
    if (eglGetCurrentContext() == offscreen->context)
      eglMakeCurrent(offscreen->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(offscreen->display, offscreen->context);
  }
  g_free(offscreen->renderer);
  g_free(offscreen);
}

gboolean spore_offscreen_make_current(SporeOffscreen *offscreen) {
  if (eglGetCurrentContext() == offscreen->context) return TRUE;
  return eglBindAPI(EGL_OPENGL_API) &&
         eglMakeCurrent(offscreen->display, EGL_NO_SURFACE, EGL_NO_SURFACE, offscreen->context);
}

void spore_offscreen_release(SporeOffscreen *offscreen) {
  eglMakeCurrent(offscreen->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

const char *spore_offscreen_renderer(const SporeOffscreen *offscreen) { return offscreen->renderer; }

gboolean spore_offscreen_is_software(const SporeOffscreen *offscreen) { return offscreen->software; }
