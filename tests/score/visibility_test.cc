#include "score/visibility.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace patrol::score::visibility_test
