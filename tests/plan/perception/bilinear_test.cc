#include "plan/perception/bilinear.h"

#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::plan::bilinear_test {
namespace {

constexpr double kExactTol = 1e-9;
constexpr double kResolution_m = 0.1;

/// Grid of random values in [0, 1).
class RandomField {
 public:
  RandomField(int width, int height) {
    grid_.resolution_m = kResolution_m;
    grid_.width = width;
    grid_.height = height;
    grid_.origin_m = {-1.0, 2.0};
    const RandomStream stream(1, "test/bilinear");
    for (std::uint64_t i = 0; i < grid_.size(); ++i) values_.push_back(stream.uniform(i));
  }

  /// Interpolated value at a position in cells from the grid's corner.
  double at(double col, double row) const {
    const BilinearCell cell(grid_, grid_.origin_m + kResolution_m * Eigen::Vector2d(col, row));
    return cell.interpolate([this](std::size_t index) { return values_[index]; });
  }
  double of_cell(int col, int row) const { return values_[static_cast<std::size_t>(row * grid_.width + col)]; }
  int width() const { return grid_.width; }
  int height() const { return grid_.height; }

 private:
  GridGeometry grid_;
  std::vector<double> values_;
};

TEST(Bilinear, AtTheCentersOfCellsIsTheirValueAndBetweenThemTheMean) {
  const RandomField field(5, 4);
  for (int row = 0; row < field.height(); ++row) {
    for (int col = 0; col < field.width(); ++col) {
      EXPECT_NEAR(field.at(col + 0.5, row + 0.5), field.of_cell(col, row), kExactTol);
      if (col + 1 < field.width()) {
        EXPECT_NEAR(field.at(col + 1.0, row + 0.5), (field.of_cell(col, row) + field.of_cell(col + 1, row)) / 2.0,
                    kExactTol);
      }
    }
  }
}

TEST(Bilinear, OutsideTheGridIsTheValueOfTheBorder) {
  const RandomField field(5, 4);
  for (double out = 0.0; out < 3.0; out += 0.07) {
    for (int row = 0; row < field.height(); ++row) {
      EXPECT_NEAR(field.at(0.5 - out, row + 0.5), field.of_cell(0, row), kExactTol) << out;
      EXPECT_NEAR(field.at(field.width() - 0.5 + out, row + 0.5), field.of_cell(field.width() - 1, row), kExactTol)
          << out;
    }
    for (int col = 0; col < field.width(); ++col) {
      EXPECT_NEAR(field.at(col + 0.5, 0.5 - out), field.of_cell(col, 0), kExactTol) << out;
      EXPECT_NEAR(field.at(col + 0.5, field.height() - 0.5 + out), field.of_cell(col, field.height() - 1), kExactTol)
          << out;
    }
    EXPECT_NEAR(field.at(0.5 - out, 0.5 - out), field.of_cell(0, 0), kExactTol) << out;
  }
}

// Half a cell inside each edge, at the centers of the border cells, and one cell farther out.
TEST(Bilinear, IsContinuousAtAllEdges) {
  constexpr double kStep = 1e-6;  // cells; values differ by at most 1 per cell
  const RandomField field(5, 4);
  const auto expect_continuous = [&](double col, double row) {
    const double here = field.at(col, row);
    for (const double step : {-kStep, kStep}) {
      EXPECT_NEAR(field.at(col + step, row), here, 2.0 * kStep) << col << ' ' << row;
      EXPECT_NEAR(field.at(col, row + step), here, 2.0 * kStep) << col << ' ' << row;
    }
  };
  for (const double edge : {-0.5, 0.5}) {
    for (double along = -1.0; along < 6.0; along += 0.13) {
      expect_continuous(edge, along);
      expect_continuous(field.width() - edge, along);
      expect_continuous(along, edge);
      expect_continuous(along, field.height() - edge);
    }
  }
}

TEST(Bilinear, AGridOfOneCellHasOneValue) {
  const RandomField field(1, 1);
  for (double x = -2.0; x < 3.0; x += 0.3) EXPECT_NEAR(field.at(x, 1.0 - x), field.of_cell(0, 0), kExactTol);
}

}  // namespace
}  // namespace patrol::plan::bilinear_test
