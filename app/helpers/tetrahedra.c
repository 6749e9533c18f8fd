/* spore-tetrahedra: fills a surface with tetrahedra by one of three methods, in the sandbox. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/helpers/cgal.h"
#include "core/generate/tetrahedra_wire.h"
#include "core/io/helper.h"

#define N_(text) text

static bool read_surface(const char *request, size_t size, SporeTetrahedraRequest *head, SporeFlatMesh *surface) {
  if (size < sizeof *head) return false;
  memcpy(head, request, sizeof *head);
  size_t vertex_bytes = head->vertex_count * 3 * sizeof(double),
         corner_bytes = head->triangle_count * 3 * sizeof(uint32_t);
  if (size != sizeof *head + vertex_bytes + corner_bytes) return false;
  *surface = (SporeFlatMesh){head->vertex_count, head->triangle_count, malloc(vertex_bytes), malloc(corner_bytes)};
  if (!surface->vertices || !surface->corners) return false;
  memcpy(surface->vertices, request + sizeof *head, vertex_bytes);
  memcpy(surface->corners, request + sizeof *head + vertex_bytes, corner_bytes);
  return true;
}

/* Half the edge length wanted, so that walls finer than the cells melt, within what is quick and what is still the
 * shape; the surface has a diagonal of 1. Without a size: solid organs fill about a tenth of their diagonal's cube. */
static double wrap_alpha(const SporeTetrahedraRequest *head) {
  double edge = head->cells ? cbrt(0.1 / (0.12 * (double)head->cells)) : head->size;
  return fmin(fmax(0.5 * edge, 1. / 150), 1. / 50);
}

/* The surface that can be meshed: as it is, repaired or wrapped. */
static bool prepare(const SporeTetrahedraRequest *head, SporeFlatMesh *surface, SporeHelperFailure *failure) {
  SporeFlatMesh given = *surface;
  switch ((SporeTetrahedraMethod)head->method) {
  case SPORE_TETRAHEDRA_REPAIRED:
    spore_helper_send_progress(0, N_("repairing the surface"));
    return spore_cgal_repair(&given, surface, failure);
  case SPORE_TETRAHEDRA_WRAPPED:
    spore_helper_send_progress(0, N_("wrapping the surface"));
    return spore_cgal_wrap(&given, wrap_alpha(head), wrap_alpha(head) / 20, surface, failure);
  default:
    spore_helper_send_progress(0, N_("checking the surface"));
    return spore_cgal_check(surface, failure);
  }
}

static void send_mesh(const SporeFlatMesh *mesh) {
  SporeTetrahedraAnswer head = {mesh->vertex_count, mesh->cell_count};
  size_t vertex_bytes = mesh->vertex_count * 3 * sizeof(double), corner_bytes = mesh->cell_count * 4 * sizeof(uint32_t);
  char *answer = malloc(sizeof head + vertex_bytes + corner_bytes);
  if (!answer) _exit(1);
  memcpy(answer, &head, sizeof head);
  memcpy(answer + sizeof head, mesh->vertices, vertex_bytes);
  memcpy(answer + sizeof head + vertex_bytes, mesh->corners, corner_bytes);
  spore_helper_send_answer(answer, sizeof head + vertex_bytes + corner_bytes);
}

int main(int argc, char **argv) {
  spore_helper_start(argc, argv);
  void *request;
  size_t size;
  SporeTetrahedraRequest head;
  SporeFlatMesh surface, result;
  SporeHelperFailure failure;
  if (!spore_helper_read_request(&request, &size) || !read_surface(request, size, &head, &surface)) _exit(1);
  if (prepare(&head, &surface, &failure) &&
      spore_cgal_tetrahedra(&surface, head.cells, head.size, spore_helper_send_progress, &result, &failure))
    send_mesh(&result);
  else spore_helper_send_error(failure.code, failure.message, failure.detail);
  _exit(0);
}
