/* The search for settings within a budget: several bodies that share a budget are changed together where no single
 * change helps, with few runs, and what runs say counts more than a forecast. Costs are counted, not timed. */
#include <math.h>

#include "core/author/accuracy_source.h"
#include "core/author/budget_private.h"
#include "core/integrate/integrator.h"
#include "tests/scene/fixture.h"

#define BODIES 4
#define FEW_RUNS 70 /* of 3^BODIES = 81 sets of levels, times solvers and steps */

/* A table of costs instead of a scene: bodies whose costs and squares of errors add up over their levels. */
typedef struct Table {
  SporeBudgetSearch search; /* first, since it is what measure gets */
  SporeBudget result;
  SporeAccuracyReport report;
  SporeBudgetSubject subjects[BODIES];
  double cost[BODIES][SPORE_LOD_COUNT], square[BODIES][SPORE_LOD_COUNT];
  double trap; /* added to the square where two bodies are coarse */
} Table;

static SporeAccuracyPoint point_of(const Table *table, const SporeBudgetChoice *choice) {
  double cost = 0, square = 0;
  int coarse = 0;
  for (gsize i = 0; i < table->search.count; i++) {
    int level = choice->level[i] < 0 ? table->subjects[i].level : choice->level[i];
    cost += table->cost[i][level], square += table->square[i][level];
    coarse += level != SPORE_LOD_FINE;
  }
  if (coarse > 1) square += table->trap;
  if (choice->nonlinear >= 0 || choice->linear >= 0) cost *= 1.5;
  double parts = choice->dt_s / 1e-3;
  return (SporeAccuracyPoint){.dt_s = choice->dt_s,
                              .cost = cost / parts,
                              .error = sqrt(square) * (parts > 1 ? 10 * parts : 1),
                              .stable = true,
                              .sound = true};
}

static gboolean look_up(SporeBudgetSearch *search, SporeBudgetChoice *choice, gboolean timed_only,
                        SporeAccuracyPoint *point, SporeError *error) {
  *point = point_of((Table *)search, choice);
  return TRUE;
}

static void add_own(SporeBudgetSearch *search, double dt_s) {
  SporeError error = SPORE_ERROR_INIT;
  search->tried = g_ptr_array_new_with_free_func(spore_budget_choice_free);
  SporeBudgetChoice *own = spore_budget_choice_new(search, dt_s);
  g_ptr_array_add(search->tried, own);
  g_assert_true(search->measure(search, own, FALSE, &own->point, &error));
}

static void prepare(Table *table, gsize count, double limit) {
  static SporeAccuracyFit method = {.method = {SPORE_INTEGRATOR_IMPLICIT_EULER, -1, -1}};
  static SporeAccuracyPoint studied = {.level = -1, .dt_s = 1e-3}; /* the scene as it is, and the longest step */
  table->report = (SporeAccuracyReport){
      .interval_s = 1e-3, .methods = &method, .method_count = 1, .points = &studied, .point_count = 1};
  table->search = (SporeBudgetSearch){.result = &table->result,
                                      .report = &table->report,
                                      .count = count,
                                      .subjects = table->subjects,
                                      .measure = look_up,
                                      .limit = limit,
                                      .until_s = HUGE_VAL};
  for (gsize i = 0; i < count; i++)
    table->subjects[i] = (SporeBudgetSubject){.integrator = SPORE_INTEGRATOR_IMPLICIT_EULER,
                                              .substeps = 1,
                                              .level = SPORE_LOD_FINE,
                                              .levels = {TRUE, TRUE, TRUE},
                                              .keeps_integrator = TRUE};
  add_own(&table->search, 1e-3);
}

static void clear(Table *table) { g_ptr_array_unref(table->search.tried); }

static const SporeBudgetChoice *find(Table *table) {
  SporeError error = SPORE_ERROR_INIT;
  SporeBudgetChoice *best = spore_budget_search(&table->search, &error);
  g_assert_nonnull(best);
  return best;
}

static int level_of(const SporeBudgetSearch *search, const SporeBudgetChoice *choice, gsize body) {
  return choice->level[body] < 0 ? search->subjects[body].level : choice->level[body];
}

/* Two bodies of which one alone may be fine: the search makes the first one coarse first, and from there no single
 * change is better, though the second one's coarse level errs less. */
static Table two_bodies(void) {
  return (Table){.cost = {{1, 5, 5}, {1, 5, 5}}, .square = {{1e-2, 1e-2, 1e-4}, {4e-3, 4e-3, 1e-4}}};
}

