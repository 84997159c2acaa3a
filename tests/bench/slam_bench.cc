// Integration of a scan into a grid map, and a line fit per point of a scan, against plain loops.
//   tests/bench/slam_bench
// IntegrateScanAgainstDenseGrid: both trace every sixth of 1,440 beams through free space and add all hits. The
// reference uses arrays of the whole map and the traversal of Amanatides and Woo with a branch per step. The subject is
// integrate_scan() into tiles, with the rules for cells with hits. LinearizeAgainstDenseSums: for each point, the
// reference adds up the moments of the surface cells among 7 x 7 of an array. The subject is one iteration of
// match_scan(), with the normal equations. The ratios are to be at most 1.5 and 2.

#include <cmath>
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "slam/match_points.h"
#include "slam/scan_integration.h"
#include "slam/scan_matcher.h"
#include "tests/bench/ratio.h"
#include "tests/support/room_world.h"

namespace patrol::bench {
namespace {

constexpr double kResolution_m = 0.05;

/// Hall of 40 m by 24 m with posts.
test::RoomWorld make_hall() {
  test::RoomWorld hall;
  hall.add_box(-20.0, -12.0, 20.0, 12.0);
  for (int i = -3; i <= 3; ++i) hall.add_post(5.0 * i, 6.0, 0.4).add_post(5.0 * i, -5.0, 0.3);
  return hall;
}

std::vector<Pose2> make_poses() {
  std::vector<Pose2> poses;
  for (int i = 0; i < 20; ++i) poses.push_back({0.25 * i - 2.0, 0.1 * i - 1.0, 0.05 * i});
  return poses;
}

std::vector<LevelScan> make_scans(const std::vector<Pose2>& poses) {
  const test::RoomWorld hall = make_hall();
  const RandomStream noise(1, "bench/slam");
  std::vector<LevelScan> scans;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    scans.push_back(hall.scan(
        poses[i], Time{}, {.beams = 1440, .range_max_m = 30.0, .no_return_clearing_range_m = 6.0, .range_std_m = 0.01},
        noise, i));
  }
  return scans;
}

/// Arrays of the whole map, [row * kSize + col].
class DenseGrid {
 public:
  void add(const LevelScan& scan, const Pose2& T_map_body, int stride) {
    const Eigen::Vector2d origin = T_map_body * scan.origin_m;
    for (std::size_t i = 0; i < scan.beams.size(); ++i) {
      const Eigen::Vector2d end = T_map_body * Eigen::Vector2d(scan.beams[i].end_m.cast<double>());
      if (i % static_cast<std::size_t>(stride) == 0) add_ray(origin, end, (end - origin).norm() - 0.15, stride);
      if (scan.beams[i].is_hit) add_hit(end);
    }
  }

  /// Sum of the moments of the surfaces around a point.
  double moments(const Eigen::Vector2d& p, int radius) const {
    const int col = cell(p.x()), row = cell(p.y());
    double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
    for (int r = row - radius; r <= row + radius; ++r) {
      for (int c = col - radius; c <= col + radius; ++c) {
        const std::size_t at = index(c, r);
        if (hits_[at] == 0 || 4 * hits_[at] < passes_[at]) continue;
        const double w = hits_[at], x = mean_x_[at] - p.x(), y = mean_y_[at] - p.y();
        n += w, sx += w * x, sy += w * y, sxx += w * x * x, sxy += w * x * y, syy += w * y * y;
      }
    }
    return n + sx + sy + sxx + sxy + syy;
  }

 private:
  static constexpr int kSize = 1400;
  static int cell(double x_m) { return static_cast<int>(std::floor(x_m / kResolution_m)) + kSize / 2; }
  static std::size_t index(int col, int row) { return static_cast<std::size_t>(row * kSize + col); }

  void add_hit(const Eigen::Vector2d& p) {
    const std::size_t at = index(cell(p.x()), cell(p.y()));
    ++hits_[at];
    mean_x_[at] += (p.x() - mean_x_[at]) / hits_[at];
    mean_y_[at] += (p.y() - mean_y_[at]) / hits_[at];
  }

  void add_ray(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double free_m, int weight) {
    const Eigen::Vector2d direction = (to - from).normalized();
    int col = cell(from.x()), row = cell(from.y());
    const int step_x = direction.x() < 0.0 ? -1 : 1, step_y = direction.y() < 0.0 ? -1 : 1;
    const auto crossing = [](int index, int step, double at, double slope) {
      return (kResolution_m * (index - kSize / 2 + (step > 0 ? 1 : 0)) - at) / slope;
    };
    double next_x = crossing(col, step_x, from.x(), direction.x()),
           next_y = crossing(row, step_y, from.y(), direction.y());
    const double delta_x = kResolution_m / std::abs(direction.x()), delta_y = kResolution_m / std::abs(direction.y());
    for (double traveled = 0.0; traveled < free_m;) {
      passes_[index(col, row)] += weight;
      if (next_x < next_y) {
        traveled = next_x;
        next_x += delta_x;
        col += step_x;
      } else {
        traveled = next_y;
        next_y += delta_y;
        row += step_y;
      }
    }
  }

  std::vector<int> passes_ = std::vector<int>(kSize * kSize), hits_ = passes_;
  std::vector<double> mean_x_ = std::vector<double>(kSize * kSize), mean_y_ = mean_x_;
};

void IntegrateScanAgainstDenseGrid(benchmark::State& state) {
  const std::vector<Pose2> poses = make_poses();
  const std::vector<LevelScan> scans = make_scans(poses);
  const slam::ScanIntegrationSettings settings;
  DenseGrid dense;
  slam::GridMap map(kResolution_m, 100.0);
  Ratio ratio;
  for (auto _ : state) {
    ratio.reference([&] {
      for (std::size_t i = 0; i < scans.size(); ++i) dense.add(scans[i], poses[i], settings.free_ray_stride);
    });
    state.SetIterationTime(ratio.subject([&] {
      for (std::size_t i = 0; i < scans.size(); ++i) slam::integrate_scan(scans[i], poses[i], settings, map);
    }));
  }
  ratio.report(state);
}
BENCHMARK(IntegrateScanAgainstDenseGrid)->UseManualTime()->Unit(benchmark::kMicrosecond);

void LinearizeAgainstDenseSums(benchmark::State& state) {
  const std::vector<Pose2> poses = make_poses();
  const std::vector<LevelScan> scans = make_scans(poses);
  slam::ScanMatcherSettings settings;
  settings.max_iterations = 1;
  DenseGrid dense;
  slam::GridMap map(kResolution_m, 100.0);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    dense.add(scans[i], poses[i], 6);
    slam::integrate_scan(scans[i], poses[i], {}, map);
  }
  std::vector<std::vector<slam::MatchPoint>> points;
  for (const LevelScan& scan : scans)
    points.push_back(slam::downsample_scan(scan, settings.point_spacing_m, settings.max_points));
  Ratio ratio;
  double sum = 0.0;
  for (auto _ : state) {
    ratio.reference([&] {
      for (std::size_t i = 0; i < scans.size(); ++i) {
        for (const slam::MatchPoint& point : points[i])
          sum += dense.moments(poses[i] * point.p_body, settings.surface_radius_cells);
      }
    });
    state.SetIterationTime(ratio.subject([&] {
      for (std::size_t i = 0; i < scans.size(); ++i)
        sum += slam::match_scan(map, points[i], poses[i], std::nullopt, settings)->inlier_ratio;
    }));
    benchmark::DoNotOptimize(sum);
  }
  ratio.report(state);
}
BENCHMARK(LinearizeAgainstDenseSums)->UseManualTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace patrol::bench
