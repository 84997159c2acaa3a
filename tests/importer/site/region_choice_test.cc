#include "importer/site/region_choice.h"

#include <gtest/gtest.h>

namespace patrol::importer::region_choice_test {
namespace {

const auto kAll = [](std::size_t) { return true; };

TEST(RegionChoice, CellsInTheMarginAreCountedApartAndTheBorderIsNoticed) {
  const GridGeometry plan{.resolution_m = 0.5, .width = 20, .height = 10};
  RegionArea all, without_margin;
  for (int row = 0; row < 10; ++row) {
    for (int col = 0; col < 20; ++col) {
      all.add(plan, {col, row}, 1.0);
      without_margin.add(plan, {col, row}, 0.0);
    }
  }
  EXPECT_EQ(all.num_cells, 200u);
  EXPECT_EQ(all.num_inner, 14u * 4u);  // 1 m and a cell at each side
  EXPECT_TRUE(all.reaches_border);
  EXPECT_EQ(without_margin.num_inner, 200u);
  RegionArea middle;
  middle.add(plan, {10, 5}, 1.0);
  EXPECT_FALSE(middle.reaches_border);
  EXPECT_EQ(middle.num_inner, 1u);
}

TEST(RegionChoice, ARoomIsTakenIfTheGroundOutsideIsLargerOnlyWithItsMargin) {
  const std::vector<RegionArea> room = {{.num_cells = 500, .num_inner = 20, .reaches_border = true},
                                        {.num_cells = 90, .num_inner = 90},
                                        {.num_cells = 100, .num_inner = 100}};
  EXPECT_EQ(choose_region(room, kAll)->index, 2u);
  EXPECT_TRUE(choose_region(room, kAll)->is_enclosed);
  EXPECT_EQ(choose_region(room, [](std::size_t i) { return i != 2; })->index, 1u);
  EXPECT_EQ(choose_region(room, [](std::size_t) { return false; })->index, 0u);
  EXPECT_FALSE(choose_region(room, [](std::size_t) { return false; })->is_enclosed);
}

TEST(RegionChoice, TheStreetIsTakenIfItIsLargerThanTheHousesAlsoWithoutItsMargin) {
  const std::vector<RegionArea> street = {{.num_cells = 100, .num_inner = 100},
                                          {.num_cells = 500, .num_inner = 150, .reaches_border = true}};
  EXPECT_EQ(choose_region(street, kAll)->index, 1u);
  EXPECT_FALSE(choose_region(street, kAll)->is_enclosed);
}

TEST(RegionChoice, GroundThatEndsBeforeTheBorderCountsWithAllOfItsArea) {
  const std::vector<RegionArea> floor = {{.num_cells = 500, .num_inner = 20}, {.num_cells = 100, .num_inner = 100}};
  EXPECT_EQ(choose_region(floor, kAll)->index, 0u);
  EXPECT_FALSE(choose_region({}, kAll));
}

}  // namespace
}  // namespace patrol::importer::region_choice_test
