#include "io/ros/ros_messages.h"

#include <cstring>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "io/ros/ros_definitions.h"
#include "io/ros/ros_fields.h"
#include "tests/io/sample_messages.h"
#include "tests/support/pose_near.h"

namespace patrol::io::ros_messages_test {
namespace {

using namespace std::chrono_literals;
using test::Pose2Near, test::Pose3Near;

constexpr double kExactTol = 1e-12;
constexpr double kQuaternionTol = 1e-7;  // angle between two nearly equal rotations: the root of rounding

template <typename Message>
Message there_and_back(const Message& message) {
  return decode<Message>(encode(message));
}

/// The fields by name, as someone reads them who only knows the definition.
template <typename Message>
std::map<std::string, std::string> fields_of(const Message& message, const RosNames& names = {}) {
  std::map<std::string, std::string> fields;
  const std::string type = kRosType<Message>;
  for (const RosField& field : ros_fields(type, ros_definition(type), encode(message, names)))
    fields[field.path] = field.value;
  return fields;
}

// Little-endian XCDR1: encapsulation 00 01 00 00; sec, nanosec; a string with its length and final zero;
// padding to 8 counted from after the encapsulation; six doubles.
TEST(Encode, LaysAVelocityCommandOutByteForByte) {
  std::string expected("\x00\x01\x00\x00", 4);
  const auto append = [&](const auto& value) { expected.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
  append(std::int32_t{12});
  append(std::uint32_t{345'678'901});
  append(std::uint32_t{15});  // "base_footprint" and its zero: 12 + 15 = 27 bytes so far
  expected += std::string("base_footprint\0", 15) + std::string(5, '\0');
  for (const double value : {0.5, -0.25, 0.0, 0.0, 0.0, 1.0}) append(value);
  EXPECT_EQ(encode(test::sample_command()), expected);
}

/// Leaves memory that is not zero for the next who allocates.
void litter() {
  for (std::size_t size = 32; size <= 4096; size += 32) std::string(size, '\xab');
}

// Padding too: logs are compared byte for byte.
TEST(Encode, GivesTheSameBytesWhateverStoodInMemoryBefore) {
  std::apply(
      [](const auto&... message) {
        const auto check = [](const auto& one) {
          const std::string clean = encode(one);
          litter();
          EXPECT_EQ(encode(one), clean) << kRosType<std::decay_t<decltype(one)>>;
        };
        (check(message), ...);
      },
      test::all_samples());
}

TEST(Decode, GivesBackTheSameBytesForEveryMessage) {
  std::apply(
      [](const auto&... message) {
        const auto check = [](const auto& one) {
          using Message = std::decay_t<decltype(one)>;
          EXPECT_EQ(encode(decode<Message>(encode(one))), encode(one)) << kRosType<Message>;
        };
        (check(message), ...);
      },
      test::all_samples());
}

TEST(Decode, EveryMessageCutShortIsAnErrorThatNamesItsType) {
  std::apply(
      [](const auto&... message) {
        const auto check = [](const auto& one) {
          using Message = std::decay_t<decltype(one)>;
          const std::string bytes = encode(one);
          for (std::size_t size = 0; size < bytes.size(); ++size) {
            try {
              decode<Message>(std::string_view(bytes).substr(0, size));
              ADD_FAILURE() << kRosType<Message> << " of " << size << " bytes was accepted";
            } catch (const DecodeError& error) {
              EXPECT_NE(std::string(error.what()).find(kRosType<Message>), std::string::npos) << error.what();
            }
          }
        };
        (check(message), ...);
      },
      test::all_samples());
}

TEST(Decode, LaserScanKeepsEveryField) {
  const LaserScan was = test::sample_scan(), is = there_and_back(was);
  EXPECT_EQ(is.stamp, was.stamp);
  EXPECT_EQ(is.angle_min_rad, was.angle_min_rad);
  EXPECT_EQ(is.angle_increment_rad, was.angle_increment_rad);
  EXPECT_EQ(is.time_increment_s, was.time_increment_s);
  EXPECT_EQ(is.scan_time_s, was.scan_time_s);
  EXPECT_EQ(is.range_min_m, was.range_min_m);
  EXPECT_EQ(is.range_max_m, was.range_max_m);
  EXPECT_EQ(is.ranges_m, was.ranges_m);
  EXPECT_EQ(is.intensities, was.intensities);
}

/// Bytes of a scan of 5 beams from -1 rad on, 0.5 rad apart, whose angle_max is replaced.
std::string scan_with_angle_max(float angle_max_rad, double increment_rad = 0.5) {
  LaserScan scan = test::sample_scan();
  scan.angle_min_rad = -1.0;
  scan.angle_increment_rad = increment_rad;
  scan.ranges_m = {1.0F, 2.0F, 3.0F, 4.0F, 5.0F};
  std::string bytes = encode(scan);
  const float first = -1.0F;
  const std::size_t at = bytes.find(std::string(reinterpret_cast<const char*>(&first), sizeof first)) + sizeof first;
  bytes.replace(at, sizeof angle_max_rad, reinterpret_cast<const char*>(&angle_max_rad), sizeof angle_max_rad);
  return bytes;
}

TEST(Decode, LaserScanWhoseLastAngleIsMoreThanTwoIncrementsOffIsRefused) {
  for (const float angle_max_rad : {0.1F, 0.5F, 1.0F, 1.5F, 1.9F})
    EXPECT_EQ(decode<LaserScan>(scan_with_angle_max(angle_max_rad)).ranges_m.size(), 5u) << angle_max_rad;
  for (const float angle_max_rad : {-1.0F, -0.1F, 2.1F, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_THROW(decode<LaserScan>(scan_with_angle_max(angle_max_rad)), DecodeError) << angle_max_rad;
  try {
    decode<LaserScan>(scan_with_angle_max(3.0F));
    ADD_FAILURE();
  } catch (const DecodeError& error) {
    EXPECT_STREQ(error.what(),
                 "angle_max 3 rad contradicts the angle of the last of 5 beams, 1 rad by angle_min and "
                 "angle_increment");
  }
}

TEST(Decode, LaserScanOfSeveralBeamsWithoutAnIncrementIsRefused) {
  try {
    decode<LaserScan>(scan_with_angle_max(-1.0F, 0.0));
    ADD_FAILURE();
  } catch (const DecodeError& error) {
    EXPECT_STREQ(error.what(), "angle_increment is 0 in a scan of 5 beams");
  }
}

TEST(Decode, PointCloudKeepsEveryPoint) {
  const PointCloud was = test::sample_cloud(), is = there_and_back(was);
  EXPECT_EQ(is.stamp, was.stamp);
  ASSERT_EQ(is.points.size(), was.points.size());
  for (std::size_t i = 0; i < was.points.size(); ++i) {
    EXPECT_EQ(std::tie(is.points[i].x, is.points[i].y, is.points[i].z, is.points[i].intensity, is.points[i].time_s,
                       is.points[i].ring),
              std::tie(was.points[i].x, was.points[i].y, was.points[i].z, was.points[i].intensity, was.points[i].time_s,
                       was.points[i].ring));
  }
}

TEST(Decode, SensorsKeepTheirReadings) {
  EXPECT_EQ(there_and_back(test::sample_imu()).angular_velocity_radps, test::sample_imu().angular_velocity_radps);
  EXPECT_EQ(there_and_back(test::sample_imu()).linear_acceleration_mps2, test::sample_imu().linear_acceleration_mps2);
  EXPECT_EQ(there_and_back(test::sample_joints()).position_rad, test::sample_joints().position_rad);
  EXPECT_EQ(there_and_back(test::sample_joints()).velocity_radps, test::sample_joints().velocity_radps);
  EXPECT_EQ(there_and_back(test::sample_joints()).effort_nm, test::sample_joints().effort_nm);
  EXPECT_EQ(there_and_back(test::sample_contacts()).force_n, test::sample_contacts().force_n);
  const GasReading gas = there_and_back(test::sample_gas());
  EXPECT_EQ(gas.column_ppm_m, 123.5);
  EXPECT_EQ(gas.path_length_m, std::numeric_limits<double>::infinity());
  EXPECT_EQ(gas.mean_mg_m3, 7.25);
}

TEST(Decode, GnssKeepsStatusPlaceAndDeviations) {
  for (const GnssStatus status : {GnssStatus::kNone, GnssStatus::kFloat, GnssStatus::kFix}) {
    const GnssFix fix = there_and_back(test::sample_fix(status));
    EXPECT_EQ(fix.status, status);
    EXPECT_EQ(fix.latitude_deg, 52.5);
    EXPECT_EQ(fix.longitude_deg, -13.25);
    EXPECT_EQ(fix.altitude_m, 34.5);
    EXPECT_EQ(fix.position_std_m, Eigen::Vector3d(0.5, 0.25, 2.0));
  }
}

TEST(Decode, EstimatesKeepPoseTwistAndCovariance) {
  const OdometryEstimate odometry = there_and_back(test::sample_odometry());
  EXPECT_THAT(odometry.T_odom_body, Pose3Near(test::sample_pose(), 0.0, kQuaternionTol));
  EXPECT_EQ(odometry.twist.linear, test::sample_odometry().twist.linear);
  EXPECT_EQ(odometry.twist.angular, test::sample_odometry().twist.angular);
  EXPECT_EQ(odometry.planar_covariance, test::sample_covariance());
  const PoseEstimate estimate = there_and_back(test::sample_estimate());
  EXPECT_THAT(estimate.T_map_body, Pose2Near(test::sample_estimate().T_map_body, 0.0, kExactTol));
  EXPECT_EQ(estimate.covariance, test::sample_covariance());
  const ParticleSet particles = there_and_back(test::sample_particles());
  EXPECT_EQ(particles.weights, test::sample_particles().weights);
  ASSERT_EQ(particles.T_map_body.size(), 2U);
  EXPECT_THAT(particles.T_map_body[1], Pose2Near((Pose2{3.0, 4.0, -0.5}), 0.0, kExactTol));
}

TEST(Decode, MapKeepsItsFrameAndItsCells) {
  const MapUpdate was = test::sample_map(), is = there_and_back(was);
  EXPECT_EQ(is.stamp, was.stamp);
  EXPECT_EQ(is.map.values(), was.map.values());
  EXPECT_EQ(is.map.geometry().width, 3);
  EXPECT_EQ(is.map.geometry().height, 2);
  EXPECT_EQ(is.map.geometry().resolution_m, 0.05) << "though float32 cannot hold it";
  EXPECT_EQ(is.map.geometry().origin_m, was.map.geometry().origin_m);
}

TEST(Decode, CommandsEventsAndTruthKeepEveryField) {
  EXPECT_EQ(there_and_back(test::sample_panorama()).points[1].z, 5.5F);
  EXPECT_EQ(there_and_back(test::sample_antenna()).pitch_rad, -0.25);
  EXPECT_EQ(there_and_back(test::sample_sounding()).rate_tps, test::sample_sounding().rate_tps);
  const LiningResult lining = there_and_back(test::sample_lining());
  EXPECT_EQ(lining.cells[0].points, 340);
  EXPECT_EQ(lining.lines[0].name, "9-3");
  EXPECT_EQ(lining.findings[0].level, WarningLevel::kWarning);
  EXPECT_EQ(lining.findings[0].p_map, test::sample_lining().findings[0].p_map);
  const WaterResult water = there_and_back(test::sample_water());
  EXPECT_EQ(water.covariance_m2, test::sample_water().covariance_m2);
  EXPECT_EQ(water.radius_high_m, 5.5);
  EXPECT_EQ(water.level, WarningLevel::kAlarm);
  const VelocityCommand command = there_and_back(test::sample_command());
  EXPECT_EQ(std::tie(command.vx_mps, command.vy_mps, command.yaw_rate_radps), std::make_tuple(0.5, -0.25, 1.0));
  const Event was = test::sample_event(), is = there_and_back(was);
  EXPECT_EQ(std::tie(is.stamp, is.kind, is.subject, is.text, is.value),
            std::tie(was.stamp, was.kind, was.subject, was.text, was.value));
  EXPECT_THAT(is.T_map_body, Pose2Near(was.T_map_body, 0.0, kExactTol));
  EXPECT_EQ(is.p_map_target, was.p_map_target);
  Event foreign = was;
  set_kind(foreign, "elevator_called");
  EXPECT_EQ(kind_text(there_and_back(foreign)), "elevator_called");
  EXPECT_THAT(there_and_back(test::sample_truth()).T_world_body, Pose3Near(test::sample_pose(), 0.0, kQuaternionTol));
  EXPECT_EQ(there_and_back(test::sample_truth()).twist.angular, test::sample_truth().twist.angular);
  EXPECT_EQ(there_and_back(test::sample_state()).qpos, test::sample_state().qpos);
  EXPECT_EQ(there_and_back(test::sample_state()).mocap, test::sample_state().mocap);
  EXPECT_EQ(there_and_back(test::sample_collision()).first, "FL_shank");
  EXPECT_EQ(there_and_back(test::sample_collision()).second, "house_7");
  EXPECT_EQ(there_and_back(test::sample_path()).T_map_body.size(), 2U);
  EXPECT_THAT(there_and_back(test::sample_path()).T_map_body[1], Pose2Near((Pose2{3.0, 4.0, -0.5}), 0.0, kExactTol));
}

TEST(Decode, ATrajectoryKeepsTheStampOfEveryPose) {
  const TrajectoryEstimate was{
      .stamp = from_seconds(9.0),
      .T_map_body = {{from_seconds(1.5), to_pose3({1.0, 2.0, 0.25})}, {from_seconds(1.5), to_pose3({3.0, 4.0, -3.0})}}};
  const TrajectoryEstimate is = there_and_back(was);
  EXPECT_EQ(is.stamp, was.stamp);
  ASSERT_EQ(is.T_map_body.size(), 2U);
  EXPECT_EQ(is.T_map_body[1].stamp, from_seconds(1.5));
  EXPECT_THAT(is.T_map_body[1].pose, Pose3Near(was.T_map_body[1].pose, 0.0, kQuaternionTol));
}

TEST(Decode, RecordedOdometryKeepsItsPose) {
  const RecordedOdometry is =
      there_and_back(RecordedOdometry{.stamp = from_seconds(7.25), .T_odom_body = {-31.0, 12.5, 3.0}});
  EXPECT_EQ(is.stamp, from_seconds(7.25));
  EXPECT_THAT(is.T_odom_body, Pose2Near((Pose2{-31.0, 12.5, 3.0}), 0.0, kExactTol));
}

TEST(Decode, EmptyListsStayEmpty) {
  EXPECT_TRUE(there_and_back(LaserScan{}).ranges_m.empty());
  EXPECT_TRUE(there_and_back(PointCloud{}).points.empty());
  EXPECT_TRUE(there_and_back(ParticleSet{}).weights.empty());
  EXPECT_TRUE(there_and_back(MapUpdate{}).map.values().empty());
  EXPECT_TRUE(there_and_back(Path{}).T_map_body.empty());
}

// What ROS readers see under their own names.
TEST(Encode, AStampBeforeZeroHasNanosecondsBelowASecond) {
  const MessageHeader header = header_of(encode(VelocityCommand{.stamp = -20ms}));
  EXPECT_EQ(header.seconds, -1);
  EXPECT_EQ(header.nanoseconds, 980'000'000U);
  EXPECT_EQ(header.stamp(), -20ms);
  EXPECT_EQ(header.frame, "base_footprint");
}

template <typename Message, typename Field>
bool finds_nan(Message message, Field field) {
  field(message) = std::numeric_limits<double>::quiet_NaN();
  return !has_finite_numbers(message);
}

TEST(HasFiniteNumbers, ANaNInAnyOfNineTypesIsFound) {
  EXPECT_TRUE(has_finite_numbers(test::sample_path()));
  EXPECT_TRUE(has_finite_numbers(test::sample_lining()));
  EXPECT_TRUE(finds_nan(test::sample_path(), [](Path& path) -> double& { return path.T_map_body[1].x; }));
  EXPECT_TRUE(
      finds_nan(test::sample_trust(), [](LocalizationConfidence& trust) -> double& { return trust.confidence; }));
  EXPECT_TRUE(finds_nan(test::sample_particles(), [](ParticleSet& set) -> double& { return set.weights[1]; }));
  EXPECT_TRUE(finds_nan(test::sample_event(), [](Event& event) -> double& { return event.value; }));
  EXPECT_TRUE(
      finds_nan(test::sample_lining(), [](LiningResult& lining) -> double& { return lining.cells[0].inward_m; }));
  EXPECT_TRUE(finds_nan(test::sample_water(), [](WaterResult& water) -> double& { return water.radius_m; }));
  EXPECT_TRUE(finds_nan(test::sample_calibration(),
                        [](CalibrationEstimate& estimate) -> double& { return estimate.values[1].std; }));
  EXPECT_TRUE(finds_nan(test::sample_odometry(),
                        [](OdometryEstimate& odometry) -> double& { return odometry.twist.linear.y(); }));
  EXPECT_TRUE(
      finds_nan(test::sample_estimate(), [](PoseEstimate& estimate) -> double& { return estimate.covariance(2, 2); }));
}

TEST(RosFields, ReadEveryMessageByItsDefinitionAlone) {
  EXPECT_EQ(fields_of(test::sample_scan()).at("header.frame_id"), "\"lidar\"");
  EXPECT_EQ(fields_of(test::sample_scan()).at("header.stamp.nanosec"), "345678901");
  EXPECT_EQ(fields_of(test::sample_scan()).at("angle_max"), "-1.75");  // -2.5 + 3 x 0.25
  EXPECT_EQ(fields_of(test::sample_scan()).at("ranges[1]"), "-inf");
  EXPECT_EQ(fields_of(test::sample_scan()).at("intensities[2]"), "255");
  EXPECT_EQ(fields_of(test::sample_cloud()).at("fields[4].name"), "\"ring\"");
  EXPECT_EQ(fields_of(test::sample_cloud()).at("row_step"), "44");
  EXPECT_EQ(fields_of(test::sample_imu()).at("linear_acceleration.z"), "9.81");
  EXPECT_EQ(fields_of(test::sample_imu()).at("orientation_covariance[0]"), "-1");
  EXPECT_EQ(fields_of(test::sample_joints(), {.joints = {"hip", "knee"}}).at("name[1]"), "\"knee\"");
  EXPECT_EQ(fields_of(test::sample_contacts()).at("force_n[3]"), "30.25");
  EXPECT_EQ(fields_of(test::sample_gas()).at("mean_mg_m3"), "7.25");
  EXPECT_EQ(fields_of(test::sample_fix()).at("status.status"), "2");
  EXPECT_EQ(fields_of(test::sample_fix()).at("position_covariance[8]"), "4");
  EXPECT_EQ(fields_of(test::sample_odometry()).at("child_frame_id"), "\"base_link\"");
  EXPECT_EQ(fields_of(test::sample_odometry()).at("pose.covariance[11]"), "5");  // y with yaw
  EXPECT_EQ(fields_of(test::sample_estimate()).at("header.frame_id"), "\"map\"");
  EXPECT_EQ(fields_of(test::sample_particles()).at("particles[1].weight"), "0.75");
  EXPECT_EQ(fields_of(test::sample_map()).at("data[2]"), "100");
  EXPECT_EQ(fields_of(test::sample_map()).at("info.width"), "3");
  EXPECT_EQ(fields_of(test::sample_path()).at("poses[1].pose.position.x"), "3");
  EXPECT_EQ(fields_of(test::sample_command()).at("twist.angular.z"), "1");
  EXPECT_EQ(fields_of(test::sample_event()).at("target.y"), "-4");
  EXPECT_EQ(fields_of(test::sample_truth()).at("header.frame_id"), "\"world\"");
  EXPECT_EQ(fields_of(test::sample_state()).at("mocap[1]"), "5");
  EXPECT_EQ(fields_of(test::sample_collision()).at("second"), "\"house_7\"");
  EXPECT_EQ(fields_of(test::sample_transforms()).at("transforms[0].child_frame_id"), "\"odom\"");
}

// A float32 does not represent 0.05, 0.1 or 1/30: the shortest decimal is meant.
TEST(Decode, MapKeepsAResolutionThatIsNoMultipleOfATenthOfAMillimeter) {
  const auto read = [](double resolution_m) {
    return there_and_back(MapUpdate{.stamp = {}, .map = OccupancyGrid({.resolution_m = resolution_m})})
        .map.geometry()
        .resolution_m;
  };
  for (const double resolution_m : {0.05, 0.1, 0.02, 0.0254, 0.03125, 0.03333, 0.0333333, 1.0, 0.0001, 12.3456})
    EXPECT_EQ(read(resolution_m), resolution_m);
  EXPECT_NEAR(read(1.0 / 30.0), 1.0 / 30.0, 4e-9);  // spacing of float32
}

TEST(Decode, AMapFarFromTheOriginOfItsFrameIsRefused) {
  const auto read = [](double x_m, double y_m) {
    there_and_back(MapUpdate{
        .stamp = {}, .map = OccupancyGrid({.resolution_m = 0.05, .width = 1, .height = 1, .origin_m = {x_m, y_m}})});
  };
  EXPECT_NO_THROW(read(-500'000.0, 5'400'000.0));  // UTM
  for (const double far_m : {1e300, -1e300, 2e7}) {
    EXPECT_THROW(read(far_m, 0.0), DecodeError);
    EXPECT_THROW(read(0.0, far_m), DecodeError);
  }
}

TEST(RosFields, BytesThatDoNotFitTheDefinitionAreRefused) {
  const std::string type = kRosType<Imu>;
  EXPECT_THROW(ros_fields(type, ros_definition(type), "\x00\x01"), InputError);
  EXPECT_THROW(ros_fields(type, ros_definition(type), encode(test::sample_command())), InputError);
}

TEST(CheckRosMessage, NamesOfTheSamePackageConstantsAndBoundsAreUnderstood) {
  const std::string definition =
      "uint8 LIMIT=3\nstring<=10 name\nfloat64[<=5] values\nPoint[] points\n"
      "================\nMSG: my/Point\nfloat32 x\nfloat32 y\n";
  std::string bytes(
      "\x00\x01\x00\x00\x02\x00\x00\x00"
      "a\x00\x00\x00\x00\x00\x00\x00\x01\x00\x00\x00",
      20);
  bytes += std::string(8, '\1');
  EXPECT_NO_THROW(check_ros_message("my/msg/Cloud", definition, bytes));
}

TEST(CheckRosMessage, ATypeInItselfAndBillionsOfElementsAreRefused) {
  const std::string head("\x00\x01\x00\x00", 4);
  EXPECT_THROW(check_ros_message("my/msg/A", "A a\n", head + "1234"), InputError);
  EXPECT_THROW(check_ros_message("my/msg/A", "B[] b\n===\nMSG: my/B\n", head + "\xff\xff\xff\xff"), InputError);
  EXPECT_THROW(check_ros_message("my/msg/A", "uint8[x] b\n", head + "1234"), InputError);
}

TEST(RosDefinition, CarriesEveryTypeItUsesOnce) {
  const std::string text = ros_definition("nav_msgs/msg/Odometry");
  for (const char* used :
       {"MSG: std_msgs/Header\n", "MSG: geometry_msgs/PoseWithCovariance\n", "MSG: geometry_msgs/Vector3\n"}) {
    const std::size_t at = text.find(used);
    ASSERT_NE(at, std::string::npos) << used;
    EXPECT_EQ(text.find(used, at + 1), std::string::npos) << used;
  }
  EXPECT_THROW(ros_definition("nav_msgs/msg/Odometrie"), std::logic_error);
}

}  // namespace
}  // namespace patrol::io::ros_messages_test
