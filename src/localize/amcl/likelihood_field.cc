#include "localize/amcl/likelihood_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "localize/amcl/distance_to_occupied.h"

namespace patrol::localize {
namespace {

constexpr std::size_t kBlock = 64;  // number of ends that are rotated before the lookup
constexpr int kMaxLevel = 255;
constexpr double kMinLinearity = 0.6;  // below it, the distance to the cells is used

/// Distance from the center of a cell to the surface, m. Beyond the end of a wall, where its line continues, the
/// distance to the cells bounds it from below.
double distance_to_surface(const Eigen::Vector2d& center, double to_cells_m, double resolution_m,
                           const LineField& lines) {
  const SurfaceLine* line = lines.find(center);
  if (!line || line->linearity < kMinLinearity) return to_cells_m;
  return std::max(std::abs(line->normal_map.dot(center - line->point_map)), to_cells_m - resolution_m);
}

}  // namespace

BeamEnds select_beam_ends(const LevelScan& scan, int max_beams) {
  std::vector<Eigen::Vector2f> hits;
  for (const LevelScan::Beam& beam : scan.beams) {
    if (beam.is_hit && beam.end_m.allFinite()) hits.push_back(beam.end_m);
  }
  const std::size_t count = std::min(hits.size(), static_cast<std::size_t>(max_beams));
  BeamEnds ends;
  ends.x_m.reserve(count), ends.y_m.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2f& end = hits[i * hits.size() / count];
    ends.x_m.push_back(end.x()), ends.y_m.push_back(end.y());
  }
  return ends;
}

LikelihoodField::LikelihoodField(const LikelihoodFieldSettings& settings, const OccupancyGrid& map,
                                 const LineField& lines)
    : settings_(settings), inverse_resolution_(1.0 / map.geometry().resolution_m) {
  const GridGeometry& geometry = map.geometry();
  const double random = settings.z_rand, sigma = settings.hit_std_m;
  level_step_ = -std::log(random) / kMaxLevel;
  corner_m_ = geometry.origin_m - Eigen::Vector2d::Constant(geometry.resolution_m);
  stride_ = static_cast<std::size_t>(geometry.width) + 2;
  max_col_ = static_cast<float>(geometry.width + 1), max_row_ = static_cast<float>(geometry.height + 1);
  level_.assign(stride_ * (static_cast<std::size_t>(geometry.height) + 2), kMaxLevel);

  const Grid<float> distance_m = distance_to_occupied(map, 4.0 * sigma);
  for (int row = 0; row < geometry.height; ++row) {
    for (int col = 0; col < geometry.width; ++col) {
      const auto to_cells_m = static_cast<double>(distance_m.at({col, row}));
      const double ratio =
          distance_to_surface(geometry.center_of({col, row}), to_cells_m, geometry.resolution_m, lines) / sigma;
      const double log_likelihood = std::log((1.0 - random) * std::exp(-0.5 * ratio * ratio) + random);
      level_[static_cast<std::size_t>(row + 1) * stride_ + static_cast<std::size_t>(col + 1)] =
          static_cast<std::uint8_t>(std::lround(-log_likelihood / level_step_));
    }
  }
}

ScanLikelihoods LikelihoodField::evaluate(const LevelScan& scan, const std::vector<Pose2>& T_map_body) const {
  const BeamEnds ends = select_beam_ends(scan, settings_.max_beams);
  ScanLikelihoods result;
  result.num_beams = static_cast<int>(ends.size());
  result.mean_log.reserve(T_map_body.size());
  for (const Pose2& pose : T_map_body) result.mean_log.push_back(mean_log(ends, pose));
  return result;
}

// Single precision and blocks: rotation and clamping are vectorized for four ends, without branches.
double LikelihoodField::mean_log(const BeamEnds& ends, const Pose2& T_map_body) const {
  if (ends.size() == 0) return 0.0;
  const auto c = static_cast<float>(inverse_resolution_ * std::cos(T_map_body.yaw));
  const auto s = static_cast<float>(inverse_resolution_ * std::sin(T_map_body.yaw));
  const auto x = static_cast<float>(inverse_resolution_ * (T_map_body.x - corner_m_.x()));
  const auto y = static_cast<float>(inverse_resolution_ * (T_map_body.y - corner_m_.y()));
  std::array<int, kBlock> cols, rows;  // NOLINT(cppcoreguidelines-pro-type-member-init): written before they are read
  int sum = 0;
  for (std::size_t begin = 0; begin < ends.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, ends.size() - begin);
    const float* const end_x = ends.x_m.data() + begin;
    const float* const end_y = ends.y_m.data() + begin;
    for (std::size_t i = 0; i < count; ++i) {
      cols[i] = static_cast<int>(std::min(std::max(x + (c * end_x[i] - s * end_y[i]), 0.0F), max_col_));
      rows[i] = static_cast<int>(std::min(std::max(y + (s * end_x[i] + c * end_y[i]), 0.0F), max_row_));
    }
    for (std::size_t i = 0; i < count; ++i) sum += level_at(cols[i], rows[i]);
  }
  return -level_step_ * sum / static_cast<double>(ends.size());
}

double LikelihoodField::log_at(const Eigen::Vector2d& p_map) const {
  const Eigen::Vector2d cell = inverse_resolution_ * (p_map - corner_m_);
  const auto index = [](double value, float max) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(max)));
  };
  return -level_step_ * level_at(index(cell.x(), max_col_), index(cell.y(), max_row_));
}

}  // namespace patrol::localize
