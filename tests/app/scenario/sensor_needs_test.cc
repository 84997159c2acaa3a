#include "app/scenario/sensor_needs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/check/check_robot.h"
#include "app/scenario/mounts.h"
#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::sensor_needs_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using ::testing::UnorderedElementsAre;

const std::filesystem::path kSource = PATROL_SOURCE_DIR;

/// Removes the element of a URDF that begins with `opening` and ends with `closing`.
void erase(std::string& urdf, const std::string& opening, const std::string& closing) {
  const std::size_t begin = urdf.find(opening);
  ASSERT_NE(begin, std::string::npos) << opening;
  urdf.erase(begin, urdf.find(closing, begin) + closing.size() - begin);
}

/// Data folder with the worlds of the source tree and a robot `courier`: the wheeled robot without some sensor frames.
class CourierData {
 public:
  explicit CourierData(const std::vector<std::string>& missing, const std::string& profile = "") {
    std::filesystem::create_directories(folder_ / "models/courier");
    std::filesystem::create_directory_symlink(kSource / "worlds", folder_ / "worlds");
    std::string urdf = test::read_bytes(kSource / "models/wheeled/wheeled.urdf");
    for (const std::string& frame : missing) {
      erase(urdf, "<joint name=\"" + frame + "_joint\"", "</joint>");
      erase(urdf, "<link name=\"" + frame + "\"", "</link>");
    }
    test::write_bytes(folder_ / "models/courier/courier.urdf", urdf);
    test::write_bytes(folder_ / "models/courier/courier.yaml", kDrive + profile);
  }

