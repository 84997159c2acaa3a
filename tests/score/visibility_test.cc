#include "score/visibility.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::score::visibility_test {
namespace {

using namespace std::chrono_literals;

/// A map drawn with its highest row first: '#' occupied, '.' free, ' ' unknown (inside of solid things).
/// Cells of 1 m.
OccupancyGrid draw(const std::vector<std::string>& rows) {
  OccupancyGrid map(
      {.resolution_m = 1.0, .width = static_cast<int>(rows.front().size()), .height = static_cast<int>(rows.size())});
  for (int row = 0; row < map.geometry().height; ++row) {
    for (int col = 0; col < map.geometry().width; ++col) {
      const char c = rows[rows.size() - 1 - static_cast<std::size_t>(row)][static_cast<std::size_t>(col)];
      map.at({col, row}) = c == '#' ? kOccupied : c == '.' ? kFree : kUnknown;
    }
  }
  return map;
}

/// What is seeable, drawn the same way; '?' for the rest.
std::vector<std::string> drawing_of(const ReferenceMap& reference) {
  const OccupancyGrid part = observable_part(reference);
  std::vector<std::string> rows;
  for (int row = part.geometry().height - 1; row >= 0; --row) {
    rows.emplace_back();
    for (int col = 0; col < part.geometry().width; ++col) {
      const std::int8_t value = part.at({col, row});
      rows.back() += value == kOccupied ? '#' : value == kFree ? '.' : '?';
    }
  }
  return rows;
}

Trajectory at(const std::vector<Eigen::Vector2d>& places) {
  Trajectory trajectory;
  for (const Eigen::Vector2d& p : places)
    trajectory.push_back({static_cast<int>(trajectory.size()) * 1s, to_pose3({p.x(), p.y(), 0.0})});
  return trajectory;
}

// A wall across the room hides its right half but for the sector through the gap at the bottom. A wall's cell
// beside one that is hit counts as seen.
const std::vector<std::string> kRoom = {"###########", "#....#....#", "#....#....#",
                                        "#....#....#", "#.........#", "###########"};

TEST(MarkSeeable, AnInnerWallHidesWhatIsBehindIt) {
  const ReferenceMap seen = mark_observable(draw(kRoom), at({{2.5, 3.5}}), 30.0);
  EXPECT_EQ(drawing_of(seen), (std::vector<std::string>{"#######????", "#....#?????", "#....#?????", "#....#?????",
                                                        "#......????", "########???"}));
}

TEST(MarkSeeable, TwoPlacesSeeWhatEitherSees) {
  const ReferenceMap seen = mark_observable(draw(kRoom), at({{2.5, 3.5}, {8.5, 3.5}}), 30.0);
  for (const std::string& row : drawing_of(seen)) EXPECT_EQ(row.find('?'), std::string::npos) << row;
}

TEST(MarkSeeable, NothingBeyondTheRangeIsSeen) {
  const std::vector<std::string> corridor = {"####################", "#..................#", "####################"};
  const ReferenceMap seen = mark_observable(draw(corridor), at({{1.5, 1.5}}), 5.0);
  EXPECT_EQ(seen.is_observable.at({6, 1}), 1);  // entered after 4.5 m
  EXPECT_EQ(seen.is_observable.at({7, 1}), 0);
  EXPECT_EQ(seen.is_observable.at({19, 1}), 0);
}

TEST(MarkSeeable, TheInsideOfSolidThingsIsNotSeen) {
  const std::vector<std::string> block = {".......", ".#####.", ".#   #.", ".#####.", "......."};
  const ReferenceMap seen = mark_observable(draw(block), at({{0.5, 2.5}}), 30.0);
  EXPECT_EQ(seen.is_observable.at({3, 2}), 0);
  EXPECT_EQ(seen.is_observable.at({1, 2}), 1);
  EXPECT_EQ(seen.is_observable.at({5, 2}), 0) << "the far side";
}

TEST(MarkSeeable, FromInsideASolidThingNothingIsSeen) {
  const std::vector<std::string> block = {".......", ".#####.", ".#   #.", ".#####.", "......."};
  const ReferenceMap seen = mark_observable(draw(block), at({{3.5, 2.5}}), 30.0);
  for (const std::uint8_t is_seen : seen.is_observable.values()) ASSERT_EQ(is_seen, 0);
}

TEST(MarkSeeable, PlacesNearerThanTheSpacingAreLeftOut) {
  // From the second place one could look behind the wall, but it lies only 0.4 m after the first.
  const std::vector<std::string> room = {"#########", "#...#...#", "#...#...#", "#.......#", "#########"};
  const Trajectory walk = at({{3.9, 1.5}, {4.3, 1.5}});
  EXPECT_EQ(drawing_of(mark_observable(draw(room), walk, 30.0, 0.5)),
            drawing_of(mark_observable(draw(room), at({{3.9, 1.5}}), 30.0)));
  EXPECT_NE(drawing_of(mark_observable(draw(room), walk, 30.0, 0.3)),
            drawing_of(mark_observable(draw(room), at({{3.9, 1.5}}), 30.0)));
}

TEST(MarkSeeable, APlaceOutsideTheMapSeesIntoIt) {
  const OccupancyGrid map = draw({".....", ".....", "..#..", ".....", "....."});
  const ReferenceMap seen = mark_observable(map, at({{-2.5, 2.5}}), 30.0);
  EXPECT_EQ(drawing_of(seen)[2], "..#??");
  EXPECT_EQ(drawing_of(seen)[0], ".....");
  EXPECT_EQ(drawing_of(mark_observable(map, at({{-2.5, 2.5}}), 4.0))[2], "..???");
  EXPECT_EQ(drawing_of(mark_observable(map, at({{-2.5, 2.5}}), 2.0))[2], "?????");
}

/// Marks of a ray without blocks: from border to border of the cells.
void mark_plainly(const OccupancyGrid& map, const Eigen::Vector2d& from_m, double angle_rad, double range_m,
                  Grid<std::uint8_t>& marks) {
  const double size_m = map.geometry().resolution_m;
  Cell cell = map.geometry().cell_at(from_m);
  const double direction[2] = {std::cos(angle_rad), std::sin(angle_rad)};
  double first_m[2] = {1e9, 1e9}, stride_m[2] = {0.0, 0.0};
  for (int axis = 0; axis < 2; ++axis) {
    const double q = from_m[axis] / size_m, speed = std::abs(direction[axis]);
    if (speed <= 1e-12) continue;
    first_m[axis] = (direction[axis] > 0.0 ? std::floor(q) + 1.0 - q : q - std::floor(q)) * size_m / speed;
    stride_m[axis] = size_m / speed;
  }
  for (int columns = 0, rows = 0; map.geometry().contains(cell) && map.at(cell) != kUnknown;) {
    marks.at(cell) = 1;
    if (map.at(cell) == kOccupied) {
      for (int row = cell.row - 1; row <= cell.row + 1; ++row) {
        for (int col = cell.col - 1; col <= cell.col + 1; ++col) {
          if (map.geometry().contains({col, row}) && map.at({col, row}) == kOccupied) marks.at({col, row}) = 1;
        }
      }
      return;
    }
    const double column_m = first_m[0] + columns * stride_m[0], row_m = first_m[1] + rows * stride_m[1];
    if (std::min(column_m, row_m) > range_m) return;
    if (column_m < row_m) {
      ++columns;
      cell.col += direction[0] > 0.0 ? 1 : -1;
    } else {
      ++rows;
      cell.row += direction[1] > 0.0 ? 1 : -1;
    }
  }
}

TEST(MarkSeeable, From24PlacesInAFieldOfPostsItMarksWhatEveryRayCrossesCellByCell) {
  const RandomStream random(4, "posts");
  OccupancyGrid map({.resolution_m = 0.1, .width = 330, .height = 250});
  for (std::size_t i = 0; i < map.values().size(); ++i) {
    const double draw = random.uniform(i, 0);
    map.values()[i] = draw < 0.006 ? kOccupied : draw < 0.0065 ? kUnknown : kFree;
  }
  constexpr double kRange_m = 7.0;
  std::vector<Eigen::Vector2d> places;
  for (std::uint64_t i = 0; i < 24; ++i) places.emplace_back(33.0 * random.uniform(i, 1), 25.0 * random.uniform(i, 2));
  Grid<std::uint8_t> expected(map.geometry());
  const int num_rays = static_cast<int>(std::ceil(std::numbers::pi * kRange_m / 0.1));
  for (const Eigen::Vector2d& place : places) {
    for (int ray = 0; ray < num_rays; ++ray)
      mark_plainly(map, place, 2.0 * std::numbers::pi * ray / num_rays, kRange_m, expected);
  }
  const ReferenceMap seen = mark_observable(map, at(places), kRange_m, 0.0);
  const auto marked = std::count(expected.values().begin(), expected.values().end(), 1);
  EXPECT_GT(marked, 20000);
  EXPECT_LT(marked, 80000);
  EXPECT_EQ(seen.is_observable.values(), expected.values());
}

}  // namespace
}  // namespace patrol::score::visibility_test
