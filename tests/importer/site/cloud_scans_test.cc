#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "importer/site/points/panorama.h"
#include "importer/site/points_site.h"
#include "importer/site/site_mjcf.h"
#include "tests/importer/site/scanned_room.h"
#include "tests/io/e57_writer.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer {
namespace {

const Eigen::Vector3d kWest(-2.0, -1.0, 1.7), kEast(2.0, 1.0, 1.7), kNorth(0.0, 2.2, 1.7);
const Eigen::AlignedBox3d kCabinet(Eigen::Vector3d(-0.4, -0.4, 0.0), Eigen::Vector3d(0.4, 0.4, 1.4));

ImportedSite site_of_rooms(const std::vector<ScannedRoom>& rooms, const std::vector<Eigen::Vector3d>& origins) {
  io::RelativeScans scans;
  for (std::size_t i = 0; i < origins.size(); ++i)
    scans.scans.push_back(rooms[std::min(i, rooms.size() - 1)].scan("s" + std::to_string(i), origins[i]));
  return site_of_scans(std::move(scans), "scans", {.file = "scans", .name = "room"});
}

double distance_to_walls_m(const ScannedRoom& room, const Eigen::Vector3d& p) {
  return std::min((p - room.walls.min()).cwiseAbs().minCoeff(), (room.walls.max() - p).cwiseAbs().minCoeff());
}

TEST(ScansSite, BoxRoomOfTwoScansIsWithinThreeMillimetersAndFacesTheScanners) {
  const ScannedRoom room;
  const ImportedSite site = site_of_rooms({room}, {kWest, kEast});
  double area_m2 = 0.0, near_m2 = 0.0, facing_m2 = 0.0;
  for (const SiteTriangle& triangle : triangles_of(site)) {
    if (triangle.is_filled_in) continue;
    area_m2 += triangle.area_m2();
    if (distance_to_walls_m(room, triangle.center) < 0.003) near_m2 += triangle.area_m2();
    if (triangle.area_normal.dot(Eigen::Vector3d(0.0, 0.0, 1.5) - triangle.center) > 0.0)
      facing_m2 += triangle.area_m2();
  }
  // 2 (8 x 6 + 8 x 3 + 6 x 3) = 180 m2. Patches of both scans overlap where the distances of their beams are similar,
  // and each patch overlaps its neighbors by 2 cm.
  EXPECT_GT(area_m2, 178.0);
  EXPECT_LT(area_m2, 280.0);
  EXPECT_GT(near_m2 / area_m2, 0.99);
  EXPECT_GT(facing_m2 / area_m2, 0.999);
}

TEST(ScansSite, HoleBelowTheScannerIsFilledInAndMarked) {
  const ImportedSite site = site_of_rooms({ScannedRoom{}}, {kWest});
  const double radius_m = 1.7 / std::tan(to_rad(60.0));
  const Eigen::AlignedBox3d around(kWest - Eigen::Vector3d(1.4, 1.4, 1.71), kWest + Eigen::Vector3d(1.4, 1.4, -1.69));
  const double hole_m2 = std::numbers::pi * radius_m * radius_m;
  EXPECT_NEAR(area_in(site, around, true), hole_m2, 0.1 * hole_m2);
  const Eigen::AlignedBox3d inside(kWest - Eigen::Vector3d(0.6, 0.6, 1.71), kWest + Eigen::Vector3d(0.6, 0.6, -1.69));
  EXPECT_EQ(area_in(site, inside, false), 0.0);
  EXPECT_NEAR(area_in(site, inside, true), 1.44, 0.15);
}

TEST(ScansSite, GroundForContactIsWithinThreeMillimetersAwayFromWalls) {
  const ImportedSite site = site_of_rooms({ScannedRoom{}}, {kWest, kEast});
  const auto ground = std::find_if(site.shapes.begin(), site.shapes.end(),
                                   [](const SiteShape& shape) { return shape.type == SiteShapeType::kHeightField; });
  ASSERT_NE(ground, site.shapes.end());
  const Grid<float>& heights = ground->height_field.height_m;
  EXPECT_NEAR(heights.geometry().width * heights.geometry().resolution_m, 8.3, 0.3);
  std::size_t num_cells = 0;
  for (int row = 0; row < heights.geometry().height; ++row) {
    for (int col = 0; col < heights.geometry().width; ++col) {
      const Eigen::Vector2d p = heights.geometry().center_of({col, row});
      if (std::abs(p.x()) > 3.8 || std::abs(p.y()) > 2.8) continue;
      ++num_cells;
      EXPECT_NEAR(heights.at({col, row}), 0.0f, 0.003f);
    }
  }
  EXPECT_NEAR(static_cast<double>(num_cells), 76 * 56, 250.0);
}

TEST(ScansSite, ObjectInOneOfThreeScansIsRemoved) {
  ScannedRoom with;
  with.objects = {kCabinet};
  const ImportedSite site = site_of_rooms({with, ScannedRoom{}}, {kWest, kEast, kNorth});
  Eigen::AlignedBox3d space = kCabinet;
  // The lowest 3 cm are within the tolerance of the floor that the other scans see.
  space.min().z() = 0.03;
  space.min().head<2>().array() -= 0.02;
  space.max().array() += 0.02;
  EXPECT_LT(area_in(site, space, false) + area_in(site, space, true), 0.01);
  EXPECT_THAT(assumption(site, "moving objects"), testing::HasSubstr("points that another scan looks through"));
}

TEST(ScansSite, UnseenSideOfABoxPostIsFilledInAndSeenSidesAreMeasured) {
  ScannedRoom with;
  const Eigen::AlignedBox3d post(Eigen::Vector3d(-0.15, -0.1, 0.0), Eigen::Vector3d(0.15, 0.1, 2.2));
  with.objects = {post};
  // Both scanners see the sides at the low y and at the low or the high x; none sees the side at the high y.
  const ImportedSite site = site_of_rooms({with}, {{-2.0, -2.0, 1.7}, {2.0, -2.0, 1.7}});
  Eigen::AlignedBox3d back(Eigen::Vector3d(-0.13, 0.08, 0.3), Eigen::Vector3d(0.13, 0.12, 1.9));
  EXPECT_NEAR(area_in(site, back, true), 0.3 * 1.6, 0.2);
  EXPECT_EQ(area_in(site, back, false), 0.0);
  Eigen::AlignedBox3d front(Eigen::Vector3d(-0.13, -0.12, 0.3), Eigen::Vector3d(0.13, -0.08, 1.9));
  EXPECT_NEAR(area_in(site, front, false), 0.3 * 1.6, 0.25);
  EXPECT_EQ(area_in(site, front, true), 0.0);
}

TEST(ScansSite, ObjectInAllScansStaysWithContact) {
  ScannedRoom with;
  with.objects = {kCabinet};
  const ImportedSite site = site_of_rooms({with}, {kWest, kEast, kNorth});
  Eigen::AlignedBox3d space = kCabinet;
  space.min().z() = 0.05;
  space.min().head<2>().array() -= 0.02;
  space.max().array() += 0.02;
  // Sides of 4 x 0.8 x 1.4 m and the top of 0.64 m2, partly by several scans.
  EXPECT_GT(area_in(site, space, false), 3.5);
  EXPECT_LT(area_in(site, space, false), 9.0);
  std::size_t num_boxes = 0, num_astray = 0;
  for (const SiteShape& shape : site.shapes) {
    if (shape.type != SiteShapeType::kBox) continue;
    const Eigen::AlignedBox3d box(shape.T_site_shape.position - shape.size_m,
                                  shape.T_site_shape.position + shape.size_m);
    if (box.intersects(kCabinet)) ++num_boxes;
    // The top is seen 0.3 m below the scanner: half a pixel beyond its edge is 0.12 m.
    if (box.exteriorDistance(kCabinet) > 0.12 && distance_to_walls_m(with, shape.T_site_shape.position) > 0.1)
      ++num_astray;
  }
  EXPECT_GE(num_boxes, 4U);
  EXPECT_EQ(num_astray, 0U);
}

TEST(ScansSite, PostOfFiveCentimetersStays) {
  ScannedRoom with;
  with.objects = {Eigen::AlignedBox3d(Eigen::Vector3d(0.5, -1.025, 0.0), Eigen::Vector3d(0.55, -0.975, 3.0))};
  const ImportedSite site = site_of_rooms({with}, {kWest, kEast, kNorth});
  const Eigen::AlignedBox3d space(Eigen::Vector3d(0.45, -1.08, 0.3), Eigen::Vector3d(0.6, -0.92, 2.7));
  // Four sides of 0.05 x 2.4 m are 0.48 m2.
  const double area_m2 = area_in(site, space, false) + area_in(site, space, true);
  EXPECT_GT(area_in(site, space, false), 0.2);
  EXPECT_LT(area_m2, 1.5);
}

TEST(ScansSite, IsTheSameTwice) {
  const ImportedSite a = site_of_rooms({ScannedRoom{}}, {kWest}), b = site_of_rooms({ScannedRoom{}}, {kWest});
  EXPECT_EQ(to_mjcf(a), to_mjcf(b));
  for (std::size_t i = 0; i < a.shapes.size(); ++i) {
    if (a.shapes[i].mesh.empty()) continue;
    EXPECT_EQ(shape_content(a.shapes[i]), shape_content(b.shapes[i]));
  }
}

TEST(ScansSite, IsReadFromAFolderAndCompiles) {
  const test::TemporaryFolder folder;
  ScannedRoom with;
  with.objects = {kCabinet};
  io::save_station_scans(folder / "scans", {with.scan("a", kWest, 1.2), with.scan("b", kEast, 1.2)});
  const ImportedSite site = import_site({.file = folder / "scans", .name = "room"});
  write_site(site, folder / "room");
  EXPECT_TRUE(std::filesystem::exists(folder / "room" / "room.xml"));
  EXPECT_THAT(report_of(site, site.assumptions), testing::HasSubstr("filled in"));
}

/// Returns an E57 file of scans, each in the frame of its scanner; or, `is_joined`, of one scan with all points in
/// site.
std::string e57_of(const std::vector<io::StationScan>& scans, bool is_joined = false) {
  test::E57Writer writer;
  test::E57TestScan element;
  element.fields = test::e57_floats({"cartesianX", "cartesianY", "cartesianZ", "intensity"});
  element.packet_records = 4000;
  element.pose = test::e57_pose(0.0, 0.0, 0.0, 0.0);
  for (const io::StationScan& scan : scans) {
    const Eigen::Vector3d& origin = scan.T_map_scanner.position;
    if (!is_joined) element.pose = test::e57_pose(origin.x(), origin.y(), origin.z(), 0.0);
    for (const ScannerPoint& point : scan.points) {
      const Eigen::Vector3d p =
          Eigen::Vector3f(point.x, point.y, point.z).cast<double>() - (is_joined ? 0.0 : 1.0) * origin;
      element.records.push_back({p.x(), p.y(), p.z(), point.intensity});
    }
    if (!is_joined) {
      writer.add(element);
      element.records.clear();
    }
  }
  if (is_joined) writer.add(element);
  return writer.file();
}

TEST(ScansSite, E57HasTheSurfacesOfTheFolderWithTheSameScans) {
  const test::TemporaryFolder folder;
  ScannedRoom with;
  with.objects = {kCabinet};
  // The person stands in one scan.
  ScannedRoom busy = with;
  busy.objects.push_back({Eigen::Vector3d(1.0, -1.5, 0.0), Eigen::Vector3d(1.4, -1.2, 1.8)});
  const std::vector<io::StationScan> scans = {with.scan("a", kWest), busy.scan("b", kEast), with.scan("c", kNorth)};
  io::save_station_scans(folder / "scans", scans);
  test::write_bytes(folder / "scans.e57", e57_of(scans));
  const ImportedSite of_folder = import_site({.file = folder / "scans", .name = "room"});
  const ImportedSite of_e57 = import_site({.file = folder / "scans.e57", .name = "room"});
  EXPECT_EQ(assumption(of_e57, "points"), "450000 of 3 scans; the first has a step of 0.600 degrees");
  const Eigen::AlignedBox3d all(Eigen::Vector3d(-9.0, -9.0, -9.0), Eigen::Vector3d(9.0, 9.0, 9.0));
  EXPECT_NEAR(area_in(of_e57, all, false), area_in(of_folder, all, false), 0.5);
  const Eigen::AlignedBox3d person(Eigen::Vector3d(0.98, -1.52, 0.05), Eigen::Vector3d(1.42, -1.18, 1.82));
  EXPECT_LT(area_in(of_e57, person, false), 0.01);
}

TEST(ScansSite, PointsOfAnE57FileThatWereNotSeenFromItsPoseAreACloud) {
  const test::TemporaryFolder folder;
  ScannedRoom with;
  with.objects = {kCabinet};
  test::write_bytes(folder / "room.e57", e57_of({with.scan("a", kWest, 1.2), with.scan("b", kEast, 1.2)}, true));
  const ImportedSite site = import_site({.file = folder / "room.e57", .name = "room"});
  EXPECT_THAT(
      assumption(site, "scanner positions"),
      testing::MatchesRegex("not used: [0-9]+ % of the points of scan_1 are behind others, as seen from its pose"));
  EXPECT_THAT(assumption(site, "moving objects"), testing::HasSubstr("remain"));
}

TEST(ScansSite, FolderWithAWrongScannerPositionIsRefused) {
  ScannedRoom with;
  with.objects = {kCabinet};
  io::RelativeScans scans;
  scans.scans = {with.scan("gate", kWest)};
  scans.scans[0].T_map_scanner.position = {12.0, 5.0, 1.0};
  try {
    site_of_scans(std::move(scans), "scans", {.file = "scans", .name = "room"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::MatchesRegex(
                                  "scans: [0-9]+ % of the points of gate are behind others, as seen from its pose"));
  }
}

TEST(ScansSite, FolderWithoutScansIsRefused) {
  const test::TemporaryFolder folder;
  io::save_station_scans(folder / "scans", {});
  EXPECT_THROW(import_site({.file = folder / "scans", .name = "room"}), InputError);
  EXPECT_THROW(import_site({.file = folder / "missing", .name = "room"}), InputError);
}

TEST(ScansSite, ScanOfFewPointsIsRefusedByName) {
  io::RelativeScans scans;
  scans.scans = {{.station = "gate", .T_map_scanner = {}, .points = {{1.0f, 0.0f, 0.0f, 1.0f}}}};
  try {
    site_of_scans(scans, "scans", {.file = "scans", .name = "room"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "gate: has fewer than 16 points away from the scanner");
  }
}

TEST(Panorama, FindsTheStepOfTheScannerInAnyOrder) {
  io::StationScan scan = ScannedRoom{}.scan("a", kWest);
  EXPECT_EQ(Panorama(scan).columns(), 600);
  const RandomStream draw(3, "order");
  for (std::size_t i = scan.points.size() - 1; i > 0; --i)
    std::swap(scan.points[i], scan.points[static_cast<std::size_t>(draw.uniform(i) * static_cast<double>(i + 1))]);
  EXPECT_EQ(Panorama(scan).columns(), 600);
}

TEST(Panorama, PointsAreHiddenIfTheScannerWasElsewhere) {
  ScannedRoom with;
  with.objects = {kCabinet};
  io::StationScan scan = with.scan("a", kWest);
  EXPECT_LT(Panorama(scan).hidden_part(), 0.001);
  scan.T_map_scanner.position.x() += 10.0;
  EXPECT_GT(Panorama(scan).hidden_part(), 0.06);
}

TEST(Panorama, SurfaceContinuesOnASlopeAndEndsAtAJump) {
  const double step = 0.01;
  EXPECT_TRUE(is_continuous(0.0f, 5.0f, 5.03f, 0.0f, step));
  EXPECT_FALSE(is_continuous(5.0f, 5.0f, 5.5f, 5.5f, step));
  // Ground from a height of 1.7 m at 12 m: neighbors 0.8 m apart are on one plane.
  const auto range = [&](double k) { return static_cast<float>(1.7 / std::sin(0.14 - step * k)); };
  EXPECT_TRUE(is_continuous(range(-1), range(0), range(1), range(2), step));
  EXPECT_FALSE(is_continuous(0.0f, range(0), range(1), 0.0f, step));
}

TEST(Panorama, WallAtAFlatAngleContinuesDespiteTheErrorsOfTheAngles) {
  // Wall 4 m beside the scanner at an incidence of 77 degrees, angles with errors of 19 arc seconds.
  const double step = to_rad(0.1), error_rad = to_rad(19.0 / 3600.0);
  const RandomStream draw(5, "angles");
  int num_continuous = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const auto errors = draw.normals(i);
    const auto range = [&](std::size_t k) {
      return static_cast<float>(4.0 / std::sin(to_rad(13.0) + step * static_cast<double>(k) + error_rad * errors[k]));
    };
    num_continuous += is_continuous(range(0), range(1), range(2), range(3), step) ? 1 : 0;
  }
  EXPECT_GT(num_continuous, 1980);
}

}  // namespace
}  // namespace patrol::importer
