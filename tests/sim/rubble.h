#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/random.h"

namespace patrol::sim {

/// MJCF of ground of rubble, a height field of 0.1 m cells about the origin, `length_m` along x: heights are white
/// noise of `grain_std_m` on swells of `swell_std_m` about 0.4 m across.
inline std::string make_rubble_world(double length_m = 16.0, double width_m = 6.0, double swell_std_m = 0.02,
                                     double grain_std_m = 0.012) {
  constexpr double kCell_m = 0.1;
  const int columns = static_cast<int>(length_m / kCell_m) + 1, rows = static_cast<int>(width_m / kCell_m) + 1;
  const RandomStream random(7, "rubble");
  const auto noise = [&](int row, int column, std::uint64_t layer) {
    return random.normal(static_cast<std::uint64_t>(row) * 100000u + static_cast<std::uint64_t>(column), layer);
  };
  std::vector<double> height_m;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      double swell = 0.0;  // the mean of 5 x 5 draws, scaled to unit variance
      for (int dr = 0; dr < 5; ++dr) {
        for (int dc = 0; dc < 5; ++dc) swell += noise(row + dr, column + dc, 0) / 5.0;
      }
      height_m.push_back(swell_std_m * swell + grain_std_m * noise(row, column, 1));
    }
  }
  const auto [lowest, highest] = std::minmax_element(height_m.begin(), height_m.end());
  const double low_m = *lowest, range_m = *highest - low_m;
  std::string elevation;
  for (const double h : height_m) elevation += fmt::format("{:.4f} ", (h - low_m) / range_m);
  return fmt::format(
      R"(<mujoco><option timestep="0.002"/><asset><hfield name="rubble" nrow="{}" ncol="{}" size="{} {} {} 0.1"
    elevation="{}"/></asset><worldbody><geom name="ground" type="hfield" hfield="rubble" pos="0 0 {}" contype="1"
    conaffinity="2"/></worldbody></mujoco>)",
      rows, columns, length_m / 2.0, width_m / 2.0, range_m, elevation, low_m);
}

}  // namespace patrol::sim
