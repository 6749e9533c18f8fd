/* Physical or effect: how runs are compared, and what follows from it. */
#include <glib.h>
#include <math.h>

#include "core/measure/influence.h"

#define SAMPLES 3

/* Two bodies of one point each; the second one moves by `step` along x from sample to sample. */
static void fill(SporeTrialPoints *points, SporeTrialBody bodies[2], SporeTrial *trial, double *positions,
                 double *forces, double step, double force) {
  bodies[0] = (SporeTrialBody){.body = 4, .count = 1, .length = 2};
  bodies[1] = (SporeTrialBody){.body = 7, .count = 1, .length = 0.5};
  *points = (SporeTrialPoints){.body_count = 2, .count = 2, .bodies = bodies};
  for (int s = 0; s < SAMPLES; s++) {
    for (int k = 0; k < 6; k++) positions[6 * s + k] = 0;
    positions[6 * s + 3] = s * step;
    for (int k = 0; k < 3; k++) forces[3 * s + k] = k == 1 ? force : 0;
  }
  *trial = (SporeTrial){.samples = SAMPLES,
                        .points = 2,
                        .positions = positions,
                        .world_bodies = 1,
                        .device_force = forces,
                        .finite = true};
}

static void test_between(void) {
  SporeTrialPoints points[2];
  SporeTrialBody bodies[2][2];
  SporeTrial trials[2];
  double positions[2][6 * SAMPLES], forces[2][3 * SAMPLES];
  fill(&points[0], bodies[0], &trials[0], positions[0], forces[0], 0, 1);
  fill(&points[1], bodies[1], &trials[1], positions[1], forces[1], 0.1, 1.5);
  SporeInfluence influence = spore_influence_between(&points[0], &trials[0], &points[1], &trials[1]);
  /* Distances of body 7: 0, .1, .2; by its length of .5; body 4 stands still. */
  g_assert_cmpfloat(fabs(influence.rms - sqrt((0.01 + 0.04) / 3 / 0.25 / 2)), <, 1e-15);
  g_assert_cmpfloat(fabs(influence.worst - 0.4), <, 1e-15);
  g_assert_cmpuint(influence.worst_body, ==, 7);
  g_assert_cmpfloat(fabs(influence.force - 0.5), <, 1e-15);
  g_assert_cmpfloat(fabs(spore_influence_own_motion(&points[1], &trials[1], 1) - 0.4), <, 1e-15);
  g_assert_cmpfloat(spore_influence_own_motion(&points[1], &trials[1], 0), ==, 0);
  bodies[1][1].body = SPORE_NO_BODY; /* which is not there in one of them */
  influence = spore_influence_between(&points[0], &trials[0], &points[1], &trials[1]);
  g_assert_cmpfloat(influence.rms, ==, 0);
  g_assert_cmpuint(influence.worst_body, ==, 4);
  trials[1].samples--; /* a run that ended early is no proof of anything */
  influence = spore_influence_between(&points[0], &trials[0], &points[1], &trials[1]);
  g_assert_true(isinf(influence.rms) && isinf(influence.force));
}

static SporeForm form(double influence, double force, double saved_us) {
  return (SporeForm){.tried = true, .influence = {.rms = influence, .force = force}, .saved_us = saved_us};
}

static void test_verdict(void) {
  const SporeEvidence nothing = {.floor = 1e-3, .force_floor = 0.01, .step_us = 100, .own_motion = 1};
  SporeEvidence evidence = nothing;
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_PHYSICAL); /* nothing was tried */
  evidence.forms[SPORE_VERDICT_EFFECT] = form(5e-4, 0, 10);
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_EFFECT);
  evidence.forms[SPORE_VERDICT_EFFECT] = form(5e-4, 0.02, 10); /* a hand feels it */
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_PHYSICAL);
  evidence.forms[SPORE_VERDICT_EFFECT] = form(5e-4, 0, 1); /* not worth it */
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_PHYSICAL);
  evidence.forms[SPORE_VERDICT_EFFECT] = form(2e-3, 0, 10); /* others feel it */
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_PHYSICAL);
  evidence.forms[SPORE_VERDICT_STILL] = form(0, 0, 10);
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_PHYSICAL); /* it is seen to move */
  evidence.own_motion = 1e-3;
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_STILL);
  evidence.forms[SPORE_VERDICT_STILL].tried = false;
  evidence.forms[SPORE_VERDICT_COARSE] = form(9e-4, 0, 30);
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_COARSE);
  evidence.score_floor = 0.1, evidence.forms[SPORE_VERDICT_COARSE].influence.score = 0.2; /* not as good a trainee */
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_PHYSICAL);
  evidence.score_floor = 0.3;
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_COARSE);
  evidence.forms[SPORE_VERDICT_COARSE].influence.steps = 1;
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_PHYSICAL);
  evidence.forms[SPORE_VERDICT_COARSE].influence.steps = 0, evidence.awaited = "cut";
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_PHYSICAL);
  evidence.awaited = NULL, evidence.events = true;
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_PHYSICAL);
  evidence.events = false, evidence.held = "forceps";
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_PHYSICAL);
  evidence.held = NULL, evidence.alone = true;
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_PHYSICAL);
  evidence.alone = false, evidence.chaotic = true;
  g_assert_cmpint(spore_evidence_verdict(&evidence), ==, SPORE_VERDICT_PHYSICAL);
}

/* What is within what half a step makes of it is alike; of amounts only whether there are any. */
static void test_events(void) {
  SporeTrialEvents spread = {0};
  const SporeTrialEvents full = {.torn = 10, .held = 2, .taken = 80};
  const SporeTrialEvents half = {.torn = 12, .held = 2, .taken = 85}, more = {.torn = 12, .held = 3, .taken = 70};
  g_assert_true(spore_trial_events_alike(&full, &full, &spread));
  g_assert_false(spore_trial_events_alike(&full, &half, &spread));
  spore_trial_events_spread(&spread, &full, &half);
  spore_trial_events_spread(&spread, &full, &full);
  g_assert_true(spore_trial_events_alike(&full, &half, &spread));
  g_assert_false(spore_trial_events_alike(&full, &more, &spread));
  const SporeTrialEvents none = {.torn = 10, .held = 2};
  g_assert_false(spore_trial_events_alike(&full, &none, &spread));
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/measure/influence/between", test_between);
  g_test_add_func("/measure/influence/verdict", test_verdict);
  g_test_add_func("/measure/influence/events", test_events);
  return g_test_run();
}
