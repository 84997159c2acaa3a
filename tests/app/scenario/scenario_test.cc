#include "app/scenario/scenario.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/scenario/data_folders.h"
#include "core/error.h"
#include "tests/support/legged_urdf.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::scenario_test {
namespace {

using test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::filesystem::path kSource = PATROL_SOURCE_DIR;

TEST(ScenarioFiles, AGivenMapLiesWhereItsRegistrationSaysElseAtTheSurveyedStart) {
  const auto files_of = [](const char* scenario) {
    return load_scenario_files(load_scenario(kSource / "worlds" / scenario), kSource);
  };
  const ScenarioFiles docking = files_of("tunnel/scenarios/docking.yaml"),
                      patrol = files_of("street/scenarios/short.yaml");
  ASSERT_TRUE(docking.map_registration);
  EXPECT_EQ(docking.T_site_map().vector(), docking.map_registration->T_site_map.vector());
  EXPECT_NE(docking.T_site_map().vector(), docking.T_site_start.vector());
  EXPECT_EQ(patrol.T_site_map().vector(), patrol.T_site_start.vector());
}

TEST(Scenario, EveryOneOfEveryWorldIsReadFindsItsFilesAndExpectsSomething) {
  int num_scenarios = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kSource / "worlds")) {
    if (entry.path().extension() != ".yaml" || entry.path().parent_path().filename() != "scenarios") continue;
    ++num_scenarios;
    const Scenario scenario = load_scenario(entry.path());
    const ScenarioFiles files = load_scenario_files(scenario, find_data_root(entry.path()));
    EXPECT_TRUE(std::filesystem::exists(files.world_xml)) << entry.path();
    EXPECT_FALSE(files.route.stations.empty() && files.goals.empty() && !files.has_teleop())
        << entry.path() << " leads nowhere";
    EXPECT_FALSE(scenario.expect.empty()) << entry.path() << " expects nothing";
  }
  EXPECT_GE(num_scenarios, 10);
}

TEST(Scenario, AWorldInsteadOfAScenarioIsRefusedWithItsScenarios) {
  for (const char* name : {"street", "worlds/street", "worlds/street/"}) {
    EXPECT_THAT([&] { load_scenario(name); },
                ThrowsMessage<InputError>(AllOf(HasSubstr(std::string(name) + ": is a world"),
                                                HasSubstr("street/short"), HasSubstr("--goal"))));
    EXPECT_EQ(world_of(name), "street");
  }
  for (const char* name : {"worlds", "models/quadruped", "street/short", "streets", "street.yaml", ""})
    EXPECT_EQ(world_of(name), std::nullopt) << name;
}

TEST(Scenario, FindsTheQuadrupedByItsName) {
  Scenario scenario;
  scenario.world = "street";
  scenario.mission = "routes/short.json";
  const ScenarioFiles files = load_scenario_files(scenario, kSource);
  EXPECT_EQ(files.world_xml, kSource / "worlds/street/street.xml");
  EXPECT_EQ(files.robot_urdf, kSource / "models/quadruped/quadruped.urdf");
  EXPECT_EQ(files.robot.legs.size(), 4u);
}

TEST(Scenario, AnUnknownWorldOrRobotNamesTheKnownOnes) {
  Scenario scenario;
  scenario.world = "moon";
  EXPECT_THAT([&] { load_scenario_files(scenario, kSource); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("world = moon"), HasSubstr("known: "), HasSubstr("street"))));
  scenario.world = "street";
  scenario.robot = "hexapod";
  EXPECT_THAT([&] { load_scenario_files(scenario, kSource); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("robot = hexapod"), HasSubstr("quadruped"))));
}

TEST(Scenario, AMissingMissionIsNamed) {
  Scenario scenario;
  scenario.world = "street";
  scenario.mission = "routes/absent.json";
  EXPECT_THAT([&] { load_scenario_files(scenario, kSource); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("mission = routes/absent.json"), HasSubstr("worlds/street"))));
}

