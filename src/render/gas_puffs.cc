#include "render/gas_puffs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/geometry/angles.h"
#include "render/canvas.h"
#include "render/scene/palette.h"

namespace patrol::render {
namespace {

/// Reproducible pseudorandom offset of a puff, -0.5 ... 0.5.
double scatter(std::int64_t along, int across, int up, unsigned axis) {
  std::uint64_t x = static_cast<std::uint64_t>(along) * 0x9e3779b97f4a7c15u +
                    static_cast<std::uint64_t>(across + 64) * 0xbf58476d1ce4e5b9u +
                    static_cast<std::uint64_t>(up + 64) * 0x94d049bb133111ebu + axis;
  x = (x ^ (x >> 31)) * 0x7fb5d329728ea185u;
  x ^= x >> 27;
  return static_cast<double>(x >> 11) * 0x1p-53 - 0.5;
}

/// Optical depth of the gas on a coarse grid of pixels; the gas has no sharp edges.
struct OpticalDepthImage {
  int step, width, height;
  std::vector<float> optical_depth;

  OpticalDepthImage(const Frame& frame, int step_px)
      : step(step_px),
        width((frame.width() + step - 1) / step + 1),
        height((frame.height() + step - 1) / step + 1),
        optical_depth(static_cast<std::size_t>(width * height), 0.0f) {}
  float& at(int x, int y) { return optical_depth[static_cast<std::size_t>(y * width + x)]; }
};

/// Adds a puff's optical depth: all of it where no object is in front of the puff's far side, none where an object is
/// in front of its near side.
void add(OpticalDepthImage& veil, const Frame& frame, const std::vector<float>& depth, const Projector& projector,
         const Puff& puff) {
  constexpr double kReach = 2.3;  // in standard deviations
  const std::optional<Projected> middle = projector.project(puff.p_world_m);
  if (!middle || middle->distance_m < 2.0 * puff.radius_m) return;
  const double reach_px = kReach * puff.radius_m * projector.focal_px() / middle->distance_m;
  const auto first = [&](double at) { return static_cast<int>(std::max(0.0, std::ceil((at - reach_px) / veil.step))); };
  const auto last = [&](double at, int size) {
    return static_cast<int>(std::min(size - 1.0, std::floor((at + reach_px) / veil.step)));
  };
  for (int y = first(middle->pixel.y()); y <= last(middle->pixel.y(), veil.height); ++y) {
    for (int x = first(middle->pixel.x()); x <= last(middle->pixel.x(), veil.width); ++x) {
      const double q = (Eigen::Vector2d(x, y) * veil.step - middle->pixel).squaredNorm() / (reach_px * reach_px);
      if (q >= 1.0) continue;
      const int px = std::min(x * veil.step, frame.width() - 1), py = std::min(y * veil.step, frame.height() - 1);
      const double free_m =
          projector.distance_m(depth[static_cast<std::size_t>(py * frame.width() + px)]) - middle->distance_m;
      const double seen = std::clamp(0.5 + 0.5 * free_m / puff.radius_m, 0.0, 1.0);
      veil.at(x, y) += static_cast<float>(puff.column_ppm_m / kVeilColumn_ppm_m * (1.0 - q) * (1.0 - q) * seen);
    }
  }
}

void blend_over(Frame& frame, OpticalDepthImage& veil) {
  for (int y = 0; y < frame.height(); ++y) {
    const int v = y / veil.step;
    const float fy = static_cast<float>(y % veil.step) / static_cast<float>(veil.step);
    for (int x = 0; x < frame.width(); ++x) {
      const int u = x / veil.step;
      const float fx = static_cast<float>(x % veil.step) / static_cast<float>(veil.step);
      const float above = veil.at(u, v) + fx * (veil.at(u + 1, v) - veil.at(u, v));
      const float below = veil.at(u, v + 1) + fx * (veil.at(u + 1, v + 1) - veil.at(u, v + 1));
      const float thick = above + fy * (below - above);
      if (thick > 0.004f)
        frame.at(x, y) = blend(frame.at(x, y), kGasColor, 1.0 - std::exp(-static_cast<double>(thick)));
    }
  }
}

}  // namespace

GasCloud::GasCloud(const mjModel& world, const std::vector<sim::LeakSettings>& leaks, const sim::WindSettings& wind) {
  const double from_rad = to_rad(wind.direction_deg);  // clockwise from north
  downwind_ = {-std::sin(from_rad), -std::cos(from_rad)};
  for (const sim::LeakSettings& leak : leaks) {
    const Eigen::Vector3d source = sim::leak_source(world, leak);
    plumes_.push_back({sim::GasPlume(source, leak.rate_g_s, wind), source, leak.start_s});
  }
}

// Samples the plume on a lattice that widens downwind at about the plume's rate. Each puff contains the gas around its
// lattice point.
std::vector<Puff> GasCloud::puffs(double now_s, double drift_m) const {
  constexpr double kStep_m = 0.15, kUpwind_m = 0.25, kReach_m = 6.0, kMinColumn_ppm_m = 15.0;
  constexpr int kBeside = 3;
  const Eigen::Vector2d across_wind(-downwind_.y(), downwind_.x());
  std::vector<Puff> puffs;
  for (const Plume& plume : plumes_) {
    if (now_s < plume.start_s) continue;
    const auto first = static_cast<std::int64_t>(std::ceil((-kUpwind_m - drift_m) / kStep_m));
    const auto last = static_cast<std::int64_t>(std::floor((kReach_m - drift_m) / kStep_m));
    for (std::int64_t n = first; n <= last; ++n) {
      const double along_m = static_cast<double>(n) * kStep_m + drift_m;
      const double spacing_m = 0.09 + 0.1 * std::max(along_m, 0.0);
      // fades puffs in and out at the ends of the lattice
      const double ends = std::clamp(std::min(along_m + kUpwind_m, kReach_m - along_m), 0.0, 1.0);
      for (int j = -kBeside; j <= kBeside; ++j) {
        for (int k = -kBeside; k <= kBeside; ++k) {
          const Eigen::Vector2d p_puff = plume.source_m.head<2>() +
                                         (along_m + kStep_m * scatter(n, j, k, 0)) * downwind_ +
                                         spacing_m * (j + scatter(n, j, k, 1)) * across_wind;
          const Eigen::Vector3d p(p_puff.x(), p_puff.y(), plume.source_m.z() + spacing_m * (k + scatter(n, j, k, 2)));
          const double radius_m = std::hypot(0.05, 0.65 * spacing_m);
          const double mass_kg = plume.gas.concentration_kgpm3(p, now_s) * kStep_m * spacing_m * spacing_m;
          const double column_ppm_m =
              ends * mass_kg / (2.0 * std::numbers::pi * radius_m * radius_m) / sim::kMethaneDensity_kgpm3 * 1e6;
          if (column_ppm_m > kMinColumn_ppm_m) puffs.push_back({p, radius_m, column_ppm_m});
        }
      }
    }
  }
  return puffs;
}

void draw_puffs(Frame& frame, const std::vector<float>& depth, const Projector& projector,
                const std::vector<Puff>& puffs) {
  if (puffs.empty()) return;
  constexpr int kCoarseHeight_px = 360;
  OpticalDepthImage veil(frame, std::max(1, frame.height() / kCoarseHeight_px));
  for (const Puff& puff : puffs) add(veil, frame, depth, projector, puff);
  blend_over(frame, veil);
}

}  // namespace patrol::render
