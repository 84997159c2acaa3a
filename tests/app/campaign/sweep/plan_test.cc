#include "app/campaign/sweep/plan.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::plan_test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

SweepOptions street(const std::vector<std::string>& vary) {
  SweepOptions options;
  options.scenario = PATROL_SOURCE_DIR "/worlds/street/scenarios/short.yaml";
  options.vary = vary;
  options.seeds = "2";
  return options;
}

std::vector<std::string> variants_of(const SweepManifest& manifest) {
  std::vector<std::string> names;
  for (const Variant& variant : manifest.variants) names.push_back(variant.name);
  return names;
}

ErrorBudgetOptions budget_of(const char* scenario) {
  ErrorBudgetOptions options;
  options.scenario = std::string(PATROL_SOURCE_DIR "/worlds/") + scenario;
  options.seeds = "2";
  return options;
}

TEST(PlanSweep, EveryRunHasAnAddressOfItsOwnAndItIsTheSameNextTime) {
  const SweepManifest manifest = plan_sweep(street({"sensors.lidar.range_noise_std_m=0.01,0.03"}));
  std::set<std::string> hashes;
  for (const PlannedRun& run : manifest.runs) hashes.insert(run.hash);
  EXPECT_EQ(hashes.size(), 4u);
  EXPECT_EQ(plan_sweep(street({"sensors.lidar.range_noise_std_m=0.01,0.03"})).runs[3].hash, manifest.runs[3].hash);
}

TEST(PlanSweep, TheSameSettingsHaveTheSameAddressHoweverTheyAreSaid) {
  SweepOptions said = street({});
  said.overrides = {"sensors.lidar.range_noise_std_m=0.030"};
  EXPECT_EQ(plan_sweep(said).runs[0].hash, plan_sweep(street({"sensors.lidar.range_noise_std_m=0.03"})).runs[0].hash);
}

TEST(PlanSweep, ADrawIsCommonToTheVariantsOfASeed) {
  const SweepManifest manifest =
      plan_sweep(street({"stack.slam.rbpf.particles=10,20", "sensors.lidar.range_noise_std_m=uniform:0.01:0.05"}));
  EXPECT_EQ(manifest.runs[0].overrides.back(), manifest.runs[1].overrides.back());
  EXPECT_NE(manifest.runs[0].overrides.back(), manifest.runs[2].overrides.back());
}

TEST(PlanSweep, AWrongKeyOrValueIsRefusedBeforeAnythingRuns) {
  EXPECT_THROW(plan_sweep(street({"sensors.lidar.range_nose_m=0.01,0.03"})), InputError);
  EXPECT_THROW(plan_sweep(street({"sensors.lidar.range_noise_std_m=0.01,-0.03"})), InputError);
}

// The path is the same, the file is another.
TEST(PlanSweep, AMissionFromElsewhereIsKnownByWhatStandsInIt) {
  const test::TemporaryFolder folder;
  const std::string mission = io::load_text(PATROL_SOURCE_DIR "/worlds/street/routes/short.json");
  SweepOptions elsewhere = street({});
  elsewhere.overrides = {"mission=" + (folder / "mission.json").string()};
  io::save_text(folder / "mission.json", mission);
  const std::string hash = plan_sweep(elsewhere).runs[0].hash;
  EXPECT_EQ(plan_sweep(elsewhere).runs[0].hash, hash);
  io::save_text(folder / "mission.json", mission + " ");
  EXPECT_NE(plan_sweep(elsewhere).runs[0].hash, hash);
}

TEST(PlanSweep, AnUnknownRobotIsRefusedWithTheKnownOnes) {
  EXPECT_THAT(
      [] { plan_sweep(street({"robot=quadruped,hovering"})); },
      ::testing::ThrowsMessage<InputError>(::testing::AllOf(HasSubstr("robot = hovering"), HasSubstr("known: "))));
}

TEST(PlanSweep, AMetricOfAStationThatNoVariantHasIsRefused) {
  SweepOptions options = street({});
  options.metrics = {"stations.nowhere.reached"};
  EXPECT_THAT([&] { plan_sweep(options); }, ::testing::ThrowsMessage<InputError>(HasSubstr(
                                                "--metric stations.nowhere.reached: unknown station nowhere")));
  options.metrics = {"stations.0.reached"};
  EXPECT_EQ(plan_sweep(options).metrics, options.metrics);
}