// <folder>/worlds and <folder>/models, the scenario two folders down.
TEST(Scenario, DataLieInTheNearestFolderAboveItThatHasBoth) {
  const TemporaryFolder folder;
  for (const char* name : {"worlds/field/scenarios", "models", "worlds/field/worlds"}) {
    std::filesystem::create_directories(folder / name);
  }
  EXPECT_EQ(find_data_root(folder / "worlds/field/scenarios/night.yaml"), folder.path());
}

TEST(Scenario, ElsewhereItTakesTheWorkingDirectoryOrTheSourceTree) {
  const TemporaryFolder folder;
  const std::filesystem::path here = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());  // nothing here
  const std::filesystem::path from_nowhere = find_data_root(folder / "my.yaml");
  std::filesystem::create_directories(folder / "elsewhere/worlds");
  std::filesystem::create_directories(folder / "elsewhere/models");
  std::filesystem::create_directories(folder / "apart");
  std::filesystem::current_path(folder / "elsewhere");
  const std::filesystem::path from_working_directory = find_data_root(folder / "apart/my.yaml");
  std::filesystem::current_path(here);
  EXPECT_EQ(from_nowhere, kSource);
  EXPECT_EQ(from_working_directory, folder / "elsewhere");
}

TEST(Scenario, DataLieWhereTheEnvironmentSays) {
  const TemporaryFolder folder;
  for (const char* name : {"worlds", "models", "other/worlds", "other/models", "empty"})
    std::filesystem::create_directories(folder / name);
  ::setenv("PATROL_DATA", (folder / "other").c_str(), 1);
  const std::filesystem::path named = find_data_root(folder / "worlds/my.yaml");
  ::setenv("PATROL_DATA", (folder / "empty").c_str(), 1);
  EXPECT_THROW(find_data_root(folder / "worlds/my.yaml"), InputError);
  ::setenv("PATROL_DATA", "", 1);
  const std::filesystem::path unnamed = find_data_root(folder / "worlds/my.yaml");
  ::unsetenv("PATROL_DATA");
  EXPECT_EQ(named, folder / "other");
  EXPECT_EQ(unnamed, folder.path());
}

// What `patrol run` writes beside its results runs again: everything that was set comes back.
TEST(Scenario, ResolvedAndReadAgainIsTheSame) {
  const TemporaryFolder folder;
  const std::filesystem::path file = kSource / "worlds/street/scenarios/short.yaml";
  const auto first = load_scenario(file, {"seed=7", "sensors.lidar.range_noise_std_m=0.05"});
  save_scenario(folder / "a.yaml", first, "");
  const auto second = load_scenario(folder / "a.yaml");
  save_scenario(folder / "b.yaml", second, "");
  EXPECT_EQ(second.seed, 7u);
  EXPECT_EQ(second.expect.size(), first.expect.size());
  EXPECT_EQ(test::read_bytes(folder / "a.yaml"), test::read_bytes(folder / "b.yaml"));
}

