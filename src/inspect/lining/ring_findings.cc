#include "inspect/lining/ring_findings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "core/geometry/angles.h"

namespace patrol::inspect {
namespace {

constexpr std::array kParabola{-3.0 / 35.0, 12.0 / 35.0, 17.0 / 35.0, 12.0 / 35.0, -3.0 / 35.0};

/// Applies the squared patch scale, which the covariance already includes and the patch variances do not.
double residual_variance(const Patch& patch, const Adjustment& adjustment) {
  return patch.var_m2 * adjustment.scale * adjustment.scale;
}

/// Returns the variance of a displacement by the systematic angle errors of both scans. They vary over the sphere, so
/// that the registration does not fit them; neighboring sectors share them.
double angle_variance(const Vector7& J, const Adjustment& adjustment) {
  return J.segment<3>(3).squaredNorm() * adjustment.angle_var_rad2;
}

double std_of(double variance_m2, const Vector7& J, const Adjustment& adjustment) {
  return std::sqrt(variance_m2 + J.dot(adjustment.covariance * J));
}

double std_of(const SectorDisplacement& move, const Adjustment& adjustment) {
  return std_of(move.residual_var_m2 + angle_variance(move.J, adjustment), move.J, adjustment);
}

std::vector<SectorDisplacement> ring_of(const LiningGrid& grid, const Adjustment& adjustment, int ring) {
  std::vector<SectorDisplacement> sectors(static_cast<std::size_t>(grid.sectors()));
  for (const Patch& patch : adjustment.patches) {
    if (patch.cell < 0 || grid.ring_of(patch.cell) != ring) continue;
    sectors[static_cast<std::size_t>(grid.sector_of(patch.cell))] = {.is_observed = true,
                                                                     .inward_m = patch.offset_m,
                                                                     .residual_var_m2 =
                                                                         residual_variance(patch, adjustment),
                                                                     .J = patch.J};
  }
  return sectors;
}

WarningLevel level_of(double moved_mm, const LiningSettings& settings) {
  if (moved_mm >= settings.alarm_mm) return WarningLevel::kAlarm;
  if (moved_mm >= settings.warning_mm) return WarningLevel::kWarning;
  return moved_mm >= settings.notice_mm ? WarningLevel::kNotice : WarningLevel::kNone;
}

struct Line {
  const char* name;
  double from_deg, to_deg;  ///< clock positions of the ends
};
constexpr std::array kChords{Line{"9-3", 270.0, 90.0}, Line{"10-2", 300.0, 60.0}, Line{"12-9", 0.0, 270.0},
                             Line{"12-3", 0.0, 90.0}};

std::optional<SectorDisplacement> displacement_at(const LiningGrid& grid, const std::vector<SectorDisplacement>& ring,
                                                  double clock_deg) {
  const double turned_deg = clock_deg > 180.0 ? clock_deg - 360.0 : clock_deg;
  const int sector = static_cast<int>(std::lround(turned_deg / grid.sector_deg)) + grid.half_sectors;
  if (sector < 0 || sector >= grid.sectors() || !ring[static_cast<std::size_t>(sector)].is_observed)
    return std::nullopt;
  return ring[static_cast<std::size_t>(sector)];
}

/// Returns the outward direction for a viewer along the axis: components to the right and up.
Eigen::Vector2d outwards(double clock_deg) { return {std::sin(clock_deg * kDegree), std::cos(clock_deg * kDegree)}; }

}  // namespace

std::vector<LiningCell> lining_cells(const LiningGrid& grid, const Adjustment& adjustment) {
  std::vector<LiningCell> cells;
  for (const Patch& patch : adjustment.patches) {
    if (patch.cell < 0) continue;
    cells.push_back({.ring = grid.ring_of(patch.cell),
                     .clock_deg = grid.clock_deg(grid.sector_of(patch.cell)),
                     .inward_m = patch.offset_m,
                     .std_m = std_of(residual_variance(patch, adjustment) + angle_variance(patch.J, adjustment),
                                     patch.J, adjustment),
                     .points = patch.points});
  }
  return cells;
}

std::vector<SectorDisplacement> smoothed_ring(const LiningGrid& grid, const Adjustment& adjustment, int ring) {
  const std::vector<SectorDisplacement> raw = ring_of(grid, adjustment, ring);
  std::vector<SectorDisplacement> smooth = raw;
  for (std::size_t sector = 2; sector + 2 < raw.size(); ++sector) {
    SectorDisplacement sum{.is_observed = true};
    for (std::size_t k = 0; k < kParabola.size(); ++k) {
      const SectorDisplacement& part = raw[sector + k - 2];
      sum.is_observed = sum.is_observed && part.is_observed;
      sum.inward_m += kParabola[k] * part.inward_m;
      sum.residual_var_m2 += kParabola[k] * kParabola[k] * part.residual_var_m2;
      sum.J += kParabola[k] * part.J;
    }
    if (sum.is_observed) smooth[sector] = sum;
  }
  return smooth;
}

std::vector<RingFinding> ring_findings(const LiningInMap& lining, const LiningGrid& grid, const Adjustment& adjustment,
                                       const LiningSettings& settings) {
  std::vector<RingFinding> findings;
  for (int ring = grid.first_ring; ring < grid.first_ring + grid.rings; ++ring) {
    std::optional<RingFinding> largest;
    const std::vector<SectorDisplacement> sectors = smoothed_ring(grid, adjustment, ring);
    for (int sector = 0; sector < grid.sectors(); ++sector) {
      const SectorDisplacement& move = sectors[static_cast<std::size_t>(sector)];
      if (!move.is_observed || (largest && std::abs(move.inward_m) <= std::abs(largest->inward_m))) continue;
      const double std_m = std_of(move, adjustment);
      const WarningLevel level = level_of(1000.0 * std::abs(move.inward_m), settings);
      if (level == WarningLevel::kNone || std::abs(move.inward_m) < settings.significance * std_m) continue;
      largest = RingFinding{
          .ring = ring, .clock_deg = grid.clock_deg(sector), .inward_m = move.inward_m, .std_m = std_m, .level = level};
    }
    if (!largest) continue;
    largest->p_map = lining.intrados(lining.design.middle_of_ring_m(ring), largest->clock_deg);
    findings.push_back(*largest);
  }
  return findings;
}

std::vector<ConvergenceLine> convergence_lines(const LiningInMap& lining, const LiningGrid& grid,
                                               const Adjustment& adjustment) {
  std::vector<ConvergenceLine> lines;
  for (int ring = grid.first_ring; ring < grid.first_ring + grid.rings; ++ring) {
    const std::vector<SectorDisplacement> sectors = smoothed_ring(grid, adjustment, ring);
    for (const Line& line : kChords) {
      const auto from = displacement_at(grid, sectors, line.from_deg), to = displacement_at(grid, sectors, line.to_deg);
      if (!from || !to) continue;
      const Eigen::Vector2d chord = lining.design.radius_at(line.to_deg) * outwards(line.to_deg) -
                                    lining.design.radius_at(line.from_deg) * outwards(line.from_deg);
      // An inward displacement of an end is opposite to its outward direction. The chord grows by the separation of its
      // ends.
      const double from_part = chord.normalized().dot(outwards(line.from_deg)),
                   to_part = -chord.normalized().dot(outwards(line.to_deg));
      const double variance_m2 = from_part * from_part * (from->residual_var_m2 + angle_variance(from->J, adjustment)) +
                                 to_part * to_part * (to->residual_var_m2 + angle_variance(to->J, adjustment));
      lines.push_back({.ring = ring,
                       .name = line.name,
                       .change_m = from_part * from->inward_m + to_part * to->inward_m,
                       .std_m = std_of(variance_m2, from_part * from->J + to_part * to->J, adjustment)});
    }
    if (const auto crown = displacement_at(grid, sectors, 0.0)) {
      lines.push_back({.ring = ring, .name = "12-", .change_m = -crown->inward_m, .std_m = std_of(*crown, adjustment)});
    }
  }
  return lines;
}

}  // namespace patrol::inspect
