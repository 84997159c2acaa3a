#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "importer/site/points_site.h"
#include "io/points/pcd.h"
#include "io/points/ply.h"
#include "tests/importer/site/scanned_room.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer {
namespace {

std::vector<ScannerPoint> room_cloud() {
  std::vector<ScannerPoint> points;
  for (const Eigen::Vector3d& origin : {Eigen::Vector3d(-2.0, -1.0, 1.7), Eigen::Vector3d(2.0, 1.0, 1.7)}) {
    for (const ScannerPoint& point : ScannedRoom{}.scan("s", origin).points) points.push_back(point);
  }
  return points;
}

/// Text of a PLY file with coordinates in double precision.
std::string ply_text(const std::vector<ScannerPoint>& points, const Eigen::Vector3d& offset,
                     const std::string& more = "") {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double "
      "z\n{}end_header\n",
      points.size(), more);
  for (const ScannerPoint& p : points)
    text += fmt::format("{:.4f} {:.4f} {:.4f}\n", double{p.x} + offset.x(), double{p.y} + offset.y(),
                        double{p.z} + offset.z());
  return text;
}

std::string complaint_about(const std::string& name, const std::string& content) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / name, content);
  try {
    import_site({.file = folder / name, .name = "room"});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CloudSite, RoomWithoutOriginsFacesInward) {
  const ScannedRoom room;
  const ImportedSite site = site_of_cloud({.points = room_cloud()}, "room.ply", {.file = "room.ply", .name = "room"});
  double area_m2 = 0.0, near_m2 = 0.0, facing_m2 = 0.0;
  for (const SiteTriangle& triangle : triangles_of(site)) {
    if (triangle.is_filled_in) continue;
    area_m2 += triangle.area_m2();
    const double off_m = std::min((triangle.center - room.walls.min()).cwiseAbs().minCoeff(),
                                  (room.walls.max() - triangle.center).cwiseAbs().minCoeff());
    if (off_m < 0.005) near_m2 += triangle.area_m2();
    if (triangle.area_normal.dot(Eigen::Vector3d(0.0, 0.0, 1.5) - triangle.center) > 0.0)
      facing_m2 += triangle.area_m2();
  }
  // The walls, floor and ceiling have 180 m2.
  EXPECT_GT(area_m2, 165.0);
  EXPECT_LT(area_m2, 200.0);
  EXPECT_GT(near_m2 / area_m2, 0.97);
  EXPECT_GT(facing_m2 / area_m2, 0.97);
  EXPECT_THAT(assumption(site, "normals"), testing::HasSubstr("nearest place where a person can stand"));
}

TEST(CloudSite, TheRowOfTheGroundStatesItsHeight) {
  const ImportedSite site = site_of_cloud({.points = room_cloud()}, "room.ply", {.file = "room.ply", .name = "room"});
  const auto ground = std::find_if(site.assumptions.begin(), site.assumptions.end(),
                                   [](const Assumption& row) { return row.subject == "ground"; });
  ASSERT_NE(ground, site.assumptions.end());
  EXPECT_THAT(ground->text, testing::MatchesRegex(".*: heights from -?0.0. to 0.0. m"));
}

TEST(CloudSite, ACloudWithoutAFloorIsRefusedAndNotDrivenOnItsCeiling) {
  std::vector<ScannerPoint> points;
  for (const ScannerPoint& point : room_cloud()) {
    if (point.z > 0.05f) points.push_back(point);
  }
  try {
    site_of_cloud({.points = points}, "room.ply", {.file = "room.ply", .name = "room"});
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::MatchesRegex("room.ply: [0-9]+ % of the surfaces are below the lowest large "
                                                    "level one, at [23].[0-9]+ m: the cloud must contain the floor"));
  }
}

