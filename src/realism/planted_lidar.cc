#include "realism/planted_lidar.h"

#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "core/random.h"
#include "realism/expected_scan.h"
#include "realism/scan_alignment.h"
#include "realism/scan_positions.h"

namespace patrol::realism {
namespace {

/// Box from corner to corner, 2.5 m high, with a gray of the given reflectivity.
std::string wall(double x0_m, double y0_m, double x1_m, double y1_m, double reflectivity) {
  return fmt::format("<geom type=\"box\" pos=\"{} {} 1.25\" size=\"{} {} 1.25\" rgba=\"{r} {r} {r} 1\"/>\n",
                     0.5 * (x0_m + x1_m), 0.5 * (y0_m + y1_m), 0.5 * (x1_m - x0_m), 0.5 * (y1_m - y0_m),
                     fmt::arg("r", reflectivity));
}

std::string outer_walls() {
  return wall(-0.2, -0.2, 26.2, 0.0, 0.5) + wall(-0.2, 16.0, 26.2, 16.2, 0.5) + wall(-0.2, 0.0, 0.0, 16.0, 0.4) +
         wall(26.0, 0.0, 26.2, 16.0, 0.6);
}

std::string inner_walls() {
  std::string geoms = wall(0.0, 8.0, 6.0, 8.2, 0.5) + wall(7.0, 8.0, 13.0, 8.2, 0.8) + wall(14.2, 8.0, 20.0, 8.2, 0.3) +
                      wall(21.0, 8.0, 26.0, 8.2, 0.5) + wall(9.0, 0.0, 9.2, 3.0, 0.5) + wall(9.0, 4.0, 9.2, 8.0, 0.6) +
                      wall(17.0, 0.0, 17.2, 5.0, 0.3) + wall(17.0, 6.0, 17.2, 8.0, 0.5);
  // Posts and boxes: edges with jumps of 0.2 to 1.2 m to the wall behind.
  for (int k = 0; k < 10; ++k) geoms += wall(1.5 + 2.4 * k, 15.3 - 0.05 * k, 1.8 + 2.4 * k, 15.6 - 0.05 * k, 0.5);
  for (int k = 0; k < 8; ++k) geoms += wall(1.0 + 3.1 * k, 0.4 + 0.08 * k, 1.6 + 3.1 * k, 0.7 + 0.08 * k, 0.6);
  // Dark and bright panels on the walls.
  for (int k = 0; k < 6; ++k) geoms += wall(3.0 + 4.0 * k, 15.95, 4.5 + 4.0 * k, 16.0, k % 2 == 0 ? 0.04 : 0.10);
  for (int k = 0; k < 6; ++k) geoms += wall(2.0 + 4.0 * k, 0.0, 3.0 + 4.0 * k, 0.05, k % 2 == 0 ? 0.06 : 0.8);
  for (int k = 0; k < 3; ++k) geoms += wall(0.0, 1.0 + 5.0 * k, 0.05, 3.0 + 5.0 * k, 0.05);
  for (int k = 0; k < 3; ++k) geoms += wall(25.95, 1.0 + 5.0 * k, 26.0, 3.0 + 5.0 * k, k == 1 ? 0.8 : 0.05);
  return geoms;
}

/// Rectangles without obstacles: x0, y0, x1, y1.
constexpr std::array<std::array<double, 4>, 5> kFree = {{{1.0, 2.0, 8.0, 7.0},
                                                         {10.0, 2.0, 16.0, 7.0},
                                                         {18.0, 2.0, 25.0, 7.0},
                                                         {1.0, 9.2, 13.0, 14.0},
                                                         {13.0, 9.2, 25.0, 14.0}}};

Pose3 draw_pose(const RandomStream& random, std::uint64_t scan) {
  const auto& [x0, y0, x1, y1] = kFree[scan % kFree.size()];
  return to_pose3({x0 + (x1 - x0) * random.uniform(scan, 0), y0 + (y1 - y0) * random.uniform(scan, 1),
                   2.0 * std::numbers::pi * random.uniform(scan, 2)},
                  0.5);
}

/// Draws within limits: uniform, or uniform in the logarithm.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed, "planted/lidar") {}
  double uniform(double low, double high) { return low + (high - low) * random_.uniform(0, next_++); }
  double by_ratio(double low, double high) { return low * std::pow(high / low, random_.uniform(0, next_++)); }

