#include "plan/perception/cell_box.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::plan::cell_box_test {
namespace {

bool covers(const CellBoxes& boxes, Cell cell) {
  return std::ranges::any_of(boxes.boxes(), [&](const CellBox& box) {
    return cell.col >= box.min.col && cell.col <= box.max.col && cell.row >= box.min.row && cell.row <= box.max.row;
  });
}

TEST(CellBoxes, CellsFarFromEachOtherAreInDifferentBoxes) {
  CellBoxes boxes;
  EXPECT_TRUE(boxes.is_empty());
  for (const Cell cell : {Cell{0, 0}, Cell{300, 0}, Cell{2, 3}, Cell{301, 4}, Cell{1, 1}}) boxes.extend(cell);
  ASSERT_EQ(boxes.boxes().size(), 2U);
  EXPECT_EQ(boxes.boxes()[0].max, (Cell{2, 3}));
  EXPECT_EQ(boxes.boxes()[1].min, (Cell{300, 0}));
  EXPECT_EQ(boxes.boxes()[1].max, (Cell{301, 4}));
}

TEST(CellBoxes, AThousandCellsAreCoveredByAtMost32Boxes) {
  CellBoxes boxes, other;
  std::vector<Cell> cells;
  const RandomStream stream(1, "test/cell_boxes");
  for (std::uint64_t i = 0; i < 1000; ++i) {
    cells.push_back({static_cast<int>(4000.0 * stream.uniform(i, 0)), static_cast<int>(4000.0 * stream.uniform(i, 1))});
    boxes.extend(cells.back());
  }
  EXPECT_LE(boxes.boxes().size(), 32U);
  other.merge(boxes);
  for (const Cell cell : cells) EXPECT_TRUE(covers(boxes, cell) && covers(other, cell));
}

}  // namespace
}  // namespace patrol::plan::cell_box_test
