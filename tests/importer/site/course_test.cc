#include "importer/site/course.h"

#include <algorithm>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/mujoco.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::course_test {
namespace {

int num_cylinders(const Course& course) {
  return std::accumulate(course.field.values().begin(), course.field.values().end(), 0);
}

TEST(Course, TheSameNumberGivesTheSameCourseAndAnotherNumberAnother) {
  const Course first = draw_course(7), again = draw_course(7), other = draw_course(8);
  EXPECT_EQ(first.field.values(), again.field.values());
  EXPECT_EQ(first.path_length_m, again.path_length_m);
  EXPECT_NE(first.field.values(), other.field.values());
}

TEST(Course, OfTheBenchmarkHasItsField5MetersBeforeTheGoalAndATimeOfItsPathAt2MetersPerSecond) {
  const Course course = draw_course(1);
  EXPECT_NEAR(course.field.geometry().resolution_m, 0.15, 1e-12);
  EXPECT_NEAR(course.goal_m.x(), 2.0 + 4.5 + 3.5, 1e-12);
  EXPECT_GE(course.path_length_m, 10.0 - 0.1);
  EXPECT_LE(course.path_length_m, 30.0);
  EXPECT_NEAR(course.optimal_time_s, course.path_length_m / 2.0, 1e-12);
}

TEST(Course, FiftyOfThemHaveAPathThreeFillsAndAtMost500CylindersInNineHundredCells) {
  std::vector<double> fills;
  for (std::uint64_t number = 1; number <= 50; ++number) {
    const Course course = draw_course(number);
    fills.push_back(course.fill);
    EXPECT_LT(course.path_length_m, 40.0);
    EXPECT_LE(num_cylinders(course), 500);
  }
  // A fill of 0.3 hardly ever leaves a path.
  for (const double fill : {0.15, 0.20, 0.25}) EXPECT_GE(std::count(fills.begin(), fills.end(), fill), 2) << fill;
}

// After its last step, a cell with five filled neighbors would be filled by another step only if that step came.
TEST(Course, ALoneCylinderDoesNotSurviveTheSmoothing) {
  for (std::uint64_t number = 1; number <= 20; ++number) {
    const Course course = draw_course(number);
    const GridGeometry& grid = course.field.geometry();
    int lone = 0;
    for (int row = 1; row + 1 < grid.height; ++row) {
      for (int col = 1; col + 1 < grid.width; ++col) {
        int around = 0;
        for (int r = row - 1; r <= row + 1; ++r) {
          for (int c = col - 1; c <= col + 1; ++c) around += course.field.at({c, r});
        }
        lone += course.field.at({col, row}) == 1 && around == 1 ? 1 : 0;
      }
    }
    // One step clears all lone cells and can only leave new ones by clearing their neighbors.
    EXPECT_LE(lone, num_cylinders(course) / 10) << number;
  }
}

TEST(Course, ItsScaleEnlargesEverythingButTheArrival) {
  const CourseSettings twice{.scale = 2.0};
  const Course course = draw_course(3), larger = draw_course(3, twice);
  EXPECT_EQ(course.field.values(), larger.field.values());
  EXPECT_NEAR(larger.goal_m.x(), 2.0 * course.goal_m.x(), 1e-12);
  EXPECT_NEAR(larger.path_length_m, 2.0 * course.path_length_m, 1e-9);
}

TEST(Course, ItsSiteHasACylinderForEachCellThreeWallsAndAScenarioWithItsTime) {
  const Course course = draw_course(5);
  const ImportedSite site = site_of_course(course, {}, "course_005", "wheeled");
  const test::TemporaryFolder folder;
  write_site(site, folder / "course_005");
  const sim::ModelPtr model = sim::compile(*sim::load_spec(folder / "course_005/course_005.xml"), "course");
  EXPECT_EQ(model->ngeom, num_cylinders(course) + 4);
  EXPECT_THAT(test::read_bytes(folder / "course_005/scenarios/patrol.yaml"),
              ::testing::HasSubstr("course: {optimal_time_s: "));
}

}  // namespace
}  // namespace patrol::importer::course_test