 private:
  RandomStream random_;
  std::uint64_t next_ = 0;
};

LidarDevice draw_device(std::uint64_t seed) {
  Draw draw(seed);
  LidarDevice device;
  LidarSettings& lidar = device.settings;
  lidar.range_noise_std_m = draw.by_ratio(0.004, 0.04);
  lidar.range_quantization_m = draw.by_ratio(0.0005, 0.02);
  lidar.angle_noise_std_deg = draw.by_ratio(0.02, 0.25);
  lidar.beam_width_deg = draw.uniform(0.1, 1.5);
  lidar.dropout_probability = draw.by_ratio(0.002, 0.08);
  lidar.max_incidence_deg = draw.uniform(65.0, 86.0);
  lidar.max_range_10pct_m = draw.uniform(4.0, 14.0);
  lidar.false_return_rate_per_m = draw.by_ratio(0.001, 0.02);
  device.errors.range_offset_m = draw.uniform(-0.05, 0.05);
  device.errors.range_scale = draw.uniform(-0.004, 0.004);
  device.errors.incidence_m = draw.uniform(-0.03, 0.03);
  device.errors.reflectivity_m = draw.uniform(-0.02, 0.02);
  lidar.wide_noise_probability = draw.by_ratio(0.03, 0.3);
  lidar.wide_noise_std_m = lidar.range_noise_std_m * draw.uniform(2.5, 5.0);
  return device;
}

std::vector<std::pair<std::string, double>> values_of(const LidarDevice& device) {
  const LidarSettings& lidar = device.settings;
  return {{"range_noise_std_m", lidar.range_noise_std_m},
          {"wide_noise_probability", lidar.wide_noise_probability},
          {"wide_noise_std_m", lidar.wide_noise_std_m},
          {"range_quantization_m", lidar.range_quantization_m},
          {"angle_noise_std_deg", lidar.angle_noise_std_deg},
          {"beam_width_deg", lidar.beam_width_deg},
          {"dropout_probability", lidar.dropout_probability},
          {"max_incidence_deg", lidar.max_incidence_deg},
          {"max_range_10pct_m", lidar.max_range_10pct_m},
          {"false_return_rate_per_m", lidar.false_return_rate_per_m},
          {"measured_range_offset_m", device.errors.range_offset_m},
          {"measured_range_scale", device.errors.range_scale},
          {"measured_incidence_m", device.errors.incidence_m},
          {"measured_reflectivity_m", device.errors.reflectivity_m}};
}

LaserScan empty_scan(int beams) {
  LaserScan scan;
  scan.angle_min_rad = -std::numbers::pi;
  scan.angle_increment_rad = 2.0 * std::numbers::pi / beams;
  scan.scan_time_s = 0.1;
  scan.range_min_m = 0.1;
  scan.range_max_m = 30.0;
  scan.ranges_m.resize(static_cast<std::size_t>(beams));
  return scan;
}

}  // namespace

Site planted_site(bool is_plain_room) {
  const std::string geoms = outer_walls() + (is_plain_room ? "" : inner_walls());
  const sim::SpecPtr spec =
      sim::parse_spec("<mujoco><default><geom group=\"0\"/></default><worldbody>\n" + geoms + "</worldbody></mujoco>");
  return Site(sim::compile(*spec, "planted site"));
}

PlantedTrial run_planted_trial(const Site& site, const PlantedTrialSettings& settings, std::uint64_t seed) {
  PlantedTrial trial;
  trial.planted = draw_device(seed);
  trial.values = values_of(trial.planted);
  const RandomStream poses(seed, "planted/pose"), errors(seed, "planted/path");
  std::vector<PosedScan> scans;
  for (int k = 0; k < settings.scans; ++k)
    scans.push_back(
        {.scan = empty_scan(settings.beams), .T_site_lidar = {draw_pose(poses, static_cast<std::uint64_t>(k))}});
  const std::vector<std::vector<float>> ranges_m = simulate_scans(site, trial.planted, scans, seed);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    scans[k].scan.ranges_m = ranges_m[k];
    const Eigen::Vector3d error(settings.path_std_m * errors.normal(k, 0), settings.path_std_m * errors.normal(k, 1),
                                settings.path_yaw_std_deg * kDegree * errors.normal(k, 2));
    scans[k] = corrected(scans[k], error);
  }
  PositionSettings positions;
  positions.align = settings.path_std_m > 0.0 || settings.path_yaw_std_deg > 0.0;
  LidarFitSettings fit;
  if (positions.align) fit.path_yaw_std_deg = 0.05, fit.path_std_m = 0.005;
  LidarDevice base;
  base.settings = LidarSettings::of_preset("rplidar_s2");
  trial.fit = fit_lidar(site, position_scans(site, scans, positions).set, base, fit);
  return trial;
}

}  // namespace patrol::realism