/// SICK states noise and systematic error of the TiM571 separately: 20 mm at one standard deviation and +-60 mm.
TEST(Scenario, TheAsBuiltTolerancesOfTheLidarAreThoseOfItsPresetUnlessTheScenarioStatesThem) {
  const std::filesystem::path file = kSource / "worlds/street/scenarios/short.yaml";
  const auto lidar = [&](const std::vector<std::string>& overrides) {
    return load_scenario(file, overrides).as_built.lidar;
  };
  EXPECT_EQ(lidar({}).range_offset_m, 0.015);
  EXPECT_EQ(lidar({}).noise_ratio, 0.64);
  EXPECT_EQ(lidar({"sensors.lidar.preset=utm30lx"}).range_offset_m, 0.015);
  const std::string tim571 = "sensors.lidar.preset=tim571";
  EXPECT_EQ(lidar({tim571}).range_offset_m, 0.06);
  EXPECT_EQ(lidar({tim571}).noise_ratio, 1.0);
  EXPECT_EQ(lidar({tim571}).cone_deg, lidar({}).cone_deg);
  EXPECT_EQ(lidar({tim571, "as_built.lidar.range_offset_m=0.02"}).range_offset_m, 0.02);
  EXPECT_EQ(lidar({tim571, "as_built.lidar.range_offset_m=0.02"}).noise_ratio, 1.0);
  EXPECT_EQ(lidar({tim571, "as_built.lidar.range_offset_m=0"}).range_offset_m, 0.0) << "as patrol error-budget does";

  // A log contains the scenario with all values.
  const TemporaryFolder folder;
  save_scenario(folder / "resolved.yaml", load_scenario(file, {tim571, "as_built.lidar.noise_ratio=0.5"}), "");
  const Scenario again = load_scenario(folder / "resolved.yaml");
  EXPECT_EQ(again.as_built.lidar.range_offset_m, 0.06);
  EXPECT_EQ(again.as_built.lidar.noise_ratio, 0.5);
}

TEST(Scenario, ARobotProfileSelectsTheTolerancesOfItsLidarAndAScenarioThoseOfAnother) {
  const TemporaryFolder root;
  std::filesystem::create_directories(root / "worlds");
  std::filesystem::create_directories(root / "models/sick");
  const auto write = [&](const char* name, const std::string& text) {
    test::write_bytes(root / name, text);
    return root / name;
  };
  write("models/sick/sick.yaml", "sensors: {lidar: {preset: tim571}}\nas_built: {lidar: {cone_deg: 0.5}}\n");
  const auto same = load_scenario(write("worlds/same.yaml", "robot: sick\n")).as_built.lidar;
  EXPECT_EQ(same.range_offset_m, 0.06);
  EXPECT_EQ(same.cone_deg, 0.5);
  const auto other =
      load_scenario(write("worlds/other.yaml", "robot: sick\nsensors: {lidar: {preset: utm30lx}}\n")).as_built.lidar;
  EXPECT_EQ(other.range_offset_m, 0.015);
  EXPECT_EQ(other.cone_deg, 1.5) << "that of the profile is of its own lidar";
}

TEST(Scenario, ALeggedRobotHasAGaitAndThresholdsOfItsSizeWithAndWithoutAProfile) {
  const TemporaryFolder root;
  test::UrdfQuadruped heavy;
  heavy.mass_kg = 4.0 * 13.56;
  heavy.thigh_m = heavy.shank_m = 0.426;
  heavy.effort_nm = heavy.knee_effort_nm = 300.0;
  for (const std::string name : {"plain", "profiled"}) {
    std::filesystem::create_directories(root / "models" / name);
    test::write_bytes(root / "models" / name / (name + ".urdf"), heavy.text());
  }
  test::write_bytes(root / "models/profiled/profiled.yaml", "locomotion: {swing_clearance_m: 0.1}\n");
  const sim::LocomotionSettings tuned;
  const stack::StackSettings stack;
  for (const char* name : {"plain", "profiled"}) {
    SCOPED_TRACE(name);
    const Scenario scenario = default_scenario(name, root.path());
    EXPECT_NEAR(scenario.locomotion.gait_period_s, std::sqrt(2.0) * tuned.gait_period_s, 1e-9);
    EXPECT_NEAR(scenario.locomotion.trunk_height_m, 2.0 * tuned.trunk_height_m, 2e-3);
    const double contact_on_n = scenario.stack.odometry.legged.contact_on_force_n;
    EXPECT_NEAR(contact_on_n / stack.odometry.legged.contact_on_force_n, 4.0, 0.02);
  }
  EXPECT_NEAR(default_scenario("plain", root.path()).locomotion.swing_clearance_m, 2.0 * tuned.swing_clearance_m, 1e-9);
  EXPECT_EQ(default_scenario("profiled", root.path()).locomotion.swing_clearance_m, 0.1);
}

