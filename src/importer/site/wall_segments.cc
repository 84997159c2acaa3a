#include "importer/site/wall_segments.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "core/geometry/principal_axes.h"
#include "core/map_cells.h"

namespace patrol::importer {
namespace {

constexpr int kNeighborhood_cells = 2;  // half width of the neighborhood that gives the direction of a face
constexpr double kMaxFlatness = 0.25;   // maximum ratio of the variances across and along a straight face
constexpr double kMinThickness_m = 0.005;
constexpr double kMinBackCosine = 0.4;  // of sectors of which no direction is that of the front
constexpr double kMinSamePart = 0.2;    // part of the weight from which a side of a face is kept

Eigen::Vector2d direction_of_sector(int sector, int sectors) {
  const double angle = 2.0 * std::numbers::pi * (sector + 0.5) / sectors;
  return {std::cos(angle), std::sin(angle)};
}

int sector_of(const Eigen::Vector2d& direction, int sectors) {
  const double turn = std::atan2(direction.y(), direction.x()) / (2.0 * std::numbers::pi);
  return std::clamp(static_cast<int>(std::floor((turn - std::floor(turn)) * sectors)), 0, sectors - 1);
}

Eigen::Vector2d left_of(const Eigen::Vector2d& direction) { return {-direction.y(), direction.x()}; }

}  // namespace

void WallFitter::Moments::add(const Moments& other) {
  weight += other.weight;
  sum += other.sum;
  products += other.products;
}

WallFitter::WallFitter(const OccupancyGrid& plan, const WallFitterSettings& settings)
    : grid_(plan.geometry()), settings_(settings), slot_of_(plan.geometry(), -1) {
  int count = 0;
  for (int row = 0; row < grid_.height; ++row) {
    for (int col = 0; col < grid_.width; ++col) {
      if (is_occupied(plan.at({col, row}))) slot_of_.at({col, row}) = count++;
    }
  }
  if (count == 0) throw InputError("the plan has no occupied cell");
  sums_.resize(static_cast<std::size_t>(count));
}

void WallFitter::add(const Eigen::Vector2d& p_hit_m, const Eigen::Vector2d& p_sensor_m) {
  const Cell cell = grid_.cell_at(p_hit_m);
  if (!grid_.contains(cell) || slot_of_.at(cell) < 0) return;
  const Eigen::Vector2d toward_sensor = p_sensor_m - p_hit_m, p = p_hit_m - grid_.origin_m;
  const double ratio = toward_sensor.norm() / settings_.half_weight_range_m, weight = 1.0 / (1.0 + ratio * ratio);
  Moments& sums =
      sums_[static_cast<std::size_t>(slot_of_.at(cell))][static_cast<std::size_t>(sector_of(toward_sensor, kSectors))];
  sums.add({.weight = weight, .sum = weight * p, .products = weight * p * p.transpose()});
}

/// Returns the sums of the cells around one, of all hits or of those seen from the side of `normal`: the cosine of the
/// angle between the normal and the middle of their sector exceeds `min_cosine`.
WallFitter::Moments WallFitter::moments_around(Cell cell, int reach_cells, const Eigen::Vector2d* normal,
                                               double min_cosine) const {
  Moments total;
  for (int row = cell.row - reach_cells; row <= cell.row + reach_cells; ++row) {
    for (int col = cell.col - reach_cells; col <= cell.col + reach_cells; ++col) {
      if (!grid_.contains({col, row}) || slot_of_.at({col, row}) < 0) continue;
      const auto& sectors = sums_[static_cast<std::size_t>(slot_of_.at({col, row}))];
      for (int sector = 0; sector < kSectors; ++sector) {
        if (normal == nullptr || normal->dot(direction_of_sector(sector, kSectors)) > min_cosine)
          total.add(sectors[static_cast<std::size_t>(sector)]);
      }
    }
  }
  return total;
}

std::vector<WallFitter::Surfel> WallFitter::surfels() const {
  const auto covariance = [](const Moments& m) -> Eigen::Matrix2d {
    const Eigen::Vector2d mean = m.sum / m.weight;
    return m.products / m.weight - mean * mean.transpose();
  };
  std::vector<Surfel> surfels;
  for (int row = 0; row < grid_.height; ++row) {
    for (int col = 0; col < grid_.width; ++col) {
      const Cell cell{col, row};
      if (slot_of_.at(cell) < 0) continue;
      const Moments whole = moments_around(cell, 0, nullptr);
      if (whole.weight < settings_.min_weight) continue;
      // Direction from all hits around, then from those of each side of it.
      Eigen::Vector2d normal = left_of(PrincipalAxes::along(
          principal_axes(covariance(moments_around(cell, kNeighborhood_cells, nullptr))).large_direction_rad));
      for (const double side : {1.0, -1.0}) {
        const Eigen::Vector2d facing = side * normal;
        const Moments own = moments_around(cell, 0, &facing);
        if (own.weight < settings_.min_weight || own.weight < kMinSamePart * whole.weight) continue;
        const PrincipalAxes axes = principal_axes(covariance(moments_around(cell, kNeighborhood_cells, &facing)));
        Surfel surfel{.p_m = own.sum / own.weight,
                      .along = PrincipalAxes::along(axes.large_direction_rad),
                      .normal = {},
                      .weight = own.weight,
                      .is_straight = axes.small < kMaxFlatness * axes.large,
                      .cell = cell};
        surfel.normal = left_of(surfel.along);
        if (surfel.normal.dot(facing) < 0.0) surfel.normal = -surfel.normal;
        surfels.push_back(surfel);
      }
    }
  }
  return surfels;
}

/// Fits a line to surfaces. Its direction is that of `along`, and exactly so for fewer than three surfaces.
WallFitter::Line WallFitter::fit(const std::vector<std::size_t>& members, const std::vector<Surfel>& surfels,
                                 const Eigen::Vector2d& along) {
  Moments m;
  for (const std::size_t i : members) {
    const Eigen::Vector2d& p = surfels[i].p_m;
    m.add(
        {.weight = surfels[i].weight, .sum = surfels[i].weight * p, .products = surfels[i].weight * p * p.transpose()});
  }
  Line line{.center = m.sum / m.weight, .along = along};
  if (members.size() > 2) {
    const Eigen::Matrix2d spread = m.products / m.weight - line.center * line.center.transpose();
    const Eigen::Vector2d axis = PrincipalAxes::along(principal_axes(spread).large_direction_rad);
    line.along = axis.dot(along) < 0.0 ? Eigen::Vector2d(-axis) : axis;
  }
  for (const std::size_t i : members) {
    const double at = line.along.dot(surfels[i].p_m - line.center);
    line.begin = std::min(line.begin, at), line.end = std::max(line.end, at);
  }
  return line;
}

bool WallFitter::fits(const Line& line, const Surfel& surfel) const {
  return std::abs(left_of(line.along).dot(surfel.p_m - line.center)) <= settings_.max_offset_m;
}

/// Returns the unused surface that continues a line at an end, `tip`, with the smallest gap; none without one.
std::optional<std::size_t> WallFitter::next_at(double tip, const Line& line, const Eigen::Vector2d& facing,
                                               const std::vector<Surfel>& surfels, const Grid<int>& first_of,
                                               const std::vector<char>& is_used) const {
  const int reach = static_cast<int>(std::ceil(settings_.max_gap_m / grid_.resolution_m)) + 1;
  const Cell around = grid_.cell_at(grid_.origin_m + line.center + tip * line.along);
  const auto continues = [&](const Surfel& other) {
    return other.is_straight && other.normal.dot(facing) >= 0.0 && fits(line, other) &&
           std::abs(other.along.dot(line.along)) >= std::cos(settings_.max_turn_rad);
  };
  std::optional<std::size_t> best;
  double best_gap = settings_.max_gap_m;
  for (int row = around.row - reach; row <= around.row + reach; ++row) {
    for (int col = around.col - reach; col <= around.col + reach; ++col) {
      const Cell cell{col, row};
      if (!grid_.contains(cell) || first_of.at(cell) < 0) continue;
      for (auto i = static_cast<std::size_t>(first_of.at(cell)); i < surfels.size() && surfels[i].cell == cell; ++i) {
        if (is_used[i] != 0 || !continues(surfels[i])) continue;
        const double at = line.along.dot(surfels[i].p_m - line.center);
        const double gap = at < line.begin ? line.begin - at : at > line.end ? at - line.end : 0.0;
        if (gap < best_gap) best_gap = gap, best = i;
      }
    }
  }
  return best;
}

/// Extends a segment from its seed in both directions as long as neighbors fit, and refits the line.
WallSegment WallFitter::grow(std::size_t seed, const std::vector<Surfel>& surfels, const Grid<int>& first_of,
                             std::vector<char>& is_used) const {
  std::vector<std::size_t> members = {seed};
  is_used[seed] = 1;
  const Eigen::Vector2d facing = surfels[seed].normal;
  Line line{.center = surfels[seed].p_m, .along = surfels[seed].along};
  for (bool has_grown = surfels[seed].is_straight; has_grown;) {
    has_grown = false;
    for (const double tip : {line.begin, line.end}) {
      const std::optional<std::size_t> next = next_at(tip, line, facing, surfels, first_of, is_used);
      if (!next) continue;
      members.push_back(*next);
      const Line longer = fit(members, surfels, line.along);
      if (std::ranges::all_of(members, [&](std::size_t i) { return fits(longer, surfels[i]); })) {
        line = longer;
        is_used[*next] = 1;
        has_grown = true;
        break;
      }
      members.pop_back();
    }
  }
  const double half_cell_m = 0.5 * grid_.resolution_m;
  WallSegment segment{.begin_m = grid_.origin_m + line.center + (line.begin - half_cell_m) * line.along,
                      .end_m = grid_.origin_m + line.center + (line.end + half_cell_m) * line.along,
                      .normal = left_of(line.along)};
  if (segment.normal.dot(facing) < 0.0) segment.normal = -segment.normal;
  segment.thickness_m = thickness_behind(segment);
  return segment;
}

/// Returns half of the distance from a face to the hits behind it that are seen from its back, within limits.
double WallFitter::thickness_behind(const WallSegment& segment) const {
  const Eigen::Vector2d back = -segment.normal, whole = segment.end_m - segment.begin_m;
  const int steps = std::max(1, static_cast<int>(std::ceil(whole.norm() / grid_.resolution_m)));
  const int reach = static_cast<int>(std::ceil(2.0 * settings_.max_thickness_m / grid_.resolution_m)) + 1;
  double thickness_m = settings_.max_thickness_m;
  for (int step = 0; step < steps; ++step) {
    const Eigen::Vector2d p_m = segment.begin_m + whole * (step + 0.5) / steps;
    const Cell around = grid_.cell_at(p_m);
    double weight = 0.0, sum_m = 0.0;
    for (int row = around.row - reach; row <= around.row + reach; ++row) {
      for (int col = around.col - reach; col <= around.col + reach; ++col) {
        const Moments seen = moments_around({col, row}, 0, &back, kMinBackCosine);
        if (seen.weight <= 0.0) continue;
        const Eigen::Vector2d from_face = grid_.origin_m + seen.sum / seen.weight - p_m;
        const double distance_m = back.dot(from_face);
        if (std::abs(left_of(back).dot(from_face)) > 0.5 * grid_.resolution_m) continue;
        if (std::abs(distance_m) > 2.0 * settings_.max_thickness_m) continue;
        weight += seen.weight, sum_m += seen.weight * distance_m;
      }
    }
    if (weight >= settings_.min_weight) thickness_m = std::clamp(0.5 * sum_m / weight, kMinThickness_m, thickness_m);
  }
  return thickness_m;
}

std::vector<WallSegment> WallFitter::segments() const {
  const std::vector<Surfel> all = surfels();
  Grid<int> first_of(grid_, -1);
  for (std::size_t i = all.size(); i-- > 0;) first_of.at(all[i].cell) = static_cast<int>(i);
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(all[a].is_straight, all[a].weight) > std::pair(all[b].is_straight, all[b].weight);
  });
  std::vector<char> is_used(all.size(), 0);
  std::vector<WallSegment> segments;
  for (const std::size_t seed : order) {
    if (is_used[seed] == 0) segments.push_back(grow(seed, all, first_of, is_used));
  }
  std::stable_sort(segments.begin(), segments.end(), [](const WallSegment& a, const WallSegment& b) {
    return (a.end_m - a.begin_m).squaredNorm() > (b.end_m - b.begin_m).squaredNorm();
  });
  return segments;
}

bool WallFitter::is_uncovered(Cell cell) const {
  return slot_of_.at(cell) >= 0 && moments_around(cell, 0, nullptr).weight < settings_.min_weight;
}

}  // namespace patrol::importer