static void test_pair(void) {
  Table table = two_bodies();
  prepare(&table, 2, 7);
  const SporeBudgetChoice *best = find(&table);
  g_assert_cmpint(level_of(&table.search, best, 0), ==, SPORE_LOD_FINE);
  g_assert_cmpint(level_of(&table.search, best, 1), ==, SPORE_LOD_COARSE);
  g_assert_cmpuint(table.result.together, >, 0);
  g_assert_cmpuint(table.result.tried, >=, table.result.together);
  /* The way there leads over worse choices. */
  SporeBudgetChoice *stuck = spore_budget_choice_copy(&table.search, best);
  stuck->level[0] = SPORE_LOD_COARSE, stuck->level[1] = -1;
  stuck->point = point_of(&table, stuck);
  g_assert_true(spore_budget_choice_fits(&table.search, stuck));
  for (gsize body = 0; body < 2; body++)
    for (int level = 0; level < SPORE_LOD_COUNT; level++) {
      SporeBudgetChoice *single = spore_budget_choice_copy(&table.search, stuck);
      single->level[body] = level;
      single->point = point_of(&table, single);
      g_assert_false(spore_budget_choice_is_better(&table.search, single, stuck));
      spore_budget_choice_free(single);
    }
  spore_budget_choice_free(stuck);
  clear(&table);
}

/* A forecast is no result: what runs say to be worse is not taken. */
static void test_runs_decide(void) {
  Table table = {.cost = {{1, 4, 9}, {1, 4, 9}}, .square = {{1e-2, 1e-4, 1e-6}, {1e-2, 1e-4, 1e-6}}, .trap = 1};
  prepare(&table, 2, 14);
  const SporeBudgetChoice *best = find(&table);
  int coarse = 0;
  for (gsize body = 0; body < 2; body++) coarse += level_of(&table.search, best, body) != SPORE_LOD_FINE;
  g_assert_cmpint(coarse, ==, 1);
  clear(&table);
}

/* The least error of all sets of levels that fit, at the step and by the solvers as they are. */
static double least_error(const Table *table) {
  SporeBudgetChoice *choice = spore_budget_choice_new(&table->search, 1e-3);
  double least = HUGE_VAL;
  for (int set = 0; set < 81; set++) {
    for (int i = 0, rest = set; i < BODIES; i++, rest /= SPORE_LOD_COUNT) choice->level[i] = rest % SPORE_LOD_COUNT;
    SporeAccuracyPoint point = point_of(table, choice);
    if (point.cost <= table->search.limit) least = fmin(least, point.error);
  }
  spore_budget_choice_free(choice);
  return least;
}

/* Tables at random: what is found is within what counts as nearer of the best that there is. */
static void test_optimum(void) {
  GRand *random = g_rand_new_with_seed(17);
  for (int turn = 0; turn < 200; turn++) {
    Table table = {0};
    double most = 0;
    for (gsize i = 0; i < BODIES; i++) {
      double cost = 0, square = g_rand_double_range(random, 1e-6, 1e-4);
      for (int level = 0; level < SPORE_LOD_COUNT; level++)
        table.cost[i][level] = cost += g_rand_double_range(random, 0.5, 5);
      for (int level = SPORE_LOD_COUNT; level-- > 0; square *= g_rand_double_range(random, 2, 50))
        table.square[i][level] = square;
      most += cost;
    }
    prepare(&table, BODIES, g_rand_double_range(random, 0.5, 0.9) * most);
    const SporeBudgetChoice *best = find(&table);
    g_assert_cmpfloat(best->point.error, <=, least_error(&table) / 0.97);
    g_assert_cmpuint(table.result.tried, <=, FEW_RUNS);
    clear(&table);
  }
  g_rand_free(random);
}

/* Where no time is left, nothing is run, and that is known. */
static void test_ended(void) {
  Table table = two_bodies();
  prepare(&table, 2, 7);
  table.search.until_s = 0;
  g_assert_true(find(&table) == table.search.tried->pdata[0]);
  g_assert_true(table.search.ended);
  g_assert_cmpuint(table.result.tried, ==, 0);
  clear(&table);
}

static gboolean fail(SporeBudgetSearch *search, SporeBudgetChoice *choice, gboolean timed_only,
                     SporeAccuracyPoint *point, SporeError *error) {
  if (search->result->together == 0) return look_up(search, choice, timed_only, point, error);
  return spore_error_set(error, SPORE_ERROR_CANCELLED, NULL, "cancelled");
}

