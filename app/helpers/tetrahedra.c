/* spore-tetrahedra: makes surfaces fit for meshing, and meshes them, in the sandbox. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/helpers/cgal.h"
#include "core/io/tetrahedra_wire.h"
#include "core/io/helper.h"

#define N_(text) text
#define MOST 20000000u /* vertices, triangles */

/* The next `count` elements of the request, malloc'ed; NULL: the request has fewer, or there is no memory. */
static void *take(const char **at, size_t *left, uint64_t count, size_t size) {
  if (count > *left / size) return NULL;
  void *content = malloc(count ? count * size : 1);
  if (!content) return NULL;
  memcpy(content, *at, count * size);
  *at += count * size;
  *left -= count * size;
  return content;
}

static bool read_request(const char *request, size_t size, SporeTetrahedraRequest *head, SporeFlatMesh *surface,
                         SporeSizing *sizing) {
  if (size < sizeof *head) return false;
  memcpy(head, request, sizeof *head);
  const char *at = request + sizeof *head;
  size_t left = size - sizeof *head, nodes = 1;
  if (head->vertex_count > MOST || head->triangle_count > MOST) return false;
  surface->vertex_count = head->vertex_count;
  surface->cell_count = head->triangle_count;
  surface->vertices = take(&at, &left, 3 * head->vertex_count, sizeof(double));
  surface->corners = take(&at, &left, 3 * head->triangle_count, sizeof(uint32_t));
  sizing->spacing = head->sizing_spacing;
  for (int k = 0; k < 3; k++) {
    if (head->sizing_count[k] > SPORE_SIZING_NODES) return false;
    sizing->count[k] = head->sizing_count[k];
    sizing->lower[k] = head->sizing_lower[k];
    nodes *= sizing->count[k];
  }
  sizing->size = take(&at, &left, nodes, sizeof(double));
  if (!surface->vertices || !surface->corners || !sizing->size || left) return false;
  for (size_t i = 0; i < 3 * surface->cell_count; i++)
    if (surface->corners[i] >= surface->vertex_count) return false;
  return true;
}

static bool perform(const SporeTetrahedraRequest *head, const SporeFlatMesh *surface, const SporeSizing *sizing,
                    SporeFlatMesh *result, SporeHelperFailure *failure) {
  switch ((SporeTetrahedraTask)head->task) {
  case SPORE_TETRAHEDRA_CHECK:
    spore_helper_send_progress(0, N_("checking the surface"));
    *result = *surface;
    return spore_cgal_check(surface, failure);
  case SPORE_TETRAHEDRA_REPAIR:
    spore_helper_send_progress(0, N_("repairing the surface"));
    return spore_cgal_repair(surface, result, failure);
  case SPORE_TETRAHEDRA_WRAP:
    spore_helper_send_progress(0, N_("wrapping the surface"));
    return spore_cgal_wrap(surface, head->alpha, head->offset, head->most_vertices, result, failure);
  case SPORE_TETRAHEDRA_MESH:
    return spore_cgal_mesh(surface, sizing, (SporeTetrahedraFinish)head->finish, head->most_vertices,
                           spore_helper_send_progress, result, failure);
  default:
    _exit(1);
  }
}

static void send_mesh(const SporeFlatMesh *mesh, uint64_t corners) {
  SporeTetrahedraAnswer head = {mesh->vertex_count, mesh->cell_count, corners};
  size_t vertex_bytes = mesh->vertex_count * 3 * sizeof(double),
         corner_bytes = mesh->cell_count * corners * sizeof(uint32_t);
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
  SporeSizing sizing;
  SporeHelperFailure failure;
  if (!spore_helper_read_request(&request, &size) || !read_request(request, size, &head, &surface, &sizing)) _exit(1);
  if (perform(&head, &surface, &sizing, &result, &failure))
    send_mesh(&result, head.task == SPORE_TETRAHEDRA_MESH ? 4 : 3);
  else spore_helper_send_error(failure.code, failure.message, failure.detail);
  _exit(0);
}
