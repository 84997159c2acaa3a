#include "io/maps/moving_ai.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::moving_ai_test {
namespace {

using test::TemporaryFolder, test::write_bytes;
using ::testing::ElementsAre;

constexpr std::int8_t F = kFree, X = kOccupied;

class MovingAi : public ::testing::Test {
 protected:
  MovingAiMap load_map(const std::string& text) {
    write_bytes(folder / "a.map", text);
    return load_moving_ai_map(folder / "a.map");
  }
  std::vector<MovingAiProblem> load_problems(const std::string& text) {
    write_bytes(folder / "a.map.scen", text);
    return load_moving_ai_problems(folder / "a.map.scen");
  }
  /// Error message without the name of the folder.
  template <typename Load>
  std::string complaint(Load load) {
    try {
      load();
    } catch (const InputError& error) {
      const std::string what = error.what();
      return what.substr(std::min(what.size(), folder.path().string().size() + 1));
    }
    return "";
  }
  std::string map_complaint(const std::string& text) {
    return complaint([&] { load_map(text); });
  }
  std::string problem_complaint(const std::string& line) {
    return complaint([&] { load_problems("version 1\n" + line + "\n"); });
  }

  TemporaryFolder folder;
  const std::string good_map = "type octile\nheight 2\nwidth 3\nmap\n.GS\n@WT\n";
};

TEST_F(MovingAi, TheFilesLastRowIsTheLowest) {
  const MovingAiMap map = load_map(good_map);
  EXPECT_EQ(map.terrain.geometry().width, 3);
  EXPECT_EQ(map.terrain.geometry().height, 2);
  EXPECT_THAT(map.terrain.values(), ElementsAre('@', 'W', 'T', '.', 'G', 'S'));
}

TEST_F(MovingAi, OnLandGroundAndSwampAreFree) {
  EXPECT_THAT(to_occupancy(load_map(good_map), {0, 1}).values(), ElementsAre(X, X, X, F, F, F));
}

TEST_F(MovingAi, InWaterOnlyWaterIs) {
  EXPECT_THAT(to_occupancy(load_map(good_map), {1, 0}).values(), ElementsAre(X, F, X, X, X, X));
}

TEST_F(MovingAi, OutsideAndWhereNobodyStandsTheMapIsLands) {
  EXPECT_EQ(to_occupancy(load_map(good_map), {-1, 7}).values(), to_occupancy(load_map(good_map), {0, 1}).values());
  EXPECT_EQ(to_occupancy(load_map(good_map), {0, 0}).values(), to_occupancy(load_map(good_map), {0, 1}).values());
}

TEST_F(MovingAi, ReadsCarriageReturnsAWidthBeforeTheHeightAndNoLastLineEnd) {
  EXPECT_EQ(load_map("type octile\r\nwidth 3\r\nheight 2\r\nmap\r\n.GS\r\n@WT").terrain.values(),
            load_map(good_map).terrain.values());
}

TEST_F(MovingAi, MapsThatAreNoneAreRefusedInOneLineWithThePlace) {
  EXPECT_EQ(map_complaint("type tile\n"), "a.map:1: type: is tile, must be octile");
  EXPECT_EQ(map_complaint("typ octile\n"), "a.map:1: typ: must be one of type, height, width, map");
  EXPECT_EQ(map_complaint("height 2\nwidth 3\nmap\n"), "a.map:3: map: must come after the type");
  EXPECT_EQ(map_complaint("type octile\nwidth 3\nmap\n"), "a.map:3: map: must come after height and width");
  EXPECT_EQ(map_complaint("type octile\nheight 2 3\n"), "a.map:2: height: must be a single value");
  EXPECT_THAT(map_complaint("type octile\nheight -2\n"), ::testing::StartsWith("a.map:2: height"));
  EXPECT_EQ(map_complaint("type octile\nheight\n"), "a.map:2: ends before height");
  EXPECT_EQ(map_complaint("type octile\nheight 2\nwidth 3\nmap\n.GS\n@W\n"),
            "a.map:6: row 1: has 2 cells, must have 3");
  EXPECT_EQ(map_complaint("type octile\nheight 2\nwidth 3\nmap\n.G?\n@WT\n"),
            "a.map:5: row 0: invalid character 63, must be of . G S W @ O T");
  EXPECT_EQ(map_complaint("type octile\nheight 2\nwidth 3\nmap\n.GS\n"), "a.map: ends after 1 of 2 rows");
  EXPECT_EQ(map_complaint(good_map + "...\n"), "a.map:7: must hold no more than 2 rows");
  EXPECT_EQ(map_complaint(""), "a.map: contains no map");
  EXPECT_EQ(complaint([&] { load_moving_ai_map(folder / "b.map"); }).substr(0, 5), "b.map");
}

// A header of a million million cells is refused before a row is read; one that fits takes no memory until the rows
// come.
TEST_F(MovingAi, AHugeHeaderFillsNoMemory) {
  EXPECT_EQ(map_complaint("type octile\nheight 1000000\nwidth 1000000\nmap\n"),
            "a.map:4: map: 1000000 x 1000000 cells, at most 100000000 are allowed");
  EXPECT_EQ(map_complaint("type octile\nheight 100\nwidth 1000000\nmap\n.\n"),
            "a.map:5: row 0: has 1 cells, must have 1000000");
}

TEST_F(MovingAi, AProblemsRowsCountFromTheTopOfTheFile) {
  const std::vector<MovingAiProblem> problems =
      load_problems("version 1\n0\ta map.map\t30\t20\t1\t2\t29\t19\t31.04163056\n3 b.map 30 20 0 0 0 0 0\n");
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0].map, "a map.map");
  EXPECT_EQ(problems[0].start, (Cell{1, 17}));
  EXPECT_EQ(problems[0].goal, (Cell{29, 0}));
  EXPECT_DOUBLE_EQ(problems[0].optimal_length, 31.04163056);
  EXPECT_DOUBLE_EQ(problems[0].length_rounding, 0.5e-8);
  EXPECT_EQ(problems[1].bucket, 3);
  EXPECT_EQ(problems[1].line, 3);
  EXPECT_EQ(problems[1].start, (Cell{0, 19}));
}

