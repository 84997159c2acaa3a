#include "io/points/e57.h"

#include <numbers>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/io/cloud_samples.h"
#include "tests/io/e57_writer.h"

namespace patrol::io::e57_test {
namespace {

using test::E57TestScan, test::E57Writer, test::TemporaryFolder, test::write_bytes;

const std::vector<std::string> kXyz = {"cartesianX", "cartesianY", "cartesianZ"};

E57Scans load(const std::string& content) {
  const TemporaryFolder folder;
  write_bytes(folder / "c.e57", content);
  return load_e57(folder / "c.e57");
}

std::string complaint_about(const std::string& content) {
  return complaint("c.e57", content, [](const std::filesystem::path& file) { load_e57(file); });
}

/// Three points of one scan.
E57TestScan three_points() {
  return {.fields = test::e57_floats(kXyz), .records = {{1.0, 2.0, 3.0}, {-4.0, 5.0, 0.5}, {0.0, -1.0, 2.0}}};
}

std::string file_of(const E57TestScan& scan) {
  E57Writer writer;
  writer.add(scan);
  return writer.file();
}

TEST(E57, PointsOfScansAreInTheFrameOfTheFile) {
  E57Writer writer;
  E57TestScan scan = three_points();
  scan.pose = test::e57_pose(10.0, 20.0, 1.0, std::numbers::pi / 2.0);
  scan.fields = test::e57_floats({"cartesianX", "cartesianY", "cartesianZ", "intensity"});
  for (std::vector<double>& record : scan.records) record.push_back(0.25);
  writer.add(scan);
  writer.add(three_points());
  const E57Scans file = load(writer.file());
  ASSERT_EQ(file.scans.scans.size(), 2U);
  const StationScan& first = file.scans.scans[0];
  EXPECT_EQ(first.station, "scan_1");
  EXPECT_TRUE(first.T_map_scanner.position.isApprox(Eigen::Vector3d(10.0, 20.0, 1.0)));
  ASSERT_EQ(first.points.size(), 3U);
  EXPECT_NEAR(first.points[0].x, 10.0F - 2.0F, 1e-6F);
  EXPECT_NEAR(first.points[0].y, 20.0F + 1.0F, 1e-6F);
  EXPECT_NEAR(first.points[0].z, 4.0F, 1e-6F);
  EXPECT_EQ(first.points[2].intensity, 0.25F);
  EXPECT_EQ(file.scans.scans[1].points[1].x, -4.0F);
  EXPECT_EQ(file.scans.scans[1].points[1].intensity, 0.0F);
  EXPECT_FALSE(file.has_scanners) << "the second scan has no pose";
}

TEST(E57, IntegersOfAnyWidthContinueOverPackets) {
  for (const int bits : {1, 7, 13, 32, 33, 51, 61}) {
    SCOPED_TRACE(bits);
    const double above = std::min(std::pow(2.0, bits) - 1.0, 9e15);  // largest value above the minimum
    const double scale = std::pow(2.0, 10 - bits);                   // numbers of at most a kilometer
    const std::string attributes = fmt::format("type=\"ScaledInteger\" scale=\"{}\" minimum=\"-5\" maximum=\"{}\"",
                                               scale, (std::int64_t{1} << bits) - 6);
    E57TestScan scan;
    scan.fields = {
        {.name = "cartesianX", .attributes = attributes + " offset=\"3\"", .bits = bits},
        {.name = "cartesianY", .attributes = attributes, .bits = bits},
        {.name = "cartesianZ", .attributes = "type=\"Integer\" minimum=\"7\" maximum=\"7\"", .is_constant = true},
        {.name = "intensity", .attributes = "type=\"Float\" precision=\"double\"", .is_double = true}};
    scan.packet_records = 3;
    for (int i = 0; i < 20; ++i) {
      const double value = std::floor(above * i / 19.0);
      scan.records.push_back({value, above - value, 0.0, i / 19.0});
    }
    const std::vector<ScannerPoint> points = load(file_of(scan)).scans.scans.at(0).points;
    ASSERT_EQ(points.size(), 20U);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::vector<double>& record = scan.records[i];
      EXPECT_EQ(points[i].x, static_cast<float>(scale * (record[0] - 5.0) + 3.0));
      EXPECT_EQ(points[i].y, static_cast<float>(scale * (record[1] - 5.0)));
      EXPECT_EQ(points[i].z, 7.0F);
      EXPECT_EQ(points[i].intensity, static_cast<float>(record[3]));
    }
  }
}

TEST(E57, SphericalCoordinatesAreRangeAzimuthAndElevation) {
  E57TestScan scan;
  scan.fields = test::e57_floats({"sphericalRange", "sphericalAzimuth", "sphericalElevation"});
  scan.records = {{2.0, to_rad(90.0), 0.0}, {2.0, 0.0, to_rad(30.0)}};
  const E57Scans file = load(file_of(scan));
  EXPECT_TRUE(file.has_scanners) << "angles are seen from the scanner";
  const std::vector<ScannerPoint>& points = file.scans.scans.at(0).points;
  EXPECT_NEAR(points[0].x, 0.0F, 1e-6F);
  EXPECT_NEAR(points[0].y, 2.0F, 1e-6F);
  EXPECT_NEAR(points[1].x, std::sqrt(3.0F), 1e-6F);
  EXPECT_NEAR(points[1].z, 1.0F, 1e-6F);
}

TEST(E57, InvalidAndInfinitePointsAreLeftOutAndCounted) {
  E57TestScan scan = three_points();
  scan.fields.push_back(
      {.name = "cartesianInvalidState", .attributes = "type=\"Integer\" minimum=\"0\" maximum=\"2\"", .bits = 2});
  for (std::size_t i = 0; i < 3; ++i) scan.records[i].push_back(static_cast<double>(i));
  scan.records.push_back({std::nan(""), 0.0, 0.0, 0.0});
  const E57Scans file = load(file_of(scan));
  EXPECT_EQ(file.scans.scans.at(0).points.size(), 1U);
  EXPECT_EQ(file.scans.num_dropped, 3U);
}

TEST(E57, CoordinatesOfMillionsOfMetersKeepMillimetersByTheirPose) {
  E57TestScan scan = three_points();
  scan.pose = test::e57_pose(500'000.0, 5'400'000.001, 100.0, 0.0);
  const E57Scans near = load(file_of(scan));
  EXPECT_EQ(near.scans.origin, Eigen::Vector3d(500'000.0, 5'400'000.0, 100.0));
  EXPECT_NEAR(near.scans.scans[0].points[0].y, 2.001F, 1e-6F);
  EXPECT_NEAR(near.scans.scans[0].T_map_scanner.position.y(), 0.001, 1e-6);
  EXPECT_LT(near.step, 1e-6);
  scan.pose.clear();
  scan.records[0][1] = 4'194'304.0;
  EXPECT_NEAR(load(file_of(scan)).step, 0.5, 1e-3);
}

TEST(E57, JoinedPointsAreThoseOfAllScans) {
  E57Writer writer;
  writer.add(three_points());
  writer.add(three_points());
  const RelativePoints joined = joined_points(load(writer.file()));
  ASSERT_EQ(joined.points.size(), 6U);
  EXPECT_EQ(joined.points[4].x, -4.0F);
}

TEST(E57, DamagedFilesAreRefused) {
  E57TestScan scan = three_points();
  scan.records.resize(100, scan.records[0]);
  const std::string file = file_of(scan);
  const auto with = [&](std::size_t begin, const std::string& value) {
    return complaint_about(std::string(file).replace(begin, value.size(), value));
  };
  EXPECT_EQ(complaint_about("ASTM-E57"), "c.e57: is not an E57 file");
  EXPECT_EQ(with(0, "ASTM-E58"), "c.e57: is not an E57 file");
  EXPECT_EQ(with(8, "\x02"), "c.e57: E57 version 2.0 is not supported (known: 1.0)");
  EXPECT_EQ(with(40, bytes(std::uint64_t{1000})), "c.e57: pages of 1000 bytes are not supported");
  EXPECT_EQ(complaint_about(file.substr(0, 1024)), "c.e57: has 1024 bytes, its header gives 2048 in pages of 1024");
  EXPECT_EQ(with(1100, "\x01"), "c.e57: is damaged: the checksum of the page at byte 1024 is wrong");
}

TEST(E57, InvalidContentIsRefusedWithItsElement) {
  E57Writer writer;
  writer.add(three_points());
  const std::string content = writer.content();
  const auto with = [&](const std::string& text, std::string value) {
    const std::size_t begin = content.find(text);
    value.resize(text.size(), ' ');
    return complaint_about(test::with_checksums(std::string(content).replace(begin, text.size(), value)));
  };
  EXPECT_EQ(with("recordCount=\"3\"", "recordCount=\"4\""), "c.e57: /data3D/0/points: ends too early for 4 points");
  std::string of_other_packet = content;
  of_other_packet[48 + 32 + 4] = 3;  // behind header, section header and empty packet
  EXPECT_EQ(complaint_about(test::with_checksums(of_other_packet)),
            "c.e57: /data3D/0/points: has an invalid data packet");
  EXPECT_EQ(with("recordCount=\"3\"", "recordCount=\"x\""),
            "c.e57: /data3D/0/points: recordCount must be a number of 0 or more");
  EXPECT_EQ(with("fileOffset=\"48\"", "fileOffset=\"99\""),
            "c.e57: /data3D/0/points: no binary section begins at byte 99");
  EXPECT_EQ(with("type=\"CompressedVector\" fileOffset=\"48\"", "type=\"Vector\" fileOffset=\"1021\""),
            "c.e57: /data3D/0/points: offset 1021 is not in a page of the file");
  EXPECT_EQ(with("<cartesianZ", "<cartesianQ"),
            "c.e57: /data3D/0/points: has neither cartesian nor spherical coordinates");
  EXPECT_EQ(with("type=\"Float\" precision=\"single\"", "type=\"Flood\""),
            "c.e57: /data3D/0/points/prototype/cartesianX: type 'Flood' is not supported");
  EXPECT_EQ(with("type=\"Float\" precision=\"single\"", "type=\"Integer\" maximum=\"x\""),
            "c.e57: /data3D/0/points/prototype/cartesianX: maximum must be an integer");
  EXPECT_TRUE(with("<e57Root", "<f57Root").starts_with("c.e57: XML section, line "));
}

TEST(E57, UnknownCodecsAndPosesThatAreNoRotationAreRefused) {
  E57TestScan scan = three_points();
  scan.codecs = "<vectorChild type=\"Structure\"><inputs/><bitPackCodec/></vectorChild>";
  EXPECT_EQ(load(file_of(scan)).scans.scans.size(), 1U);
  scan.codecs = "<vectorChild type=\"Structure\"><inputs/><zipCodec/></vectorChild>";
  EXPECT_EQ(complaint_about(file_of(scan)),
            "c.e57: /data3D/0/points/codecs: zipCodec is not supported (known: bitPackCodec)");
  scan = three_points();
  scan.pose = "<pose><rotation><w>2</w></rotation></pose>";
  EXPECT_EQ(complaint_about(file_of(scan)), "c.e57: /data3D/0/pose/rotation: is not a unit quaternion");
  scan.pose = "<pose><translation><y>north</y></translation></pose>";
  EXPECT_EQ(complaint_about(file_of(scan)), "c.e57: /data3D/0/pose/translation/y: must be a finite number");
}

}  // namespace
}  // namespace patrol::io::e57_test
