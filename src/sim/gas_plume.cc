#include "sim/gas_plume.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "sim/mujoco.h"

namespace patrol::sim {
namespace {

constexpr double kSourceSize_m = 0.15;

struct BriggsUrban {
  double sigma_y_slope;
  double sigma_z_slope;
};

/// Returns the slopes of Briggs' urban curves near the source, where sigma is proportional to the distance.
BriggsUrban briggs_urban(char stability) {
  switch (stability) {
    case 'A':
    case 'B':
      return {0.32, 0.24};
    case 'C':
      return {0.22, 0.20};
    case 'D':
      return {0.16, 0.14};
    default:
      return {0.11, 0.08};
  }
}

Eigen::Vector2d downwind_of(double direction_deg) {
  const double from_rad = to_rad(direction_deg);
  return {-std::sin(from_rad), -std::cos(from_rad)};
}

}  // namespace

Eigen::Vector3d leak_source(const mjModel& world, const LeakSettings& leak) {
  const int site = mj_name2id(&world, mjOBJ_SITE, leak.at.c_str());
  // The local position of a site of the world body is in world.
  if (site >= 0 && world.site_bodyid[site] == 0) return Eigen::Vector3d(world.site_pos + 3 * site);
  std::string known;
  for (int i = 0; i < world.nsite; ++i) {
    const std::string_view name = name_of(world, mjOBJ_SITE, i);
    if (world.site_bodyid[i] != 0 || name.empty()) continue;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", name);
  }
  if (site >= 0) {
    throw InputError(fmt::format("leaks: at = {}: site of the body {}: must be a site of the world (known: {})",
                                 leak.at, name_of(world, mjOBJ_BODY, world.site_bodyid[site]), known));
  }
  throw InputError(fmt::format("leaks: unknown site at = '{}' (known: {})", leak.at, known));
}

GasPlume::GasPlume(const mjModel& world, const std::vector<LeakSettings>& leaks, const WindSettings& wind)
    : speed_mps_(wind.speed_mps),
      downwind_(downwind_of(wind.direction_deg)),
      sigma_y_slope_(briggs_urban(wind.stability.at(0)).sigma_y_slope),
      sigma_z_slope_(briggs_urban(wind.stability.at(0)).sigma_z_slope) {
  for (const LeakSettings& leak : leaks) {
    leaks_.push_back({leak_source(world, leak), leak.rate_g_s / 1000.0, leak.start_s});
  }
}

GasPlume::GasPlume(const Eigen::Vector3d& source, double rate_g_s, const WindSettings& wind)
    : leaks_({{source, rate_g_s / 1000.0, 0.0}}),
      speed_mps_(wind.speed_mps),
      downwind_(downwind_of(wind.direction_deg)),
      sigma_y_slope_(briggs_urban(wind.stability.at(0)).sigma_y_slope),
      sigma_z_slope_(briggs_urban(wind.stability.at(0)).sigma_z_slope) {}

double GasPlume::plume_kgpm3(const Leak& leak, const Eigen::Vector3d& point) const {
  const Eigen::Vector2d offset = (point - leak.source).head<2>();
  const double along = offset.dot(downwind_);
  const double across = offset.x() * downwind_.y() - offset.y() * downwind_.x();
  if (along < -3.0 * kSourceSize_m) return 0.0;
  const double distance = std::max(along, 0.0);
  const double sigma_y = std::hypot(kSourceSize_m, sigma_y_slope_ * distance);
  const double sigma_z = std::hypot(kSourceSize_m, sigma_z_slope_ * distance);
  // Upwind of the source only the puff at the source contributes.
  const double upwind = along < 0.0 ? std::exp(-0.5 * along * along / (kSourceSize_m * kSourceSize_m)) : 1.0;
  const auto lobe = [&](double height) { return std::exp(-0.5 * height * height / (sigma_z * sigma_z)); };
  return leak.rate_kgps / (2.0 * std::numbers::pi * speed_mps_ * sigma_y * sigma_z) *
         std::exp(-0.5 * across * across / (sigma_y * sigma_y)) *
         (lobe(point.z() - leak.source.z()) + lobe(point.z() + leak.source.z())) * upwind;
}

double GasPlume::concentration_kgpm3(const Eigen::Vector3d& point, double now_s) const {
  double sum = 0.0;
  for (const Leak& leak : leaks_) {
    if (now_s >= leak.start_s) sum += plume_kgpm3(leak, point);
  }
  return std::min(sum, kMethaneDensity_kgpm3);  // at most pure methane
}

double GasPlume::column_ppm_m(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double length_m,
                              double now_s) const {
  double column = 0.0;  // kg/m2
  for (double along = 0.0; along < length_m;) {
    double nearest = length_m;
    for (const Leak& leak : leaks_) nearest = std::min(nearest, (origin + along * direction - leak.source).norm());
    const double step = std::min(std::clamp(nearest / 10.0, 0.02, 0.5), length_m - along);
    column += step * concentration_kgpm3(origin + (along + step / 2.0) * direction, now_s);
    along += step;
  }
  return column / kMethaneDensity_kgpm3 * 1e6;
}

}  // namespace patrol::sim
