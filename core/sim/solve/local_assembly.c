/* Local assembly: adds terms on nodes of one body to the matrix of that body. */
#include "core/sim/solve/local_assembly.h"

#include <assert.h>

#define NODES_MAXIMUM 16 /* of both ends of a term */

/* The nodes whose motion makes up the motion of one end relative to the other, and their weights. */
typedef struct Nodes {
  size_t count;
  uint32_t block[NODES_MAXIMUM];
  double weight[NODES_MAXIMUM];
} Nodes;

static bool add_end(Nodes *nodes, const SporeEnd *end, double sign) {
  assert(end->prescribed || end->point < end->mapping->point_count);
  if (end->prescribed) return true;
  const SporeMapping *mapping = end->mapping;
  if (mapping->kind == SPORE_MAPPING_IDENTITY) {
    nodes->block[nodes->count] = end->point;
    nodes->weight[nodes->count++] = sign;
    return true;
  }
  if (mapping->kind != SPORE_MAPPING_LINEAR) return false;
  uint32_t start = mapping->row_start[end->point], stop = mapping->row_start[end->point + 1];
  if (nodes->count + (stop - start) > NODES_MAXIMUM) return false;
  for (uint32_t k = start; k < stop; k++) {
    nodes->block[nodes->count] = mapping->block[k];
    nodes->weight[nodes->count++] = sign * mapping->weight[k];
  }
  return true;
}

static bool find_nodes(Nodes *nodes, const SporeEnd *a, const SporeEnd *b) {
  nodes->count = 0;
  return add_end(nodes, a, 1) && add_end(nodes, b, -1);
}

static size_t find_block(const SporeBlockMatrix *matrix, uint32_t i, uint32_t j) {
  assert(i < matrix->block_count && j < matrix->block_count);
  return i == j ? matrix->diagonal[i] : spore_block_matrix_find(matrix, i, j);
}

uint32_t spore_island_system_local_body(const SporeIslandSystem *system, const SporeEnd *a, const SporeEnd *b) {
  assert(!a->prescribed || !b->prescribed);
  if (!a->prescribed && !b->prescribed && a->body != b->body) return SPORE_NO_BODY;
  uint32_t index = a->prescribed ? b->body : a->body;
  const SporeBody *body = &system->world->bodies[index];
  Nodes nodes;
  if (!spore_island_system_assembles(system, body) || !find_nodes(&nodes, a, b)) return SPORE_NO_BODY;
  for (size_t i = 0; i < nodes.count; i++)
    for (size_t j = 0; j < i; j++)
      if (find_block(&body->preconditioner.matrix, nodes.block[i], nodes.block[j]) == SIZE_MAX) return SPORE_NO_BODY;
  return index;
}

void spore_body_assemble_term(SporeBody *body, const SporeEnd *a, const SporeEnd *b, const SporeMat3 *k) {
  assert(body->preconditioner.matrix.block_count == body->block_count);
  Nodes nodes;
  find_nodes(&nodes, a, b);
  for (size_t i = 0; i < nodes.count; i++)
    for (size_t j = 0; j < nodes.count; j++) {
      double scale = nodes.weight[i] * nodes.weight[j];
      double *block = body->preconditioner.matrix.values +
                      9 * find_block(&body->preconditioner.matrix, nodes.block[i], nodes.block[j]);
      for (int e = 0; e < 9; e++) block[e] += scale * k->m[e];
    }
}

void spore_body_assemble_bend(SporeBody *body, const SporeCurveJointBend *bend) {
  assert(bend->first + SPORE_PATH_WIDTH <= body->block_count);
  for (size_t i = 0; i < SPORE_PATH_WIDTH; i++)
    for (size_t j = 0; j < SPORE_PATH_WIDTH; j++) {
      SporeMat3 k = spore_curve_joint_bend_block(bend, i, j);
      size_t at = find_block(&body->preconditioner.matrix, (uint32_t)(bend->first + i), (uint32_t)(bend->first + j));
      for (int e = 0; e < 9; e++) body->preconditioner.matrix.values[9 * at + (size_t)e] += k.m[e];
    }
}

static bool couples(const SporeIslandSystem *system) {
  for (size_t i = 0; i < system->island->contact_count; i++) {
    const SporeContactTerm *term = spore_island_system_contact(system, i);
    if (spore_island_system_local_body(system, &term->a, &term->b) == SPORE_NO_BODY) return true;
  }
  for (size_t i = 0; i < system->island->spring_count; i++) {
    const SporeSpringTerm *term = spore_island_system_spring(system, i);
    if (spore_island_system_local_body(system, &term->a, &term->b) == SPORE_NO_BODY) return true;
  }
  return false;
}

bool spore_island_system_couples(SporeIslandSystem *system) {
  if (!system->asked_couples) system->couples = couples(system);
  system->asked_couples = true;
  return system->couples;
}
