#include "io/maps/map_server.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::map_server_test {
namespace {

using test::read_bytes, test::TemporaryFolder, test::write_bytes;
using ::testing::AllOf, ::testing::ElementsAre, ::testing::EndsWith, ::testing::HasSubstr;

constexpr std::int8_t F = kFree, X = kOccupied, U = kUnknown;

OccupancyGrid make_map() {
  OccupancyGrid map({.resolution_m = 0.05, .width = 3, .height = 2, .origin_m = {-1.25, 10.0}});
  map.values() = {F, X, U,   // low y
                  X, X, F};  // high y
  return map;
}

class MapServer : public ::testing::Test {
 protected:
  /// A map in YAML and PGM as other programs may write them.
  OccupancyGrid load(const std::string& yaml, const std::string& pgm) {
    write_bytes(folder / "m.yaml", yaml);
    write_bytes(folder / "m.pgm", pgm);
    return load_map(folder / "m.yaml");
  }
  std::string complaint_about(const std::string& yaml, const std::string& pgm) {
    try {
      load(yaml, pgm);
    } catch (const InputError& error) {
      const std::string what = error.what();
      return what.substr(std::min(what.size(), folder.path().string().size() + 1));
    }
    return "";
  }

  TemporaryFolder folder;
  const std::string good_yaml =
      "image: m.pgm\nresolution: 0.1\norigin: [1.0, 2.0, 0.0]\nnegate: 0\noccupied_thresh: "
      "0.65\nfree_thresh: 0.196\n";
};

TEST_F(MapServer, ThereAndBackKeepsCellsAndFrame) {
  save_map(folder / "map.yaml", make_map());
  const OccupancyGrid map = load_map(folder / "map.yaml");
  EXPECT_EQ(map.values(), make_map().values());
  EXPECT_EQ(map.geometry().resolution_m, 0.05);
  EXPECT_EQ(map.geometry().origin_m, Eigen::Vector2d(-1.25, 10.0));
}

TEST_F(MapServer, TheImageBeginsWithTheHighestRow) {
  save_map(folder / "map.yaml", make_map());
  EXPECT_EQ(read_bytes(folder / "map.pgm"), std::string("P5\n3 2\n255\n") + std::string("\x00\x00\xfe\xfe\x00\xcd", 6))
      << "occupied 0, free 254, unknown 205";
}

TEST_F(MapServer, TheYamlIsMapServers) {
  save_map(folder / "map.yaml", make_map());
  EXPECT_EQ(read_bytes(folder / "map.yaml"),
            "image: map.pgm\nmode: trinary\nresolution: 0.05\norigin: [-1.25, 10, 0.0]\nnegate: "
            "0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST_F(MapServer, PercentagesBecomeTrinaryAtSixtyFiveAndNineteen) {
  OccupancyGrid map({.resolution_m = 0.05, .width = 5, .height = 1});
  map.values() = {64, 65, 19, 20, 99};
  save_map(folder / "map.yaml", map);
  EXPECT_THAT(load_map(folder / "map.yaml").values(), ElementsAre(U, X, F, U, X));
}

TEST_F(MapServer, ReadsPicturesInFiguresWithComments) {
  const OccupancyGrid map = load(good_yaml, "P2 # by hand\n# two rows\n2 2\n255\n0 254\n# middle\n205 0\n");
  EXPECT_THAT(map.values(), ElementsAre(U, X, X, F));
  EXPECT_EQ(map.geometry().resolution_m, 0.1);
}

TEST_F(MapServer, ReadsBinaryPicturesWithComments) {
  EXPECT_THAT(load(good_yaml, std::string("P5\n# CREATOR: GIMP\n2 1\n# x\n255\n") + '\n' + '\xfe').values(),
              ElementsAre(X, F))
      << "a pixel may look like a line's end";
}

TEST_F(MapServer, NegatedPicturesSwapBlackAndWhite) {
  std::string negated = good_yaml;
  negated.replace(negated.find("negate: 0"), 9, "negate: 1");
  EXPECT_THAT(load(negated, "P2\n2 1\n255\n0 254\n").values(), ElementsAre(F, X));
}

TEST_F(MapServer, ThresholdsAreTheFiles) {
  // Grey 100: occupied with probability 155/255 = 0.61.
  EXPECT_THAT(load(good_yaml, "P2\n1 1\n255\n100\n").values(), ElementsAre(U));
  std::string lower = good_yaml;
  lower.replace(lower.find("0.65"), 4, "0.60");
  EXPECT_THAT(load(lower, "P2\n1 1\n255\n100\n").values(), ElementsAre(X));
}

TEST_F(MapServer, ScaleSpreadsTheValuesBetweenTheThresholdsOver0To100) {
  // Gray 128 is occupied with probability 127/255 = 0.498: (0.498 - 0.196) / (0.65 - 0.196) = 66.5 %.
  EXPECT_THAT(load(good_yaml + "mode: scale\n", "P2\n4 1\n255\n0 128 205 254\n").values(), ElementsAre(X, 67, F, F));
}

TEST_F(MapServer, TheModeInAnyCaseAndAYawOfAFullTurnAreRead) {
  std::string yaml = good_yaml + "mode: Scale\n";
  yaml.replace(yaml.find("2.0, 0.0"), 8, "2.0, 6.283185307179586");
  EXPECT_THAT(load(yaml, "P2\n4 1\n255\n0 128 205 254\n").values(), ElementsAre(X, 67, F, F));
  EXPECT_EQ(complaint_about(good_yaml + "mode: Trinity\n", "P2\n1 1\n255\n0\n"),
            "m.yaml:7: mode: trinity is out of range: must be one of trinary, scale, raw");
}

TEST_F(MapServer, RawTakes0To100AsPercentAndTheRestAsUnknown) {
  EXPECT_THAT(load(good_yaml + "mode: raw\n", "P2\n5 1\n255\n0 42 100 101 255\n").values(),
              ElementsAre(F, 42, X, U, U));
}

TEST_F(MapServer, BrokenPicturesAreNamed) {
  EXPECT_EQ(complaint_about(good_yaml, std::string("P5\n3 2\n255\n") + "abcde"),
            "m.pgm: ends too early for 3 x 2 pixels");
  EXPECT_EQ(complaint_about(good_yaml, "P2\n3 2\n255\n0 0 0 0 0\n"), "m.pgm: ends too early for 3 x 2 pixels");
  EXPECT_EQ(complaint_about(good_yaml, std::string("P5\n3 2\n255\n") + "abcdefg"),
            "m.pgm: has data after its 3 x 2 pixels");
  EXPECT_EQ(complaint_about(good_yaml, "P2\n1 1\n255\n0 0\n"), "m.pgm: has data after its 1 x 1 pixels");
  EXPECT_EQ(complaint_about(good_yaml, "P5\n100000 100000\n255\n"), "m.pgm: ends too early for 100000 x 100000 pixels");
  EXPECT_EQ(complaint_about(good_yaml, "P2\n1 1\n255\n300\n"), "m.pgm: a pixel of 300 is brighter than 255");
  EXPECT_EQ(complaint_about(good_yaml, "P5\n0 2\n255\n"), "m.pgm: is 0 x 2 pixels: contains no map");
  EXPECT_EQ(complaint_about(good_yaml, "P5\n2 2\n65535\n"), "m.pgm: ends too early for 2 x 2 pixels");
  EXPECT_EQ(complaint_about(good_yaml, "P6\n1 1\n255\nabc"), "m.pgm: is neither a PGM (P5 or P2) nor a PNG");
  EXPECT_EQ(complaint_about(good_yaml, ""), "m.pgm: is neither a PGM (P5 or P2) nor a PNG");
}

TEST_F(MapServer, WrongKeysAreNamedWithTheirLine) {
  const auto complaint = [&](const std::string& lines) { return complaint_about(lines, "P2\n1 1\n255\n0\n"); };
  const std::string image = "image: m.pgm\n", good = image + "resolution: 1\norigin: [0, 0, 0]\n";
  EXPECT_EQ(complaint(good), "");
  EXPECT_EQ(complaint("resolution: 1\norigin: [0, 0, 0]\n"), "m.yaml: image: is missing");
  EXPECT_EQ(complaint(image + "origin: [0, 0, 0]\n"), "m.yaml: resolution: is missing");
  EXPECT_EQ(complaint(image + "resolution: 1\n"), "m.yaml: origin: is missing");
  EXPECT_EQ(complaint("{}\n"), "m.yaml: image: is missing");
  EXPECT_EQ(complaint(""), "m.yaml: is empty: must be a map of keys and values ({} for none)");
  EXPECT_EQ(complaint(image + "resolution: .nan\norigin: [0, 0, 0]\n"),
            "m.yaml:2: resolution: must be a finite number, not .nan");
  EXPECT_EQ(complaint(image + "resolution: -1\norigin: [0, 0, 0]\n"),
            "m.yaml:2: resolution: -1 is out of range: must be in [0.001, 10]");
  EXPECT_EQ(complaint(image + "resolution: 1\norigin: 0\n"), "m.yaml:3: origin: must be a list");
  EXPECT_EQ(complaint(image + "resolution: 1\norigin: [0]\n"), "m.yaml:3: origin: must be three numbers: x, y, yaw");
  EXPECT_EQ(complaint(image + "resolution: 1\norigin: [0, 0]\n"), "m.yaml:3: origin: must be three numbers: x, y, yaw");
  EXPECT_EQ(complaint(image + "resolution: 1\norigin: [0, north, 0]\n"),
            "m.yaml:3: origin.1: must be a number, not north");
  EXPECT_EQ(complaint(image + "resolution: 1\norigin: [0, 0, 0.5]\n"),
            "m.yaml:3: origin: rotated maps (yaw other than 0) are not supported");
  EXPECT_EQ(complaint(good + "negate: 2\n"), "m.yaml:4: negate: 2 is out of range: must be one of 0, 1, false, true");
  EXPECT_EQ(complaint(good + "mode: binary\n"),
            "m.yaml:4: mode: binary is out of range: must be one of trinary, scale, raw");
  EXPECT_EQ(complaint(good + "free_thresh: 0.9\n"), "m.yaml:4: free_thresh: must not be above occupied_thresh");
  EXPECT_EQ(complaint(good + "mode: scale\nfree_thresh: 0.65\n"),
            "m.yaml:5: free_thresh: must be below occupied_thresh in mode scale");
  EXPECT_EQ(complaint(good + "resolution: 2\n"), "m.yaml:4: resolution: duplicate key");
  EXPECT_THAT(complaint(good + "occupied_tresh: 0.5\n"),
              HasSubstr("m.yaml:4: occupied_tresh: unknown key; did you mean occupied_thresh?"));
}

TEST_F(MapServer, AMissingPictureIsNamedWithTheLineThatNamesIt) {
  EXPECT_THAT(complaint_about("resolution: 1\nimage: n.pgm\norigin: [0, 0, 0]\n", ""),
              AllOf(HasSubstr("m.yaml:2: image: file not found: "), EndsWith("n.pgm")));
}

TEST(MapErrors, ComeBackToAMillimetreUpTo254) {
  const test::TemporaryFolder folder;
  Grid<float> errors_m({.resolution_m = 0.05, .width = 3, .height = 2, .origin_m = {1.0, 2.0}},
                       std::numeric_limits<float>::quiet_NaN());
  errors_m.at({0, 0}) = 0.0F;
  errors_m.at({2, 0}) = 0.0237F;
  errors_m.at({1, 1}) = 7.0F;
  save_map_errors(folder / "map_errors.pgm", errors_m);
  const Grid<float> loaded_m = load_map_errors(folder / "map_errors.pgm", errors_m.geometry());
  EXPECT_EQ(loaded_m.at({0, 0}), 0.0F);
  EXPECT_NEAR(loaded_m.at({2, 0}), 0.024, 1e-6);
  EXPECT_NEAR(loaded_m.at({1, 1}), 0.254, 1e-6);
  EXPECT_TRUE(std::isnan(loaded_m.at({0, 1})));
}

TEST(MapErrors, OfAnotherMapsSizeAreRefused) {
  const test::TemporaryFolder folder;
  save_map_errors(folder / "map_errors.pgm",
                  Grid<float>({.resolution_m = 0.05, .width = 3, .height = 2, .origin_m = {0.0, 0.0}}));
  EXPECT_THROW(load_map_errors(folder / "map_errors.pgm",
                               {.resolution_m = 0.05, .width = 2, .height = 3, .origin_m = {0.0, 0.0}}),
               InputError);
}

}  // namespace
}  // namespace patrol::io::map_server_test
