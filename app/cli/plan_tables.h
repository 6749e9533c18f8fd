/* Tables of spore plan about bodies. Each is a member of the report, and lines for people. */
#ifndef SPORE_APP_CLI_PLAN_TABLES_H
#define SPORE_APP_CLI_PLAN_TABLES_H

#include "app/cli/scene.h"
#include "core/measure/pruning.h"

/* How far what is drawn of a body, and its spheres, lies off where the body moves it. */
void spore_plan_report_mapping(SporeCli *cli, const SporeRun *run);
/* Where each pin on a line clamps that line. */
void spore_plan_report_pins(SporeCli *cli, const SporeRun *run);
/* Reports the levels of every body that has levels. steps: number of steps that measure each level, in a copy of the
 * scene where nothing else changes; 0: nothing is measured. FALSE with a GError where a copy cannot be made. */
gboolean spore_plan_report_levels(SporeCli *cli, SporeRun *run, int steps, GError **error);
/* Reports every line that has a reserve of control points. measured: with the time that the world has spent on them. */
void spore_plan_report_lines(SporeCli *cli, const SporeWorld *world, gboolean measured);

/* Reports what is an effect. measured: what the effects of tools and emitters save is measured over the recorded input,
 * in copies of the scene in which each is physical. FALSE with a GError where a copy cannot be made. */
gboolean spore_plan_report_effects(SporeCli *cli, SporeRun *run, gboolean measured, GError **error);

/* The models, files and libraries of the scene. needs: of SporeAssetNeed. */
void spore_plan_report_needs(SporeCli *cli, const SporeRun *run, const GArray *needs);
/* Rows of left_out: files that a run does not read. */
void spore_plan_report_files_left_out(SporeCli *cli, SporeDocument *document, const GArray *needs);
/* Measures the scene beside itself with nothing left out, in SPORE_PRUNING_STEPS steps from time 0. *unpruned: of the
 * caller, who frees it. FALSE with a GError where it cannot be made. Where it was cancelled, nothing is measured. */
gboolean spore_plan_measure_pruning(SporeRun *run, SporePruning *pruning, SporeSimulation **unpruned, GError **error);
/* Reports what was measured. Gives the exit status: 1 where leaving out changed the result. */
int spore_plan_report_pruning(SporeCli *cli, const SporePruning *pruning);

#endif