  /// Writes a scenario in street; its key `robot` is in line 2.
  std::filesystem::path scenario(const std::string& more) const {
    test::write_bytes(folder_ / "my.yaml", "mission: routes/short.json\nrobot: courier\nworld: street\n" + more);
    return folder_ / "my.yaml";
  }
  Scenario load(const std::string& more, const std::vector<std::string>& overrides = {}) const {
    return load_scenario(scenario(more), overrides);
  }
  ScenarioFiles load_files(const std::string& more, const std::vector<std::string>& overrides = {}) const {
    return load_scenario_files(load(more, overrides), folder_.path());
  }
  std::string error(const std::string& more, const std::vector<std::string>& overrides = {}) const {
    try {
      load_files(more, overrides);
    } catch (const InputError& refused) {
      return refused.what();
    }
    return "accepted";
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  const std::filesystem::path& root() const { return folder_.path(); }

 private:
  // Keeps its key `stack` in line 1, so that sections of a test begin in line 2.
  const std::string kDrive = "stack: {odometry_source: wheeled, navigation: {kinematics: differential}}\n";
  test::TemporaryFolder folder_;
};

TEST(SensorNeeds, ARobotWithoutALidarIsRefusedWithOneLineThatNamesWhatRequiresItAndWhereItIsAdded) {
  const CourierData data({"lidar"});
  EXPECT_EQ(data.error("leaks: []\n"),
            data.file("my.yaml") +
                ":2: robot: courier has no lidar (2D lidar), which stack.slam requires, and no tdlas (open-path laser "
                "methane meter), which mission requires; add mounts of the frames lidar, tdlas "
                "(models/courier/courier.yaml, mounts)");
}

TEST(SensorNeeds, ASensorThatOnlyTheDefaultsEnableIsAbsentOnARobotWithoutIt) {
  const CourierData data({"lidar", "gnss"});
  const Scenario scenario = data.load("stack: {command: ./my_stack}\n");
  EXPECT_FALSE(scenario.sensors.lidar.enabled);
  EXPECT_FALSE(scenario.sensors.gnss.enabled);
  EXPECT_FALSE(scenario.sensors.tdlas.enabled);
  EXPECT_TRUE(scenario.sensors.imu.enabled);
  EXPECT_NO_THROW(data.load_files("stack: {command: ./my_stack}\n"));
}

TEST(SensorNeeds, ASensorThatTheScenarioEnablesByNameOrAFaultNamesIsNeeded) {
  const CourierData data({"lidar", "gnss"});
  const std::string external = "stack: {command: ./my_stack}\n";
  EXPECT_EQ(
      data.error(external + "sensors: {gnss: {enabled: true}}\n"),
      data.file("my.yaml") +
          ":2: robot: courier has no gnss (RTK GNSS receiver), which sensors.gnss.enabled requires; add a mount of "
          "the frame gnss (models/courier/courier.yaml, mounts)");
  EXPECT_THAT(data.error(external, {"sensors.gnss.enabled=true"}), HasSubstr("which sensors.gnss.enabled requires"));
  EXPECT_THAT(data.error(external + "faults: [{sensor: lidar, kind: dropout}]\n"),
              HasSubstr("no lidar (2D lidar), which faults.0 requires;"));
  EXPECT_EQ(data.error(external + "sensors: {gnss: {enabled: false}, lidar: {rate_hz: 20.0}}\n"), "accepted");
}

TEST(SensorNeeds, WithoutAnImuTheFirmwareRefusesAlsoInACheckDrive) {
  const CourierData data({"imu"});
  EXPECT_THAT(data.error("stack: {command: ./my_stack}\n"),
              HasSubstr("courier has no imu (inertial measurement unit), which wheel_drive requires;"));
  EXPECT_THAT([&] { load_check_robot("courier", {}, {}, data.root()); },
              ThrowsMessage<InputError>(HasSubstr(
                  "patrol check: courier has no imu (inertial measurement unit), which wheel_drive requires;")));
}

TEST(SensorNeeds, AProfileThatEnablesASensorWithoutAFrameIsRefusedWithItsLine) {
  const CourierData data({"gnss"}, "sensors:\n  gnss: {enabled: true}\n");
  EXPECT_EQ(data.error(""), data.file("models/courier/courier.yaml") +
                                ":3: sensors.gnss.enabled = true: the robot has no frame of this sensor: add a mount "
                                "(mounts)");
}

TEST(SensorNeeds, ThePatrolOfTheStreetNeedsLidarImuAndMethaneMeter) {
  const Scenario scenario = load_scenario(kSource / "worlds/street/scenarios/patrol.yaml");
  std::vector<std::string> sensors;
  for (const SensorNeed& need : sensor_needs(scenario, load_scenario_files(scenario, kSource)))
    sensors.push_back(need.sensor);
  EXPECT_THAT(sensors, UnorderedElementsAre("lidar", "imu", "tdlas"));
}

TEST(Mounts, AMountOfTheProfileBringsFramePresetAndTolerancesAndSwitchesTheSensorOn) {
  const CourierData data({"lidar"}, R"(mounts:
  - {frame: lidar, parent: mast, z_m: 0.2, preset: tim571}
  - {frame: lidar_rear, x_m: -0.4, z_m: 0.3, yaw_deg: 180.0, preset: utm30lx}
  - {frame: tdlas, x_m: 0.3}
)");
  const Scenario scenario = data.load("");
  EXPECT_TRUE(scenario.sensors.lidar.enabled);
  EXPECT_EQ(scenario.sensors.lidar.rate_hz, 15.0);
  EXPECT_EQ(scenario.as_built.lidar.range_offset_m, 0.06);
  EXPECT_TRUE(scenario.sensors.lidar_rear.enabled);
  EXPECT_EQ(scenario.sensors.lidar_rear.rate_hz, 40.0);
  EXPECT_TRUE(scenario.sensors.tdlas.enabled);
  const ScenarioFiles files = data.load_files("");
  EXPECT_LT((files.robot.T_body("lidar").position - Eigen::Vector3d(0.1, 0.0, 0.44)).norm(), 1e-9);
  EXPECT_EQ(files.robot.T_body("lidar_rear").position, Eigen::Vector3d(-0.4, 0.0, 0.3));
  EXPECT_THAT(files.robot_urdf_text, HasSubstr("<joint name=\"lidar_rear_mount\""));
}

TEST(Mounts, TheLocationOfAKeyWithoutAFileIsTheKey) { EXPECT_EQ(location_of("", YAML::Node(), "robot"), "robot"); }

TEST(Mounts, SettingsOfTheScenarioWinOverThePresetOfAMountAndItsMountsOverThoseOfTheRobot) {
  const CourierData data({}, "mounts: [{frame: lidar, z_m: 0.5, preset: tim571}, {frame: tdlas, x_m: 0.3}]\n");
  const Scenario scenario =
      data.load("sensors: {lidar: {rate_hz: 12.0}, tdlas: {enabled: false}}\nmounts: [{frame: lidar, z_m: 0.7}]\n");
  EXPECT_EQ(scenario.sensors.lidar.preset, "tim571");
  EXPECT_EQ(scenario.sensors.lidar.rate_hz, 12.0);
  EXPECT_FALSE(scenario.sensors.tdlas.enabled);
  ASSERT_EQ(scenario.mounts.size(), 2U);
  EXPECT_EQ(scenario.mounts[0].z_m, 0.7);
  EXPECT_EQ(scenario.mounts[1].x_m, 0.3);
}

TEST(Mounts, AProfileThatDisablesASensorThatItMountsIsRefusedWithItsLine) {
  const CourierData data({}, "sensors:\n  gnss: {enabled: false}\nmounts: [{frame: gnss, z_m: 0.4}]\n");
  EXPECT_EQ(data.error(""), data.file("models/courier/courier.yaml") +
                                ":3: sensors.gnss.enabled = false: mounts of the same file have the frame gnss, which "
                                "switches the sensor on: only one of both is allowed");
  const CourierData mounted({}, "mounts: [{frame: gnss, z_m: 0.4}]\n");
  EXPECT_FALSE(mounted.load("", {"sensors.gnss.enabled=false"}).sensors.gnss.enabled);
}

TEST(Mounts, TheResolvedScenarioReadAgainIsTheSame) {
  const CourierData data({"gnss"}, "mounts: [{frame: lidar_rear, x_m: -0.4, yaw_deg: 180.0, preset: utm30lx}]\n");
  const Scenario first = data.load("mounts: [{frame: tdlas, x_m: 0.2}]\nsensors: {lidar_rear: {rate_hz: 20.0}}\n");
  save_scenario(data.file("a.yaml"), first, "");
  const Scenario second = load_scenario(data.file("a.yaml"));
  save_scenario(data.file("b.yaml"), second, "");
  EXPECT_EQ(test::read_bytes(data.file("a.yaml")), test::read_bytes(data.file("b.yaml")));
  EXPECT_EQ(second.sensors.lidar_rear.rate_hz, 20.0);
  EXPECT_EQ(second.mounts.size(), 2U);
}

TEST(Mounts, MalformedMountsOfTheProfileAreRefusedWithFileLineAndKey) {
  const auto refusal = [](const std::string& mount) {
    const CourierData data({}, "mounts:\n  - " + mount + "\n");
    const std::string message = data.error("stack: {command: ./my_stack}\n"),
                      file = data.file("models/courier/courier.yaml");
    return message.starts_with(file) ? message.substr(file.size()) : message;
  };
  EXPECT_THAT(refusal("{frame: lidr}"),
              HasSubstr(":3: mounts.0.frame = lidr: unknown frame; did you mean lidar?: must be one of lidar, "));
  EXPECT_THAT(refusal("{frame: tem_mount}"), HasSubstr(":3: mounts.0.frame = tem_mount: unknown frame"));
  EXPECT_THAT(refusal("{frame: lidar, parent: masst}"), HasSubstr(":3: mounts.0.parent = masst: unknown link"));
  EXPECT_THAT(refusal("{frame: lidar, parent: rear_left_wheel}"),
              HasSubstr(":3: mounts.0.parent = rear_left_wheel: not fixed to base_link"));
  EXPECT_THAT(refusal("{frame: lidar, preset: sick}"),
              HasSubstr(":3: mounts.0.preset = sick: must be one of rplidar_s2, utm30lx, tim571"));
  EXPECT_THAT(refusal("{frame: lidar_rear, preset: vlp16}"), HasSubstr(":3: mounts.0.preset = vlp16: must be one of"));
  EXPECT_THAT(refusal("{frame: lidar3d, preset: tim571}"),
              HasSubstr(":3: mounts.0.preset = tim571: must be one of vlp16"));
  EXPECT_THAT(refusal("{frame: gnss, preset: utm30lx}"), HasSubstr(":3: mounts.0.preset = utm30lx: only lidars have"));
  EXPECT_THAT(refusal("{frame: lidar, x_m: 9.0}"), HasSubstr(":3: mounts.0.x_m: 9.0 is out of range"));
  EXPECT_THAT(refusal("{frame: lidar, x: 0.1}"), HasSubstr(":3: mounts.0.x: unknown key"));
  EXPECT_THAT(refusal("{frame: lidar}\n  - {frame: lidar}"), HasSubstr(":4: mounts.1.frame = lidar: duplicate frame"));
  EXPECT_THAT(refusal("{}"), HasSubstr(":3: mounts.0.frame = : unknown frame"));
}

}  // namespace
}  // namespace patrol::app::sensor_needs_test