TEST(CloudSite, CoordinatesOfMillionsOfMetersAreShifted) {
  const test::TemporaryFolder folder;
  const Eigen::Vector3d utm(447'312.25, 5'411'890.5, 212.0);
  test::write_bytes(folder / "room.ply", ply_text(room_cloud(), utm));
  const ImportedSite site = import_site({.file = folder / "room.ply", .name = "room"});
  EXPECT_EQ(assumption(site, "origin"), "the origin of site is (447300, 5411900, 200) in the file");
  // The floor remains level: as floats, coordinates of millions of meters have steps of 0.5 m.
  const Eigen::AlignedBox3d floor(Eigen::Vector3d(8.0, -13.0, 11.995), Eigen::Vector3d(16.5, -6.0, 12.005));
  EXPECT_GT(area_in(site, floor, false), 40.0);
}

TEST(CloudSite, CoordinatesOfMillionsOfMetersInSinglePrecisionAreRefused) {
  const test::TemporaryFolder folder;
  std::vector<ScannerPoint> points = room_cloud();
  for (ScannerPoint& point : points) point.y += 5'411'890.5f;
  io::save_pcd(folder / "room.pcd", points);
  EXPECT_THAT([&] { import_site({.file = folder / "room.pcd", .name = "room"}); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr(
                  "room.pcd: coordinates up to 5.41e+06 m in single precision are up to 0.65 m apart")));
}

TEST(CloudSite, CoordinatesBeyond100000KilometersAreRefused) {
  EXPECT_THAT(complaint_about("room.ply", ply_text(room_cloud(), {1e15, 0.0, 0.0})),
              testing::HasSubstr("room.ply: coordinates up to 1e+15 m: must be at most 1e+08 m"));
}

TEST(CloudSite, ACloudOfAFewPointsIsRefused) {
  std::vector<ScannerPoint> points;
  for (int i = 0; i < 64; ++i) points.push_back({0.3f * float(i % 8), 0.3f * float(i / 8), 0.0f, 0.0f});
  for (int i = 0; i < 9; ++i) points.push_back({3.0f * float(i), 20.0f + float(i * i), 1.0f + float(i), 0.0f});
  EXPECT_THAT(complaint_about("few.ply", ply_text(points, {0, 0, 0})),
              testing::MatchesRegex(".*few.ply: 6[0-9] of 73 points are on surfaces: at least 100 are needed"));
}

TEST(CloudSite, PointsThatAreNotFiniteAreLeftOut) {
  const test::TemporaryFolder folder;
  std::vector<ScannerPoint> points = room_cloud();
  points[5].x = points[100].z = std::numeric_limits<float>::quiet_NaN();
  points[2000].y = std::numeric_limits<float>::infinity();
  io::save_pcd(folder / "room.pcd", points);
  const ImportedSite site = import_site({.file = folder / "room.pcd", .name = "room"});
  EXPECT_EQ(assumption(site, "invalid points"), "3 points are not finite, invalid, noise or withheld: left out");
}

TEST(CloudSite, ScaleAndUpAxisApply) {
  std::vector<ScannerPoint> points = room_cloud();
  // Millimeters with y up.
  for (ScannerPoint& p : points) p = {1000.0f * p.x, 1000.0f * p.z, -1000.0f * p.y, p.intensity};
  const ImportedSite site =
      site_of_cloud({.points = points}, "room.ply", {.file = "room.ply", .name = "room", .scale = 0.001, .up = "y"});
  const Eigen::AlignedBox3d floor(Eigen::Vector3d(-4.1, -3.1, -0.01), Eigen::Vector3d(4.1, 3.1, 0.01));
  EXPECT_NEAR(area_in(site, floor, false) + area_in(site, floor, true), 48.0, 4.0);
}

TEST(CloudSite, BrokenFilesAreRefusedInOneLine) {
  EXPECT_THAT(complaint_about("none.ply", ply_text({}, {0, 0, 0})),
              testing::HasSubstr("none.ply: has fewer than three points"));
  EXPECT_THAT(complaint_about("one.ply", ply_text({{1, 2, 3, 0}}, {0, 0, 0})),
              testing::HasSubstr("has fewer than three points"));
  EXPECT_THAT(complaint_about("two.ply", ply_text({{0, 0, 0, 0}, {5, 0, 0, 0}, {0, 9, 0, 0}}, {0, 0, 0})),
              testing::HasSubstr("the points form no surface"));
  EXPECT_THAT(complaint_about("text.pcd", "hello\n"), testing::HasSubstr("is not a line of a PCD header"));
  EXPECT_THAT(complaint_about("cloud.las", "LASF"), testing::HasSubstr("cloud.las: is not a LAS file"));
  EXPECT_THAT(complaint_about("cloud.e57", "ASTM"), testing::HasSubstr("cloud.e57: is not an E57 file"));
  EXPECT_THAT(complaint_about("cloud.dwg", "AC10"), testing::HasSubstr("extension of a site file must be one of"));
}

}  // namespace
}  // namespace patrol::importer
