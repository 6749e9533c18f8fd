// The cases of case.h by Bullet: bodies of springs and of tetrahedra by its deformable world, a rope by its older soft
// bodies, rigid spheres by its rigid world.
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableMassSpringForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <vector>

#include "case.h"

static const btVector3 gravity(0, -CASE_GRAVITY, 0);

static void prepare(btSoftBodyWorldInfo &info) {
  info.m_gravity = gravity;
  info.air_density = 0;
  info.water_density = 0;
  info.m_sparsesdf.Initialize();
}

// Nothing but its own forces: no collision, drag, damping or sleep.
static void prepare(btSoftBody *body) {
  body->m_cfg.collisions = 0;
  body->m_cfg.kDP = 0;
  body->m_cfg.kDG = 0;
  body->m_cfg.drag = 0;
  body->setActivationState(DISABLE_DEACTIVATION);
  body->m_sleepingThreshold = 0;
}

static void run_steps(CaseRun *run, btDynamicsWorld *world, btSoftBody *body) {
  while (unsigned count = case_next_frame(run)) {
    for (unsigned i = 0; i < count; i++) world->stepSimulation(case_time_step(run), 0);
    case_stop(run);
    for (int i = 0; i < body->m_nodes.size(); i++) {
      const btVector3 &x = body->m_nodes[i].m_x;
      case_node(run, x.x(), x.y(), x.z());
    }
  }
}

struct Deformable {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btDeformableBodySolver bodies;
  btDeformableMultiBodyConstraintSolver constraints;
  btDeformableMultiBodyDynamicsWorld world{&dispatcher, &broadphase, &constraints, &configuration, &bodies};
  btDeformableGravityForce weight{gravity};

  explicit Deformable(bool implicit) {
    constraints.setDeformableSolver(&bodies);
    world.setGravity(gravity);
    prepare(world.getWorldInfo());
    world.setImplicit(implicit);
    world.setLineSearch(false);
    world.setUseProjection(implicit);
  }
  void run(CaseRun *run, btSoftBody *body, btDeformableLagrangianForce *force) {
    world.addSoftBody(body);
    world.addForce(body, force);
    world.addForce(body, &weight);
    run_steps(run, &world, body);
    world.removeSoftBody(body);
    case_end(run, "");
  }
};

static void cloth(CaseRun *run) {
  Deformable deformable(case_number(run, "implicit", 0) != 0);
  const double half = CLOTH_SIDE / 2, low = -CLOTH_SIDE * CLOTH_FALL, aside = CLOTH_SIDE * CLOTH_ASIDE;
  btSoftBody *body = btSoftBodyHelpers::CreatePatch(deformable.world.getWorldInfo(), btVector3(-half, 0, 0),
                                                    btVector3(half, 0, 0), btVector3(-half, low, aside),
                                                    btVector3(half, low, aside), CLOTH_NODES, CLOTH_NODES, 0, true);
  prepare(body);
  body->setTotalMass(CLOTH_MASS, true);
  for (int i = 0; i < CLOTH_NODES; i++) body->setMass(i, 0);
  btDeformableMassSpringForce springs(case_number(run, "stiffness", 100), CLOTH_DAMPING, true);
  deformable.run(run, body, &springs);
  delete body;
}

static void bar(CaseRun *run) {
  Deformable deformable(case_number(run, "implicit", 1) != 0);
  std::vector<btVector3> points(bar_nodes(1));
  for (unsigned i = 0; i < points.size(); i++) {
    double x[3];
    bar_node(1, i, x);
    points[i] = btVector3(x[0], x[1], x[2]);
  }
  btSoftBody *body = new btSoftBody(&deformable.world.getWorldInfo(), (int)points.size(), points.data(), nullptr);
  std::vector<double> mass(points.size());
  for (unsigned t = 0; t < bar_tetrahedra(1); t++) {
    unsigned n[4];
    bar_tetrahedron(1, t, n);
    const btVector3 &a = points[n[0]], &b = points[n[1]], &c = points[n[2]], &d = points[n[3]];
    double volume = btDot(b - a, btCross(c - a, d - a)) / 6;
    for (unsigned corner : n) mass[corner] += BAR_DENSITY * volume / 4;
    body->appendTetra(n[0], n[1], n[2], n[3]);
  }
  prepare(body);
  for (unsigned i = 0; i < points.size(); i++) body->setMass(i, points[i].x() == 0 ? 0 : mass[i]);
  body->initializeDmInverse();
  body->m_tetraScratches.resize(body->m_tetras.size());
  body->m_tetraScratchesTn.resize(body->m_tetras.size());
  btDeformableLinearElasticityForce elasticity(1, 1, 0, BAR_VISCOSITY);
  elasticity.setPoissonRatio(BAR_POISSON_RATIO);
  elasticity.setYoungsModulus(BAR_YOUNG_MODULUS);
  deformable.run(run, body, &elasticity);
  delete body;
}

