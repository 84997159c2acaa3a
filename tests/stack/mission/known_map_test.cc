#include "stack/mission/known_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::stack::known_map_test {
namespace {

using ::testing::ThrowsMessage;

/// 4 x 2 m around the start: free, and a wall at its right end.
OccupancyGrid make_map() {
  OccupancyGrid map({.resolution_m = 1.0, .width = 4, .height = 2, .origin_m = {-2.0, -1.0}}, kFree);
  map.at({3, 0}) = map.at({3, 1}) = kOccupied;
  return map;
}

std::vector<SavedGoal> goal_at(double x, double y) { return {{.number = 7, .T_map_body = {x, y, 0.0}}}; }

TEST(KnownMap, WithFloorAndWallAroundTheStartIsTaken) { EXPECT_NO_THROW(validate_map("m.yaml", make_map())); }

TEST(KnownMap, WithoutAFreeOrAnOccupiedCellIsRefused) {
  OccupancyGrid map = make_map();
  map.values() = {kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
  EXPECT_THAT([&] { validate_map("m.yaml", map); }, ThrowsMessage<InputError>("m.yaml: map contains no free cells"));
  map.at({0, 0}) = kFree;
  EXPECT_THAT([&] { validate_map("m.yaml", map); },
              ThrowsMessage<InputError>("m.yaml: map contains no occupied cells"));
}

TEST(KnownMap, ThatDoesNotHoldTheStartIsRefused) {
  OccupancyGrid map({.resolution_m = 0.5, .width = 4, .height = 2, .origin_m = {0.25, 0.0}}, kFree);
  map.at({3, 0}) = kOccupied;
  EXPECT_THAT(
      [&] { validate_map("m.yaml", map); },
      ThrowsMessage<InputError>("m.yaml: start (0, 0) is outside the map (x in [0.25, 2.25] m, y in [0.00, 1.00] m)"));
}

TEST(KnownMap, GoalsLieOnItEvenInAWall) {
  EXPECT_NO_THROW(validate_goals("nav.json", goal_at(-2.0, -1.0), make_map()));
  EXPECT_NO_THROW(validate_goals("nav.json", goal_at(1.5, 0.5), make_map()));
  EXPECT_THAT([] { validate_goals("nav.json", goal_at(2.0, 0.0), make_map()); },
              ThrowsMessage<InputError>(
                  "nav.json: goal 7: position 2, 0 is outside the map (x in [-2.00, 2.00] m, y in [-1.00, 1.00] m)"));
  EXPECT_THROW(validate_goals("nav.json", goal_at(-1e300, 0.0), make_map()), InputError);
}

TEST(KnownMap, GoalsOnAMapThatIsStillToBeMadeLieWithinOneKilometre) {
  EXPECT_NO_THROW(validate_goals("nav.json", goal_at(600.0, 800.0), std::nullopt));
  EXPECT_THAT([] { validate_goals("nav.json", goal_at(600.0, 801.0), std::nullopt); },
              ThrowsMessage<InputError>("nav.json: goal 7: position 600, 801 is more than 1000 m from the start"));
  EXPECT_THROW(validate_goals("nav.json", goal_at(1e300, 1e300), std::nullopt), InputError);
}

}  // namespace
}  // namespace patrol::stack::known_map_test
