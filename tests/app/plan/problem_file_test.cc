#include "app/plan/problem_file.h"

#include <gtest/gtest.h>

#include "app/plan/problem_output.h"
#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::problem_file_test {
namespace {

using test::write_bytes;

class ProblemFile : public ::testing::Test {
 protected:
  ProblemFile() { write_bytes(folder / "a.map", "type octile\nheight 3\nwidth 5\nmap\n.....\n.@@..\n...WW\n"); }

  std::vector<SolvedProblem> solve(const std::string& problems, const std::string& planner) {
    write_bytes(folder / "a.map.scen", "version 1\n" + problems);
    settings.planner = planner;
    return solve_problems(folder / "a.map.scen", settings).value();
  }
  /// Error message without the name of the folder.
  std::string complaint(const std::string& problems) {
    try {
      solve(problems, "astar");
    } catch (const InputError& error) {
      std::string what = error.what();
      for (std::size_t at; (at = what.find(folder.path().string() + "/")) != std::string::npos;)
        what.erase(at, folder.path().string().size() + 1);
      return what;
    }
    return "";
  }

  test::TemporaryFolder folder;
  PlanSettings settings;
};

// From below the wall's left end straight up, round it, and to the right: over eight neighbours 1 + 1 + 3 (its corners
// may not be cut).
const std::string kRoundTheWall = "1\ta.map\t5\t3\t0\t2\t3\t0\t5.00000000\n";

TEST_F(ProblemFile, APublishedLengthThatIsRightAgrees) {
  for (const char* planner : {"astar", "dijkstra"}) {
    const std::vector<SolvedProblem> solved = solve(kRoundTheWall, planner);
    EXPECT_TRUE(solved[0].agrees());
    EXPECT_FALSE(solved[0].failure);
    EXPECT_NEAR(solved[0].ratio().value(), 1.0, 1e-9);
  }
}

TEST_F(ProblemFile, APublishedLengthThatIsWrongIsNamedByItsLine) {
  const std::vector<SolvedProblem> solved = solve(kRoundTheWall + "1\ta.map\t5\t3\t0\t2\t3\t0\t4.99980000\n", "astar");
  EXPECT_FALSE(solved[0].failure);
  EXPECT_EQ(solved[1].failure, "is 5.000000 cells long, published 4.999800");
  const ProblemReport report{.file_name = "a.map.scen", .settings = settings, .solved = solved};
  EXPECT_EQ(num_failed(report), 1u);
  EXPECT_NE(to_text(report).find("\n  a.map.scen:3: is 5.000000 cells long"), std::string::npos);
}

// A strip of 129 columns: from the start three rows down aslant, then straight on: 125 + 3 sqrt 2 = 129.242641. Six
// digits: 129.243.
TEST_F(ProblemFile, ALengthAgreesWithinTheRoundingOfItsPublishedDigits) {
  const std::string row(129, '.');
  write_bytes(folder / "strip.map",
              "type octile\nheight 4\nwidth 129\nmap\n" + row + "\n" + row + "\n" + row + "\n" + row + "\n");
  const auto fails = [&](const std::string& length, const std::string& planner) {
    return solve("32\tstrip.map\t129\t4\t0\t0\t128\t3\t" + length + "\n", planner)[0].failure.has_value();
  };
  for (const std::string length : {"129.243", "129.24264", "129.24264069"})
    EXPECT_FALSE(fails(length, "astar")) << length;
  for (const std::string length : {"129.113", "129.372", "129.242", "129.244", "129.24300000", "129", "129.2"}) {
    EXPECT_TRUE(fails(length, "astar")) << length;
  }
  EXPECT_FALSE(fails("129.243", "visibility_graph"));
  EXPECT_TRUE(fails("127", "visibility_graph"));
}

TEST_F(ProblemFile, AnAnyAngleRouteMayBeShorterButNotLonger) {
  const std::vector<SolvedProblem> theta =
      solve("1\ta.map\t5\t3\t0\t0\t3\t1\t4.00000000\n1\ta.map\t5\t3\t0\t2\t3\t0\t2.00000000\n", "theta_star");
  EXPECT_FALSE(theta[0].failure);
  EXPECT_TRUE(theta[1].failure);
}

TEST_F(ProblemFile, ARouteThatIsNotFoundFails) {
  const std::vector<SolvedProblem> solved =
      solve("1\ta.map\t5\t3\t0\t0\t4\t2\t4.00000000\n", "astar");  // into the water
  EXPECT_EQ(solved[0].failure, "no route found, but the file states a length");
  EXPECT_FALSE(solved[0].ratio());
}

TEST_F(ProblemFile, WhoStartsInWaterStaysThere) {
  EXPECT_FALSE(solve("0\ta.map\t5\t3\t3\t2\t4\t2\t1.00000000\n", "astar")[0].failure);
}

TEST_F(ProblemFile, AProblemWithoutWayHasNoRatio) {
  EXPECT_FALSE(solve("0\ta.map\t5\t3\t3\t1\t3\t1\t0\n", "astar")[0].ratio());
}

TEST_F(ProblemFile, AMapIsFoundByItsPathOrBesideTheFileByItsLastPart) {
  std::filesystem::create_directories(folder / "maps");
  write_bytes(folder / "maps/b.map", "type octile\nheight 1\nwidth 2\nmap\n..\n");
  write_bytes(folder / "b.map", "type octile\nheight 1\nwidth 3\nmap\n...\n");
  EXPECT_EQ(solve("0\tmaps/b.map\t2\t1\t0\t0\t1\t0\t1\n0\tmaps/dao/a.map\t5\t3\t0\t0\t1\t0\t1\n", "astar").size(), 2u);
  EXPECT_EQ(complaint("0\tx/c.map\t2\t1\t0\t0\t1\t0\t1\n"), "a.map.scen:2: x/c.map: neither x/c.map nor c.map found");
}

TEST_F(ProblemFile, AMapOfAnotherSizeIsRefused) {
  EXPECT_EQ(complaint(kRoundTheWall + "1\ta.map\t6\t3\t0\t2\t3\t0\t5\n"),
            "a.map.scen:3: a.map: has 5 x 3 cells, the problem's map 6 x 3");
}

TEST_F(ProblemFile, TheTableHasARowForEachProblemWithCellsAsTheFileNamesThem) {
  const std::vector<SolvedProblem> solved = solve(kRoundTheWall, "astar");
  const io::Table table = problem_table({.file_name = "a.map.scen", .settings = settings, .solved = solved});
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(std::get<std::int64_t>(table.rows[0][0]), 2);  // line
  EXPECT_EQ(std::get<std::int64_t>(table.rows[0][3]), 2);  // start_y, from the top
  EXPECT_EQ(std::get<std::int64_t>(table.rows[0][5]), 0);  // goal_y
  EXPECT_EQ(table.rows[0].size(), table.columns.size());
}

}  // namespace
}  // namespace patrol::app::problem_file_test
