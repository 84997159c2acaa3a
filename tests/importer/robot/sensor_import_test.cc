#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"
#include "tests/support/pose_near.h"

namespace patrol::importer::sensor_import_test {
namespace {

using test::VectorNear;
using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;

TEST(ImportSensors, SensorsAreFoundByTypeAndByOption) {
  const std::string sensors =
      joint("s1", "fixed", "base_link", "scanner_thing", "0.2 0 0.3", "", "0 0 0.5") +
      link("scanner_thing", inertial(0.2)) + joint("s2", "fixed", "base_link", "rtk", "-0.1 0 0.2") + link("rtk") +
      R"(<gazebo reference="scanner_thing"><sensor type="gpu_lidar" name="x"><pose>0 0 0.05 0 0 0</pose><lidar><scan><vertical><samples>1</samples></vertical></scan></lidar></sensor></gazebo>)"
      R"(<gazebo reference="scanner_thing"><sensor type="ray" name="y"><ray><scan><vertical><samples>16</samples></vertical></scan></ray></sensor></gazebo>)"
      R"(<gazebo reference="base_link"><sensor type="imu" name="z"/></gazebo>)"
      R"(<gazebo reference="base_link"><sensor type="camera" name="c"/></gazebo>)";
  Import import(robot(chassis() + two_wheels() + caster() + sensors));
  import.options.frames["gnss"] = "rtk";
  const RobotDescription& robot = import.load();
  EXPECT_THAT(robot.T_body("lidar").position, VectorNear(Eigen::Vector3d(0.2, 0.0, 0.35), 1e-9));
  EXPECT_NEAR(to_yaw(robot.T_body("lidar").rotation), 0.5, 1e-9);
  EXPECT_THAT(robot.T_body("lidar3d").position, VectorNear(Eigen::Vector3d(0.2, 0.0, 0.3), 1e-9));
  EXPECT_THAT(robot.T_body("imu").position, VectorNear(Eigen::Vector3d(0.0, 0.0, 0.0), 1e-9));
  EXPECT_THAT(robot.T_body("gnss").position, VectorNear(Eigen::Vector3d(-0.1, 0.0, 0.2), 1e-9));
  EXPECT_FALSE(robot.T_body_sensor.contains("depth_camera"));
  EXPECT_THAT(import.robot.settings, HasSubstr("lidar: {enabled: true}"));
  EXPECT_THAT(import.robot.settings, Not(HasSubstr("depth_camera")));
}

TEST(ImportSensors, ASensorThatTheFileHasTwiceIsNotLeftOutAndAnotherOneOfTheLinkIs) {
  const std::string imu = R"(<gazebo reference="base_link"><sensor type="imu" name="z"/></gazebo>)";
  Import twice(robot(chassis() + two_wheels() + caster() + imu + imu));
  twice.load();
  EXPECT_THAT(twice.assumptions(), Not(HasSubstr("further sensors of this type")));
  const std::string moved =
      R"(<gazebo reference="base_link"><sensor type="imu" name="y"><pose>0 0 0.1 0 0 0</pose></sensor></gazebo>)";
  Import two(robot(chassis() + two_wheels() + caster() + imu + moved));
  two.load();
  EXPECT_THAT(two.assumptions(), HasSubstr("further sensors of this type are left out: base_link"));
}

TEST(ImportSensors, WithoutSensorsAnImuIsAtTheCenterOfMassAndNoLidarIsAdded) {
  Import import(robot(link("base_link", inertial(20.0, "0.05 0 0.02", 0.5) + shape("collision", box(0.6, 0.4, 0.2))) +
                      two_wheels() + caster()));
  const RobotDescription& robot = import.load();
  EXPECT_THAT(robot.T_body("imu").position, VectorNear(Eigen::Vector3d(0.05, 0.0, 0.02), 1e-9));
  EXPECT_FALSE(robot.T_body_sensor.contains("lidar"));
}

TEST(ImportSensors, TheSettingsDisableNoAbsentSensorSoThatAMountSwitchesItOn) {
  Import import(robot(chassis() + two_wheels() + caster()));
  import.load();
  for (const char* sensor : {"lidar", "gnss", "depth_camera", "tdlas", "uwb"})
    EXPECT_THAT(import.robot.settings, Not(HasSubstr(sensor)));
}

TEST(ImportSensors, OfASensorThatTheFileLacksTheReportNamesLinksWithSuchANameAndChoosesNone) {
  const std::string links = joint("a", "fixed", "base_link", "IMU_frame", "0.1 0 0.1") + link("IMU_frame") +
                            joint("b", "fixed", "base_link", "base_scan", "0.2 0 0.3") + link("base_scan") +
                            joint("c", "fixed", "base_link", "front_laser", "0.3 0 0.3") + link("front_laser");
  Import import(robot(chassis() + two_wheels() + caster() + links));
  EXPECT_FALSE(import.load().T_body_sensor.contains("lidar"));
  EXPECT_THAT(import.assumptions(), AllOf(HasSubstr("no link of the file has one; links with such a name: IMU_frame |"),
                                          HasSubstr("ray or lidar; links with such a name: base_scan, front_laser |")));
  Import chosen(robot(chassis() + two_wheels() + caster() + links));
  chosen.options.frames["lidar"] = "base_scan";
  EXPECT_THAT(chosen.load().T_body("lidar").position, VectorNear(Eigen::Vector3d(0.2, 0.0, 0.3), 1e-9));
  EXPECT_THAT(chosen.assumptions(), Not(HasSubstr("front_laser")));
}

/// Fixed link with a lidar of Gazebo.
std::string lidar_on(const std::string& name, const std::string& xyz, const std::string& yaw, double half_fov_rad,
                     double range_m) {
  return joint(name + "_joint", "fixed", "base_link", name, xyz, "", "0 0 " + yaw) + link(name, inertial(0.2)) +
         fmt::format(
             R"(<gazebo reference="{}"><sensor type="ray" name="x"><ray><scan><horizontal><samples>720</samples>)"
             R"(<min_angle>-{}</min_angle><max_angle>{}</max_angle></horizontal></scan><range><min>0.1</min>)"
             R"(<max>{}</max></range></ray></sensor></gazebo>)",
             name, half_fov_rad, half_fov_rad, range_m);
}

TEST(ImportSensors, OfTwoLidarsTheOneThatLooksForwardIsTheFirstInAnyOrderOfTheFile) {
  const std::string bow = lidar_on("bow", "0.2 0.15 0.3", "0.785", 2.356, 30.0),
                    stern = lidar_on("stern", "-0.2 -0.15 0.3", "-2.356", 2.356, 30.0);
  for (const std::string& lidars : {bow + stern, stern + bow}) {
    Import import(robot(chassis() + two_wheels() + caster() + lidars));
    const RobotDescription& robot = import.load();
    EXPECT_THAT(robot.T_body("lidar").position, VectorNear(Eigen::Vector3d(0.2, 0.15, 0.3), 1e-9));
    EXPECT_THAT(robot.T_body("lidar_rear").position, VectorNear(Eigen::Vector3d(-0.2, -0.15, 0.3), 1e-9));
    EXPECT_THAT(import.assumptions(),
                HasSubstr("| lidar, lidar_rear | are the lidars that look most forward and most backward: bow at x = "
                          "0.20, y = 0.15 m, turned by 45 degrees; stern at x = -0.20, y = -0.15 m, turned by -135 "
                          "degrees |"));
  }
  Import chosen(robot(chassis() + two_wheels() + caster() + bow + stern));
  chosen.options.frames["lidar"] = "stern";
  EXPECT_THAT(chosen.load().T_body("lidar_rear").position, VectorNear(Eigen::Vector3d(0.2, 0.15, 0.3), 1e-9));
}

TEST(ImportSensors, TheHousingOfALidarMovesToItsFrameSoThatItsBeamsIgnoreIt) {
  const std::string housing = shape("visual", cylinder(0.04, 0.06), "0 0 -0.01") + shape("collision", sphere(0.03));
  std::string laser = lidar_on("laser", "0.2 0 0.3", "0.5", 2.356, 30.0);
  laser.insert(laser.find("</link>"), housing);
  Import import(robot(chassis() + two_wheels() + caster() + laser));
  import.load();
  const std::string& urdf = import.robot.urdf;
  const auto link_text = [&](const std::string& name) {
    const std::size_t begin = urdf.find("<link name=\"" + name + "\"");
    return urdf.substr(begin, urdf.find("<link name", begin + 1) - begin);
  };
  EXPECT_THAT(link_text("lidar"), AllOf(HasSubstr("<sphere radius=\"0.03\""), HasSubstr("xyz=\"0 0 -0.01\"")));
  EXPECT_THAT(link_text("laser"), Not(HasSubstr("geometry")));
  EXPECT_THAT(import.assumptions(), HasSubstr("| lidar | the shapes of laser are its housing"));

  std::string tower = lidar_on("tower", "0.2 0 0.3", "0", 2.356, 30.0);
  tower.insert(tower.find("</link>"), shape("collision", box(0.1, 0.1, 0.8)));
  Import large(robot(chassis() + two_wheels() + caster() + tower));
  large.load();
  EXPECT_THAT(large.assumptions(), Not(HasSubstr("housing")));
}

TEST(ImportSensors, ASecondLidarBecomesLidarRearWithThePresetOfItsNumbersAndAThirdIsLeftOut) {
  Import import(robot(chassis() + two_wheels() + caster() + lidar_on("bow", "0.2 0 0.3", "0", 2.356, 30.0) +
                      lidar_on("stern", "-0.2 0 0.3", "3.14159265", 2.356, 25.0) +
                      lidar_on("top", "0 0 0.6", "0", 1.0, 8.0)));
  const RobotDescription& robot = import.load();
  EXPECT_THAT(robot.T_body("lidar").position, VectorNear(Eigen::Vector3d(0.2, 0.0, 0.3), 1e-9));
  EXPECT_THAT(robot.T_body("lidar_rear").position, VectorNear(Eigen::Vector3d(-0.2, 0.0, 0.3), 1e-9));
  EXPECT_NEAR(std::abs(to_yaw(robot.T_body("lidar_rear").rotation)), M_PI, 1e-6);
  EXPECT_THAT(import.robot.settings, AllOf(HasSubstr("  lidar: {enabled: true, preset: utm30lx}\n"),
                                           HasSubstr("  lidar_rear: {enabled: true, preset: tim571}\n")));
  EXPECT_THAT(import.assumptions(),
              AllOf(HasSubstr("| lidar_rear | is the frame of stern | --frame lidar_rear=LINK |"),
                    HasSubstr("| lidar | is simulated as utm30lx, by its field of view and its range | "
                              "sensors.lidar.preset in imported.yaml |"),
                    HasSubstr("further sensors of this type are left out: top")));
}

TEST(ImportSensors, ALidarOfNoPresetHasTheNumbersOfTheFileOverTheNearestPresetWithARow) {
  Import import(robot(chassis() + two_wheels() + caster() + lidar_on("bow", "0.2 0 0.3", "0", 1.0, 8.0)));
  import.load();
  EXPECT_THAT(
      import.robot.settings,
      AllOf(
          HasSubstr("  lidar: {enabled: true, preset: tim571, beams: 720, fov_deg: 114.6, range_max_m: 8, range_min_m: "
                    "0.1}\n"),
          Not(HasSubstr("lidar_rear"))));
  EXPECT_THAT(import.assumptions(),
              HasSubstr("| lidar | is simulated as tim571 (270 degrees, 25 m) with beams: 720, fov_deg: 114.6, "
                        "range_max_m: 8, range_min_m: 0.1 of the file: no preset has its field of view of 115 degrees "
                        "and its range of 8 "
                        "m | sensors.lidar in imported.yaml |"));
}

TEST(ImportSensors, RateRingsAndMinimumRangeOfA3dLidarAreThoseOfTheFileWithinTheLimitsOfTheKeys) {
  Import import(robot(
      chassis() + two_wheels() + caster() + joint("top_joint", "fixed", "base_link", "top", "0 0 0.5") +
      link("top", inertial(0.2)) +
      R"(<gazebo reference="top"><sensor type="gpu_lidar" name="x"><update_rate>500</update_rate><lidar><scan><horizontal>)"
      R"(<samples>1024</samples><min_angle>-3.1416</min_angle><max_angle>3.1416</max_angle></horizontal><vertical>)"
      R"(<samples>32</samples><min_angle>-0.4363</min_angle><max_angle>0.2618</max_angle></vertical></scan><range>)"
      R"(<min>0.9</min><max>200</max></range></lidar></sensor></gazebo>)"));
  import.load();
  EXPECT_THAT(import.robot.settings,
              HasSubstr("  lidar3d: {enabled: true, preset: vlp16, beams: 1024, elevation_min_deg: -25, range_max_m: "
                        "200, range_min_m: 0.9, rings: 32}\n"));
  EXPECT_THAT(import.assumptions(), HasSubstr("; outside of the limits of the key: rate_hz: 500 |"));
}

TEST(ImportSensors, ALidarByOptionHasARowWithItsPresetAndTheNumbersOfASensorOnItsLink) {
  Import plain(robot(chassis() + two_wheels() + caster() + part("laser", inertial(0.2))));
  plain.options.frames["lidar"] = "laser";
  plain.load();
  EXPECT_THAT(plain.robot.settings, HasSubstr("  lidar: {enabled: true}\n"));
  EXPECT_THAT(plain.assumptions(),
              HasSubstr("| lidar | is simulated as rplidar_s2 (360 degrees, 30 m): the file states "
                        "neither its field of view nor its range | sensors.lidar in imported.yaml "
                        "|"));
  Import rear(robot(chassis() + two_wheels() + caster() + lidar_on("bow", "0.2 0 0.3", "0", 2.356, 30.0) +
                    lidar_on("stern", "-0.2 0 0.3", "0", 2.356, 25.0)));
  rear.options.frames["lidar_rear"] = "bow";
  const RobotDescription& robot = rear.load();
  EXPECT_NEAR(robot.T_body("lidar").position.x(), -0.2, 1e-9);
  EXPECT_NEAR(robot.T_body("lidar_rear").position.x(), 0.2, 1e-9);
  EXPECT_THAT(rear.robot.settings, AllOf(HasSubstr("  lidar: {enabled: true, preset: tim571}\n"),
                                         HasSubstr("  lidar_rear: {enabled: true, preset: utm30lx}\n")));
}

TEST(ImportSensors, ARaySensorOfUrdfStatesItsFieldOfViewAsAttributes) {
  Import import(robot(chassis() + two_wheels() + caster() + part("laser", inertial(0.2)) +
                      R"(<sensor name="y" update_rate="20"><parent link="laser"/><ray><horizontal samples="100" )"
                      R"(min_angle="-1.0" max_angle="1.0"/></ray></sensor>)"));
  import.load();
  EXPECT_THAT(import.robot.settings, HasSubstr("beams: 100, fov_deg: 114.6, rate_hz: 20}\n"));
  EXPECT_THAT(import.assumptions(), HasSubstr("of the file: the file states only its field of view of 115 degrees |"));
}

/// Robot with a lidar whose numbers are these texts.
std::string with_numbers(const std::string& min_angle, const std::string& max_angle, const std::string& range_max) {
  return robot(chassis() + two_wheels() + caster() + joint("bow_joint", "fixed", "base_link", "bow", "0.2 0 0.3") +
               link("bow", inertial(0.2)) +
               fmt::format(R"(<gazebo reference="bow"><sensor type="ray" name="x"><ray><scan><horizontal>)"
                           R"(<min_angle>{}</min_angle><max_angle>{}</max_angle></horizontal></scan>)"
                           R"(<range><max>{}</max></range></ray></sensor></gazebo>)",
                           min_angle, max_angle, range_max));
}

TEST(ImportSensors, NumbersOfALidarThatItCannotHaveAreARow) {
  Import equal(with_numbers("1", "1", "30"));
  equal.load();
  EXPECT_THAT(equal.assumptions(), HasSubstr("| bow | the field of view of its lidar selects no preset: max_angle = 1 "
                                             "is not above min_angle = 1 (line "));
  Import reversed(with_numbers("2.35", "-2.35", "30"));
  reversed.load();
  EXPECT_THAT(reversed.assumptions(), HasSubstr("max_angle = -2.35 is not above min_angle = 2.35"));
  Import negative(with_numbers("-2.35", "2.35", "-30"));
  negative.load();
  EXPECT_THAT(negative.assumptions(), HasSubstr("the range of its lidar selects no preset: max = -30 is not positive"));
}

TEST(ImportSensors, ASensorOfAnUnknownLinkIsARow) {
  Import import(robot(chassis() + two_wheels() + caster() +
                      R"(<gazebo reference="lazer"><sensor type="ray" name="x"><ray/></sensor></gazebo>)"
                      R"(<gazebo reference="nothing"><material>Gazebo/Red</material></gazebo>)"
                      R"(<sensor name="y"><parent link="lasar"/><ray/></sensor>)"));
  EXPECT_FALSE(import.load().T_body_sensor.contains("lidar"));
  EXPECT_THAT(import.assumptions(),
              AllOf(HasSubstr("| lazer | unknown link: its sensor in line "),
                    HasSubstr("| lasar | unknown link: its sensor in line "),
                    HasSubstr("no link of the file has a sensor of type ray or lidar"), Not(HasSubstr("nothing"))));
}

TEST(ImportSensors, AnInfiniteRangeOfALidarSelectsNoPreset) {
  Import import(with_numbers("-2.35", "2.35", "inf"));
  import.load();
  EXPECT_THAT(import.assumptions(), HasSubstr("no preset has its field of view of 269 degrees and its range of inf m"));
}

TEST(ImportSensors, TheOptionForTheLidarLeavesTheOtherLidarOfTheFileAsTheRearOne) {
  Import import(robot(chassis() + two_wheels() + caster() + lidar_on("bow", "0.2 0 0.3", "0", 2.356, 30.0) +
                      lidar_on("stern", "-0.2 0 0.3", "0", 2.356, 30.0)));
  import.options.frames["lidar"] = "stern";
  const RobotDescription& robot = import.load();
  EXPECT_NEAR(robot.T_body("lidar").position.x(), -0.2, 1e-9);
  EXPECT_NEAR(robot.T_body("lidar_rear").position.x(), 0.2, 1e-9);
}

}  // namespace
}  // namespace patrol::importer::sensor_import_test
