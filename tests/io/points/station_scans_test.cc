#include "io/points/station_scans.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::station_scans_test {
namespace {

std::vector<StationScan> two_scans() {
  return {{.station = "goal_1",
           .T_map_scanner = to_pose3(Pose2{-31.0, 0.25, 3.0}, 0.75),
           .points = {{1.0F, -2.0F, 0.5F, 120.0F}, {-4.0F, 0.25F, 5.5F, 7.0F}}},
          {.station = "goal_2",
           .T_map_scanner = to_pose3(Pose2{-60.0, 0.5, -1.5}, 0.75),
           .points = {{8.0F, 9.0F, 1.5F, 0.0F}}}};
}

std::string error_text(const std::filesystem::path& folder) {
  try {
    load_station_scans(folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(StationScans, ComeBackWithTheirPlacesAndPoints) {
  const test::TemporaryFolder folder;
  save_station_scans(folder.path(), two_scans());
  const std::vector<StationScan> scans = load_station_scans(folder.path());
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[1].station, "goal_2");
  EXPECT_THAT(scans[1].T_map_scanner, test::Pose3Near(two_scans()[1].T_map_scanner, 1e-12, 1e-12));
  ASSERT_EQ(scans[0].points.size(), 2u);
  EXPECT_EQ(scans[0].points[1].z, 5.5F);
  EXPECT_EQ(scans[0].points[0].intensity, 120.0F);
  EXPECT_EQ(station_scan_files(folder.path()).size(), 3u);
}

TEST(StationScans, AStationThatLeadsOutOfTheFolderIsRefused) {
  const test::TemporaryFolder folder;
  save_station_scans(folder.path(), two_scans());
  save_text(folder.path() / "scans.json",
            R"([{"station": "../goal_1", "position": [0, 0, 1], "orientation": [0, 0, 0, 1]}])");
  EXPECT_EQ(error_text(folder.path()),
            (folder.path() / "scans.json").string() +
                ": [0]: station = ../goal_1: must be made of letters, digits and underlines");
}

TEST(StationScans, ACloudThatIsNotThereIsNamed) {
  const test::TemporaryFolder folder;
  save_station_scans(folder.path(), two_scans());
  std::filesystem::remove(folder.path() / "goal_2.ply");
  EXPECT_NE(error_text(folder.path()).find("goal_2.ply"), std::string::npos);
}

}  // namespace
}  // namespace patrol::io::station_scans_test