TEST(PlanSweep, AMissionThatIsMissingIsRefusedBeforeAnythingRuns) {
  EXPECT_THROW(plan_sweep(street({"mission=routes/short.json,routes/nowhere.json"})), InputError);
}

TEST(PlanBudget, AQuadrupedHasNoBeltsAndNoUwbToLoseAnythingBy) {
  const std::vector<std::string> variants = variants_of(plan_error_budget(budget_of("street/scenarios/short.yaml")));
  EXPECT_THAT(variants, Contains("foot contact: noise"));
  EXPECT_THAT(variants, Not(Contains(HasSubstr("UWB"))));
  EXPECT_THAT(variants, Not(Contains(HasSubstr("belts"))));
}

TEST(PlanBudget, ATrackedRobotHasNoLegs) {
  const std::vector<std::string> variants = variants_of(plan_error_budget(budget_of("tunnel/scenarios/docking.yaml")));
  EXPECT_THAT(variants, Contains("UWB: non-line-of-sight paths"));
  EXPECT_THAT(variants, Contains("tracks: slip (friction 2)"));
  EXPECT_THAT(variants, Not(Contains("foot contact: noise")));
}

TEST(PlanBudget, WhatAScenarioDoesNotHaveIsNotTakenAway) {
  ErrorBudgetOptions options = budget_of("street/scenarios/short.yaml");
  options.overrides = {"sensors.lidar.range_noise_std_m=0"};
  EXPECT_THAT(variants_of(plan_error_budget(options)), Not(Contains("lidar: range noise")));
}

TEST(PlanBudget, OneSeedSaysNothingOfTheSpread) {
  ErrorBudgetOptions options = budget_of("street/scenarios/short.yaml");
  options.seeds = "1";
  EXPECT_THROW(plan_error_budget(options), InputError);
}

FaultMatrixOptions faults_of(const char* scenario) {
  FaultMatrixOptions options;
  options.scenario = std::string(PATROL_SOURCE_DIR "/worlds/") + scenario;
  return options;
}

TEST(PlanFaults, EachOfTheSevenKindsForEachSensorAndOneRunWithout) {
  // lidar, IMU, joint encoders, foot sensors, gas meter, GNSS
  EXPECT_EQ(plan_fault_matrix(faults_of("street/scenarios/short.yaml")).variants.size(), 1u + 6u * 7u);
  // lidar, IMU, Hall sensors, UWB, ultrasonic ring, depth camera
  EXPECT_EQ(plan_fault_matrix(faults_of("tunnel/scenarios/docking.yaml")).variants.size(), 1u + 6u * 7u);
}

TEST(PlanFaults, ThreeSeedsUnlessToldOtherwise) {
  FaultMatrixOptions options = faults_of("street/scenarios/short.yaml");
  options.faults = {"imu: drift"};
  EXPECT_EQ(plan_fault_matrix(options).runs.size(), 3u * 2u);
  options.seeds = "4..5";
  EXPECT_EQ(plan_fault_matrix(options).runs.size(), 2u * 2u);
}

TEST(PlanFaults, NamedFaultsOnlyAndAnUnknownOneIsRefused) {
  FaultMatrixOptions options = faults_of("street/scenarios/short.yaml");
  options.faults = {"imu: drift", "lidar: dropout"};
  const SweepManifest manifest = plan_fault_matrix(options);
  EXPECT_THAT(variants_of(manifest), ElementsAre("no fault", "imu: drift", "lidar: dropout"));
  options.faults = {"hall: delay"};
  EXPECT_THROW(plan_fault_matrix(options), InputError) << "a quadruped has no Hall sensors";
}

TEST(PlanFaults, EveryRunExpectsTheSurvivalBoundsUnlessTheScenarioHasItsOwn) {
  FaultMatrixOptions options = faults_of("tunnel/scenarios/docking.yaml");
  options.faults = {"hall: delay"};
  options.max_error_m = 0.4;
  EXPECT_THAT(plan_fault_matrix(options).overrides, Contains("expect.pose.ate_max_m={max: 0.4}"));
  options.overrides = {"expect.pose.ate_max_m={max: 0.1}"};
  EXPECT_THAT(plan_fault_matrix(options).overrides, Not(Contains("expect.pose.ate_max_m={max: 0.4}")));
}

}  // namespace
}  // namespace patrol::app::plan_test