TEST(Scenario, TheStackPlansNoSpeedsThatSlowJointsDoNotReach) {
  const TemporaryFolder root;
  const test::UrdfQuadruped fast;
  test::UrdfQuadruped slow;
  slow.speed_radps = 0.3 * fast.speed_radps;
  for (const std::string name : {"fast", "slow", "given"}) {
    std::filesystem::create_directories(root / "models" / name);
    test::write_bytes(root / "models" / name / (name + ".urdf"), (name == "fast" ? fast : slow).text());
  }
  test::write_bytes(root / "models/given/given.yaml",
                    "stack: {navigation: {local_planner: {dwa: {max_speed_mps: 0.5}}}}\n");
  const auto speed_mps = [&](const char* name) {
    return default_scenario(name, root.path()).stack.navigation.local_planner.dwa.max_speed_mps;
  };
  const auto ratio = [&](const char* name) {
    return speed_mps(name) / default_scenario(name, root.path()).locomotion.max_forward_mps;
  };
  const double tuned = plan::DwaSettings{}.max_speed_mps / sim::LocomotionSettings{}.max_forward_mps;
  EXPECT_NEAR(ratio("fast"), tuned, 1e-9);
  EXPECT_NEAR(ratio("slow"), tuned, 1e-9);
  EXPECT_LT(speed_mps("slow"), 0.7 * speed_mps("fast"));
  EXPECT_EQ(speed_mps("given"), 0.5);
}

TEST(Scenario, TheLightIsAsTheWorldHasItUnlessOneDimsIt) {
  const std::filesystem::path file = kSource / "worlds/tunnel/scenarios/docking.yaml";
  EXPECT_EQ(load_scenario(file).light.intensity, 1.0);
  EXPECT_EQ(load_scenario(file, {"light.intensity=0.4"}).light.intensity, 0.4);
  EXPECT_THAT([&] { load_scenario(file, {"light.intensity=1.5"}); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("light.intensity"), HasSubstr("1.5"), HasSubstr("[0, 1]"))));
}

TEST(ScenarioFiles, ADatumOfGnssThatIsNotThatOfTheSurveyIsRefused) {
  const auto load = [](const std::vector<std::string>& overrides) {
    load_scenario_files(load_scenario(kSource / "worlds/street/scenarios/short.yaml", overrides), kSource);
  };
  EXPECT_THAT([&] { load({"sensors.gnss.datum_latitude_deg=48"}); },
              ThrowsMessage<InputError>(HasSubstr("must be those of the mission's datum, 29.21 and 119.46")));
  EXPECT_NO_THROW(load({"sensors.gnss.datum_latitude_deg=48", "sensors.gnss.enabled=false"}));
}

TEST(Scenario, ItsStartIsReadWithoutTheSensorsThatItsMissionNeeds) {
  const Scenario scenario = load_scenario(kSource / "worlds/street/scenarios/patrol.yaml", {"robot=wheeled"});
  EXPECT_THAT([&] { load_scenario_files(scenario, kSource); }, ThrowsMessage<InputError>(HasSubstr("has no tdlas")));
  const Pose2 start = load_start(scenario, kSource);
  const Pose2 of_files =
      load_scenario_files(load_scenario(kSource / "worlds/street/scenarios/patrol.yaml"), kSource).T_site_start;
  EXPECT_EQ(start.position(), of_files.position());
  EXPECT_EQ(start.yaw, of_files.yaw);
  EXPECT_THAT([&] { load_start({}, kSource); }, ThrowsMessage<InputError>(HasSubstr("world: missing")));
}

TEST(Scenario, AnOverrideOfAnUnknownKeyNamesTheNearest) {
  EXPECT_THAT([] { load_scenario(kSource / "worlds/street/scenarios/short.yaml", {"sed=3"}); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("sed"), HasSubstr("seed"))));
}

}  // namespace
}  // namespace patrol::app::scenario_test
