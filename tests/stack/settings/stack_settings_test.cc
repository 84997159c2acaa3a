#include "stack/settings/stack_settings.h"

#include <set>
#include <string_view>

#include <gtest/gtest.h>

#include "core/error.h"
#include "slam/methods/mapper.h"
#include "tests/support/room_world.h"

namespace patrol::stack::stack_settings_test {
namespace {

/// Along a room for 3 m, by the method that the settings name.
std::unique_ptr<slam::Mapper> map_room(const StackSettings& settings) {
  test::RoomWorld room;
  room.add_box(-3.0, -2.0, 6.0, 4.0);
  std::unique_ptr<slam::Mapper> mapper = slam::make_mapper(settings.slam, {}, 1);
  for (int i = 0; i <= 30; ++i) {
    const Pose2 pose{0.1 * i, 0.0, 0.0};
    const slam::SlamUpdate update = mapper->update(room.scan(pose, {}), pose);
    EXPECT_NEAR(update.T_map_body.x, pose.x, 0.02) << i;
  }
  return mapper;
}

template <typename Table>
void expect_documented(const Table& table) {
  std::set<std::string_view> names;
  for (const auto& row : table) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name << " is a duplicate";
    EXPECT_FALSE(row.summary.empty()) << row.name;
    EXPECT_NE(row.summary.back(), '.') << row.name << ": a line of `patrol list` has no full stop";
  }
}

TEST(Algorithms, HaveUniqueNamesAndADocumentationLine) {
  expect_documented(slam::mapping_methods());
  expect_documented(slam::kRbpfOdometries);
  expect_documented(slam::optimizers());
  expect_documented(slam::resamplers());
  expect_documented(localize::sensor_models());
  expect_documented(plan::route_planners());
  expect_documented(plan::local_planners());
}

TEST(MakeMapper, TheFilterHasAsManyParticlesAsAskedForAndTheGraphNone) {
  StackSettings settings;
  settings.slam.method = "rbpf";
  settings.slam.rbpf.filter.particles = 12;
  EXPECT_EQ(map_room(settings)->particles().T_map_body.size(), 12U);
  settings.slam.method = "graph";
  EXPECT_TRUE(map_room(settings)->particles().T_map_body.empty());
}

TEST(MakeMapper, BothMethodsMapTheSameRoom) {
  for (const char* method : {"graph", "rbpf"}) {
    StackSettings settings;
    settings.slam.method = method;
    const OccupancyGrid map = map_room(settings)->map();
    EXPECT_EQ(map.at(map.geometry().cell_at({1.0, 1.0})), kFree) << method;
    EXPECT_NEAR(map.geometry().width * map.geometry().resolution_m, 9.0, 0.2) << method;
  }
}

TEST(MakeMapper, ARunHasEveryMethodOfRecordedLogs) {
  StackSettings settings;
  for (const std::string& method : names_of(slam::mapping_methods())) {
    settings.slam.method = method;
    validate(settings, "stack");
    EXPECT_EQ(map_room(settings)->path().size(), 31U) << method;
  }
}

// A robot's own odometry is used as it is, that of a log is corrected first: the same method with other settings.
TEST(StackSettings, TheFilterOfARunAndOfALogDifferInSettingsOnly) {
  EXPECT_EQ(StackSettings{}.slam.rbpf.odometry, "given");
  EXPECT_EQ(slam::MapperSettings{}.rbpf.odometry, "scan_matched");
}

TEST(StackSettings, AMappingMethodThatIsNotThereIsRefusedByName) {
  StackSettings settings;
  settings.slam.method = "grpah";
  try {
    validate(settings, "stack");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("stack.slam.method"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace patrol::stack::stack_settings_test
