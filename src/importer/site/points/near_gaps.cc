#include "importer/site/points/near_gaps.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace patrol::importer {
namespace {

/// Returns the range below which a return is near the minimum range of the scanner; 0 if no return is close.
float near_range_m(const Panorama& scan) {
  constexpr double kLowest = 1e-4;  // fraction of returns: single drops or insects are closer
  constexpr float kRatio = 1.25f, kLargest_m = 1.6f;
  std::vector<float> close_m;
  std::size_t num_returns = 0;
  for (int col = 0; col < scan.columns(); ++col) {
    for (int row = 0; row < scan.rows(); ++row) {
      const float range_m = scan.range_m({col, row});
      num_returns += range_m > 0.0f ? 1 : 0;
      if (range_m > 0.0f && range_m < kLargest_m) close_m.push_back(range_m);
    }
  }
  const auto rank = static_cast<std::size_t>(kLowest * static_cast<double>(num_returns));
  if (rank >= close_m.size()) return 0.0f;
  std::nth_element(close_m.begin(), close_m.begin() + static_cast<std::ptrdiff_t>(rank), close_m.end());
  return std::min(kRatio * close_m[rank], kLargest_m);
}

class GapMarker {
 public:
  GapMarker(Panorama& scan, float near_m)
      : scan_(scan),
        near_m_(near_m),
        is_visited_(static_cast<std::size_t>(scan.columns()) * static_cast<std::size_t>(scan.rows()), 0) {}

  void mark_all() {
    for (int col = 0; col < scan_.columns(); ++col) {
      for (int row = 0; row < scan_.rows(); ++row) {
        if (scan_.range_m({col, row}) <= 0.0f && visit({col, row})) mark({col, row});
      }
    }
  }

 private:
  bool visit(Pixel pixel) {
    char& is_visited = is_visited_[static_cast<std::size_t>(pixel.col) * static_cast<std::size_t>(scan_.rows()) +
                                   static_cast<std::size_t>(pixel.row)];
    if (is_visited != 0) return false;
    is_visited = 1;
    return true;
  }

  /// Marks the gap that contains a pixel if a close surface explains it.
  void mark(Pixel first) {
    constexpr double kMinFraction = 0.1;
    constexpr double kSteepDown = -0.5;  // sine of the elevation
    std::vector<Pixel> gap = {first};
    bool is_down = false;
    std::size_t num_around = 0, num_near = 0;
    for (std::size_t i = 0; i < gap.size(); ++i) {
      const Pixel at = gap[i];
      is_down = is_down || scan_.direction(at).z() < kSteepDown;
      for (const Pixel next : {Pixel{scan_.wrapped(at.col + 1), at.row}, Pixel{scan_.wrapped(at.col - 1), at.row},
                               Pixel{at.col, at.row + 1}, Pixel{at.col, at.row - 1}}) {
        if (!scan_.contains_row(next.row)) continue;
        const float range_m = scan_.range_m(next);
        if (range_m > 0.0f) {
          ++num_around;
          num_near += range_m < near_m_ ? 1 : 0;
        } else if (visit(next)) {
          gap.push_back(next);
        }
      }
    }
    const bool is_near =
        num_near > 0 && static_cast<double>(num_near) >= kMinFraction * static_cast<double>(num_around);
    if (!is_near && !is_down) return;
    for (const Pixel pixel : gap) scan_.state(pixel) |= kPixelBlocked;
  }

  Panorama& scan_;
  float near_m_;
  std::vector<char> is_visited_;
};

}  // namespace

void mark_near_gaps(Panorama& scan) { GapMarker(scan, near_range_m(scan)).mark_all(); }

}  // namespace patrol::importer