static void rope(CaseRun *run) {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraints;
  btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &constraints, &configuration);
  world.setGravity(gravity);
  prepare(world.getWorldInfo());
  btSoftBody *body = btSoftBodyHelpers::CreateRope(world.getWorldInfo(), btVector3(0, 0, 0),
                                                   btVector3(ROPE_LENGTH, 0, 0), ROPE_NODES - 2, 1);
  prepare(body);
  body->setTotalMass(ROPE_MASS);
  body->m_cfg.piterations = (int)case_number(run, "iterations", 4);
  world.addSoftBody(body);
  run_steps(run, &world, body);
  case_end(run, "");
  world.removeSoftBody(body);
  delete body;
}

static void count_contacts(btCollisionDispatcher &dispatcher, int *count, double *depth) {
  *count = 0, *depth = 0;
  for (int i = 0; i < dispatcher.getNumManifolds(); i++) {
    const btPersistentManifold *manifold = dispatcher.getManifoldByIndexInternal(i);
    for (int k = 0; k < manifold->getNumContacts(); k++) {
      double distance = manifold->getContactPoint(k).getDistance();
      if (distance > 0) continue;
      *count += 1, *depth -= distance;
    }
  }
  if (*count) *depth /= *count;
}

static void pile(CaseRun *run) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraints;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &constraints, &configuration);
  world.setGravity(gravity);
  world.getSolverInfo().m_numIterations = (int)case_number(run, "iterations", 10);
  const double friction = sqrt(PILE_FRICTION); // a pair's coefficient is the product of its two
  const btVector3 normals[5] = {{0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int i = 0; i < 5; i++) {
    btRigidBody::btRigidBodyConstructionInfo wall(0, nullptr, new btStaticPlaneShape(normals[i], i ? -PILE_HALF : 0));
    wall.m_friction = friction;
    world.addRigidBody(new btRigidBody(wall));
  }
  btSphereShape sphere(PILE_RADIUS);
  double mass = PILE_DENSITY * 4 / 3 * SIMD_PI * PILE_RADIUS * PILE_RADIUS * PILE_RADIUS;
  btVector3 inertia;
  sphere.calculateLocalInertia(mass, inertia);
  std::vector<btRigidBody *> spheres;
  for (unsigned i = 0; i < PILE_SPHERES; i++) {
    double centre[3];
    pile_start(run, i, centre);
    btRigidBody::btRigidBodyConstructionInfo ball(mass, nullptr, &sphere, inertia);
    ball.m_startWorldTransform.setOrigin(btVector3(centre[0], centre[1], centre[2]));
    ball.m_friction = friction;
    spheres.push_back(new btRigidBody(ball));
    spheres.back()->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(spheres.back());
  }
  for (unsigned i = 0; i < (unsigned)case_number(run, "settle", 2000); i++)
    world.stepSimulation(case_time_step(run), 0);
  while (unsigned count = case_next_frame(run)) {
    for (unsigned i = 0; i < count; i++) world.stepSimulation(case_time_step(run), 0);
    case_stop(run);
    for (const btRigidBody *body : spheres) {
      const btVector3 &x = body->getWorldTransform().getOrigin();
      case_node(run, x.x(), x.y(), x.z());
    }
  }
  int count;
  double depth;
  char more[128];
  count_contacts(dispatcher, &count, &depth);
  snprintf(more, sizeof more, ", \"contacts\": %d, \"depth\": %.6g", count, depth / PILE_RADIUS);
  case_end(run, more);
}

int main(int argc, char **argv) {
  CaseRun run = case_begin(argc, argv);
  const char *name = argc > 1 ? argv[1] : "";
  if (!strcmp(name, "cloth")) cloth(&run);
  else if (!strcmp(name, "bar")) bar(&run);
  else if (!strcmp(name, "rope")) rope(&run);
  else if (!strcmp(name, "pile")) pile(&run);
  else return 2;
  return 0;
}