/* A wish to end is followed wherever it comes. */
static void test_cancelled(void) {
  Table table = two_bodies();
  SporeError error = SPORE_ERROR_INIT;
  prepare(&table, 2, 7);
  table.search.measure = fail;
  g_assert_null(spore_budget_search(&table.search, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_CANCELLED);
  clear(&table);
}

/* A scene: two blocks of tissue that hang from their tops, the second one much stiffer. */
#define SCENE                                                                                                          \
  "<spore version=\"1.0\"><environment gravity=\"0 -9.81 0\"/><solver time_step=\"0.004\"/><assets>"                   \
  "<mesh name=\"cube\" file=\"cube.off\"/></assets><bodies>"                                                           \
  "<body name=\"soft\"><mechanical geometry=\"cube\"><finite_differences cells=\"4\" young_modulus=\"3000\"/>"         \
  "</mechanical><fidelity><coarse settings=\"cells=2\"/></fidelity></body>"                                            \
  "<body name=\"stiff\" position=\"1 0 0\"><mechanical geometry=\"cube\"><finite_differences cells=\"4\" "             \
  "young_modulus=\"60000\"/></mechanical><fidelity><coarse settings=\"cells=2\"/></fidelity></body>"                   \
  "</bodies><links><pin name=\"a\" body=\"soft\" point=\"0.05 0.1 0.05\" radius=\"0.08\"/>"                            \
  "<pin name=\"b\" body=\"stiff\" point=\"1.05 0.1 0.05\" radius=\"0.08\"/></links></spore>"

#define FINE_NODES 125 /* of 4^3 cells */
#define COARSE_NODES 27

/* Nodes that are solved for in a simulated second, instead of the time that solving takes. */
static double counted(const SporeAccuracyPoint *point, double nodes) { return point->newton * nodes / point->dt_s; }

static gboolean run_and_count(SporeBudgetSearch *search, SporeBudgetChoice *choice, gboolean timed_only,
                              SporeAccuracyPoint *point, SporeError *error) {
  double nodes = 0;
  if (!spore_budget_measure(search, choice, FALSE, point, error)) return FALSE;
  for (gsize i = 0; i < search->count; i++)
    nodes += level_of(search, choice, i) == SPORE_LOD_FINE ? FINE_NODES : COARSE_NODES;
  point->cost = counted(point, nodes);
  return TRUE;
}

static SporeAccuracyReport *study(const SporeAccuracyScene *scene) {
  static const SporeAccuracyMethod methods[] = {{SPORE_INTEGRATOR_IMPLICIT_EULER, -1, -1},
                                                {SPORE_INTEGRATOR_TR_BDF2, -1, -1}};
  const SporeAccuracyOptions options = {.methods = methods,
                                        .method_count = G_N_ELEMENTS(methods),
                                        .dt_low_s = 1e-3,
                                        .dt_high_s = 4e-3,
                                        .dt_count = 3,
                                        .time_s = 0.04,
                                        .repeats = 1,
                                        .full = true};
  SporeError error = SPORE_ERROR_INIT;
  SporeAccuracyReport *report = spore_accuracy_study(scene, &options, &error);
  if (!report) g_error("%s", error.message);
  for (gsize i = 0; i < report->point_count; i++) {
    SporeAccuracyPoint *point = &report->points[i];
    point->cost = counted(point, 2 * FINE_NODES);
  }
  return report;
}

typedef struct Blocks {
  SporeBudgetSearch search; /* over two blocks */
  SporeBudget result;
  SporeBudgetSubject subjects[2];
} Blocks;

/* A budget for one fine block and a coarse one. The search goes through the blocks in this order. */
static void prepare_blocks(Blocks *blocks, SporeAccuracyReport *report, const char *first, const char *second) {
  const char *const names[] = {first, second};
  blocks->search = (SporeBudgetSearch){.result = &blocks->result,
                                       .report = report,
                                       .count = 2,
                                       .subjects = blocks->subjects,
                                       .measure = run_and_count,
                                       .until_s = HUGE_VAL};
  for (int i = 0; i < 2; i++)
    blocks->subjects[i] = (SporeBudgetSubject){.name = names[i],
                                               .integrator = SPORE_INTEGRATOR_IMPLICIT_EULER,
                                               .substeps = 1,
                                               .level = SPORE_LOD_FINE,
                                               .levels = {[SPORE_LOD_COARSE] = TRUE, [SPORE_LOD_FINE] = TRUE},
                                               .keeps_integrator = TRUE};
  add_own(&blocks->search, 4e-3);
  const SporeBudgetChoice *own = blocks->search.tried->pdata[0];
  blocks->search.limit = 0.65 * own->point.cost;
}

/* The soft block is to be coarse, in whichever order. Returns the runs of several changes. */
static guint assert_soft_is_coarse(SporeAccuracyReport *report, const char *first, const char *second) {
  Blocks blocks = {0};
  SporeError error = SPORE_ERROR_INIT;
  prepare_blocks(&blocks, report, first, second);
  const SporeBudgetChoice *best = spore_budget_search(&blocks.search, &error);
  g_assert_nonnull(best);
  g_assert_true(spore_budget_choice_fits(&blocks.search, best));
  for (gsize i = 0; i < 2; i++) {
    SporeLodGrade wanted = g_str_equal(blocks.subjects[i].name, "soft") ? SPORE_LOD_COARSE : SPORE_LOD_FINE;
    g_assert_cmpint(level_of(&blocks.search, best, i), ==, wanted);
  }
  g_test_message("%s first: %.4g %% off for %.4g, %u runs, %u of several changes", first, 100 * best->point.error,
                 best->point.cost, blocks.result.tried, blocks.result.together);
  g_ptr_array_unref(blocks.search.tried);
  return blocks.result.together;
}

/* One block alone may be fine, and the soft block's coarse level errs less. Where the search makes the stiff block
 * coarse first, it has to change both at once to find that. */
static void test_scene(void) {
  char *folder = fixture_scene_folder_new(SCENE);
  SporeDocument *document = fixture_load(folder);
  GError *error = NULL;
  SporeSimulation *simulation = spore_simulation_new(document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  SporeAccuracySource *source = spore_accuracy_source_new(document, simulation, NULL, NULL, NULL, NULL);
  const SporeAccuracyScene scene = spore_accuracy_source_scene(source);
  SporeAccuracyReport *report = study(&scene);
  assert_soft_is_coarse(report, "soft", "stiff");
  g_assert_cmpuint(assert_soft_is_coarse(report, "stiff", "soft"), >, 0);
  spore_accuracy_report_free(report);
  spore_accuracy_source_free(source);
  spore_simulation_free(simulation);
  spore_document_free(document);
  fixture_folder_free(folder);
}

/* A net that hangs. */
#define NET                                                                                                            \
  "<spore version=\"1.0\"><environment gravity=\"0 -9.81 0\"/><solver time_step=\"0.004\"/><assets>"                   \
  "<mesh name=\"cube\" file=\"cube.off\"/></assets><bodies><body name=\"net\"><mechanical geometry=\"cube\">"          \
  "<mass_spring_net mass=\"0.1\" structural_stiffness=\"%g\"/></mechanical></body></bodies></spore>"

/* Whether the study has a point of the method; *told: whether it is said why it has not. */
static gboolean is_studied(const SporeBudget *budget, const char *name, gboolean *told) {
  g_autofree char *words = g_strdup_printf("%s for all bodies: ", name);
  *told = FALSE;
  for (char **cut = budget->cuts; *cut; cut++) *told |= g_str_has_prefix(*cut, words);
  for (gsize m = 0; m < budget->report->method_count; m++)
    if (g_str_equal(budget->report->methods[m].label, name)) return TRUE;
  return FALSE;
}

static SporeBudget *budget_of_net(double stiffness) {
  g_autofree char *scene = g_strdup_printf(NET, stiffness);
  char *folder = fixture_scene_folder_new(scene);
  SporeDocument *document = fixture_load(folder);
  GError *error = NULL;
  SporeSimulation *simulation = spore_simulation_new(document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  const SporeBudgetOptions options = {.budget_us = 1e6, .time_s = 0.02};
  SporeBudget *budget = spore_budget_find(document, simulation, NULL, NULL, &options, &error);
  g_assert_no_error(error);
  spore_simulation_free(simulation);
  spore_document_free(document);
  fixture_folder_free(folder);
  return budget;
}

/* Every registered method is studied, or it is said why not, but for the two that are never worth it. */
static void test_methods(void) {
  for (int turn = 0; turn < 2; turn++) {
    g_autoptr(SporeBudget) budget = budget_of_net(turn == 0 ? 10 : 1e8);
    for (int kind = 0; kind < SPORE_INTEGRATOR_COUNT; kind++) {
      const SporeIntegrator *integrator = spore_integrator((SporeIntegratorKind)kind);
      gboolean never = kind == SPORE_INTEGRATOR_STATIC || kind == SPORE_INTEGRATOR_EXPLICIT_EULER, told;
      gboolean small = turn == 1 && !integrator->implicit && !integrator->sweeps;
      g_assert_cmpint(is_studied(budget, integrator->name, &told), ==, !never && !small);
      g_assert_cmpint(told, ==, small && !never);
    }
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/budget/pair", test_pair);
  g_test_add_func("/budget/runs_decide", test_runs_decide);
  g_test_add_func("/budget/optimum", test_optimum);
  g_test_add_func("/budget/ended", test_ended);
  g_test_add_func("/budget/cancelled", test_cancelled);
  g_test_add_func("/budget/scene", test_scene);
  g_test_add_func("/budget/methods", test_methods);
  return g_test_run();
}