TEST(MovingAiLength, IsRoundedToItsLastDigitOrToTheSixthWhereZerosMayBeDropped) {
  EXPECT_DOUBLE_EQ(rounding_of("128.586"), 0.5e-3);
  EXPECT_DOUBLE_EQ(rounding_of("1285.86"), 0.5e-2);
  EXPECT_DOUBLE_EQ(rounding_of("31.04163056"), 0.5e-8);
  EXPECT_DOUBLE_EQ(rounding_of("1024"), 0.5e-2) << "1024.00";
  EXPECT_DOUBLE_EQ(rounding_of("5"), 0.5e-5) << "5.00000";
  EXPECT_DOUBLE_EQ(rounding_of("0.0414"), 0.5e-7);
  EXPECT_DOUBLE_EQ(rounding_of("1.28586e+02"), 0.5e-3);
  EXPECT_DOUBLE_EQ(rounding_of("0.00000000"), 0.0);
}

TEST_F(MovingAi, ProblemsThatAreNoneAreRefusedInOneLineWithThePlace) {
  const std::string rule = ": a problem is bucket, map, width, height, start x, y, goal x, y, optimal length";
  EXPECT_EQ(problem_complaint("0 a.map 30 20 1 2 3 4"), "a.map.scen:2: has 8 fields" + rule);
  EXPECT_THAT(problem_complaint("0 a.map 30 20 30 2 3 4 5"),
              ::testing::AllOf(::testing::StartsWith("a.map.scen:2: start x"), ::testing::EndsWith(rule)));
  EXPECT_THAT(problem_complaint("0 a.map 30 20 1 2 3 20 5"), ::testing::StartsWith("a.map.scen:2: goal y"));
  EXPECT_THAT(problem_complaint("0 a.map 30 20 1 2 3 4 five"), ::testing::StartsWith("a.map.scen:2: optimal length"));
  EXPECT_THAT(problem_complaint("0 a.map 30 20 1 2 3 4 -5"),
              ::testing::StartsWith("a.map.scen:2: optimal length: must be at least 0"));
  EXPECT_THAT(problem_complaint("0 a.map 30 20 1 2 3 4 nan"), ::testing::StartsWith("a.map.scen:2: optimal length"));
  EXPECT_EQ(problem_complaint(""), "a.map.scen: contains no problems");
  EXPECT_EQ(complaint([&] { load_problems("version 2\n"); }), "a.map.scen:1: must be \"version 1\"");
  EXPECT_EQ(complaint([&] { load_problems(""); }), "a.map.scen: is empty");
}

}  // namespace
}  // namespace patrol::io::moving_ai_test
