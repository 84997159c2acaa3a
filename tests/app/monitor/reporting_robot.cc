/// A robot that only reports, for tests of the platform: the class that `patrol run --monitor-url` uses, with made-up
/// messages. One of the tunnel scans the lining and sounds for water, any other measures gas.
///
/// usage: reporting_robot URL TOKEN_FILE DIRECTORY ROBOT WORLD SECONDS RESULTS_PER_S
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "app/monitor/reporter.h"

namespace patrol {
namespace {

constexpr double kLength_m = 60.0, kHalfWidth_m = 4.0;

OccupancyGrid street_map(double seen_m) {
  const GridGeometry geometry{.resolution_m = 0.1, .width = 700, .height = 120, .origin_m = {-5.0, -6.0}};
  OccupancyGrid map(geometry, kUnknown);
  for (int row = 0; row < geometry.height; ++row) {
    for (int col = 0; col < geometry.width; ++col) {
      const Eigen::Vector2d p = geometry.center_of({col, row});
      const double bend_m = 1.5 * std::sin(p.x() / 15.0), away_m = std::abs(p.y() - bend_m);
      if (p.x() > seen_m || p.x() < -4.0) continue;
      if (away_m < kHalfWidth_m) map.at({col, row}) = kFree;
      else if (away_m < kHalfWidth_m + 0.2) map.at({col, row}) = kOccupied;
    }
  }
  return map;
}

Pose2 place_at(double along_m) { return {along_m, 1.5 * std::sin(along_m / 15.0), 0.1 * std::cos(along_m / 15.0)}; }

LiningResult lining_at(Time stamp, const std::string& station, int first_ring, double pushed_mm) {
  LiningResult result;
  result.stamp = stamp;
  result.station = station;
  result.is_registered = true;
  result.registration_rms_m = 0.0021;
  result.registration_inlier_ratio = 0.93;
  result.correction_m = 0.034;
  for (int ring = first_ring; ring < first_ring + 12; ++ring) {
    for (int i = 0; i < 36; ++i) {
      const double clock_deg = 10.0 * i + 5.0, away_deg = std::abs(std::remainder(clock_deg - 60.0, 360.0));
      if (clock_deg > 130.0 && clock_deg < 230.0) continue;
      const double push_mm = ring == first_ring + 5 ? pushed_mm * std::exp(-0.5 * std::pow(away_deg / 40.0, 2)) : 0.0;
      result.cells.push_back({.ring = ring,
                              .clock_deg = clock_deg,
                              .inward_m = 1e-3 * (push_mm + 0.4 * std::sin(7.0 * ring + 3.0 * i)),
                              .std_m = 0.0004,
                              .points = 800});
    }
    result.lines.push_back({.ring = ring,
                            .name = "9-3",
                            .change_m = ring == first_ring + 5 ? -1e-3 * pushed_mm : 2e-4 * std::cos(ring),
                            .std_m = 0.0005});
    result.lines.push_back({.ring = ring,
                            .name = "12-3",
                            .change_m = ring == first_ring + 5 ? -6e-4 * pushed_mm : 1e-4 * std::sin(ring),
                            .std_m = 0.0005});
  }
  if (pushed_mm >= 3.0) {
    const WarningLevel level = pushed_mm >= 10.0  ? WarningLevel::kAlarm
                               : pushed_mm >= 5.0 ? WarningLevel::kWarning
                                                  : WarningLevel::kNotice;
    const Pose2 at = place_at(1.5 * (first_ring + 5));
    result.findings.push_back({.ring = first_ring + 5,
                               .clock_deg = 60.0,
                               .inward_m = 1e-3 * pushed_mm,
                               .std_m = 0.0004,
                               .level = level,
                               .p_map = {at.x, at.y - kHalfWidth_m, 3.0}});
  }
  return result;
}

WaterResult water_at(Time stamp) {
  WaterResult result{.stamp = stamp,
                     .station = "sounding_1",
                     .T_map_body = place_at(kLength_m),
                     .soundings = 35,
                     .antenna_error_deg = 0.12,
                     .rock_spm = 0.002,
                     .evidence = 41.5,
                     .is_found = true,
                     .level = WarningLevel::kWarning,
                     .p_map = {kLength_m + 14.0, 3.0, 2.0}};
  result.covariance_m2.diagonal() << 0.6, 0.35, 0.4;
  result.distance_m = 14.6;
  result.distance_low_m = 13.1;
  result.distance_high_m = 16.2;
  result.azimuth_deg = 12.0;
  result.elevation_deg = 5.0;
  result.radius_m = 3.1;
  result.radius_low_m = 2.4;
  result.radius_high_m = 3.9;
  return result;
}

std::string name_of_station(bool is_tunnel, int number) {
  return fmt::format("{}_{}", is_tunnel ? "station" : "valve_well", number);
}

Event event_at(Time stamp, EventKind kind, const std::string& subject, const std::string& text, double value,
               const Pose2& at) {
  return {.stamp = stamp,
          .kind = kind,
          .subject = subject,
          .text = text,
          .value = value,
          .T_map_body = at,
          .p_map_target = at.position() + Eigen::Vector2d(0.5, 2.5)};
}

app::ScenarioFiles survey(bool is_tunnel) {
  app::ScenarioFiles files;
  for (int i = 1; i <= 4; ++i) {
    Station& station = files.route.stations.emplace_back();
    station.name = name_of_station(is_tunnel, i);
    station.type = StationType::kInspect;
    station.T_route_body = place_at(kLength_m / 4.0 * i);
  }
  return files;
}

/// What happens between two instants, in the robot's own seconds.
class Drive {
 public:
  Drive(app::Reporter& reporter, bool is_tunnel, double seconds, unsigned variant)
      : reporter_(reporter), is_tunnel_(is_tunnel), seconds_(seconds), variant_(variant) {}

  void go_to(double now_s) {
    const Time stamp = from_seconds(now_s);
    const double along_m = kLength_m * std::min(1.0, now_s / seconds_);
    reporter_.on_message(stack::StackMessage(PoseEstimate{.stamp = stamp, .T_map_body = place_at(along_m)}));
    reporter_.on_message(stack::StackMessage(MapUpdate{.stamp = stamp, .map = street_map(along_m + 8.0)}));
    while (stations_ < 4 && along_m >= kLength_m / 4.0 * (stations_ + 1)) arrive(stamp, ++stations_, place_at(along_m));
  }

 private:
  void arrive(Time stamp, int number, const Pose2& at) {
    const std::string name = name_of_station(is_tunnel_, number);
    reporter_.on_message(
        stack::StackMessage(event_at(stamp, EventKind::kStationReached, name, fmt::format("At {}.", name), 0.0, at)));
    if (is_tunnel_) {
      reporter_.on_message(
          stack::StackMessage(lining_at(stamp, name, 1 + 12 * (number - 1), 1.5 * number + 0.9 * (variant_ % 8))));
      if (number == 4) reporter_.on_message(stack::StackMessage(water_at(stamp)));
      return;
    }
    const double column = number == 3 ? 640.0 + 10.0 * variant_ : 4.0 + number + variant_ % 5;
    reporter_.on_message(stack::StackMessage(event_at(
        stamp, EventKind::kGasMeasured, name, fmt::format("{}: {:.0f} ppm m of methane.", name, column), column, at)));
    if (column > 200.0)
      reporter_.on_message(
          stack::StackMessage(event_at(stamp, EventKind::kGasAlarm, name,
                                       fmt::format("Leak at {}: {:.0f} ppm m of methane.", name, column), column, at)));
  }

  app::Reporter& reporter_;
  bool is_tunnel_;
  double seconds_;
  unsigned variant_;
  int stations_ = 0;
};

int report(const std::string& url, const std::string& token, const std::filesystem::path& root,
           const std::string& robot, const std::string& world, double seconds, double rate_hz) {
  const bool is_tunnel = world == "tunnel";
  const auto variant = static_cast<unsigned>(std::hash<std::string>()(robot + root.string()) % 97);
  std::filesystem::create_directories(root);
  app::Reporter reporter(
      root, {.robot = robot, .run = app::new_run_name("made_up", variant), .world = world, .scenario = "made_up"},
      app::make_monitor_server(url, token),
      {.pose_period_s = 0.0, .map_period_s = seconds / 4.0, .drain_timeout_s = 60.0});
  reporter.begin(survey(is_tunnel));
  Drive drive(reporter, is_tunnel, seconds, variant);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i <= static_cast<int>(seconds * rate_hz); ++i) {
    std::this_thread::sleep_until(start + std::chrono::duration<double>(i / rate_hz));
    drive.go_to(i / rate_hz);
  }
  reporter.finish("finished", "");
  fmt::print("{} results, {} wait, {} refused\n", reporter.num_results(), reporter.num_pending(),
             reporter.num_rejected());
  return reporter.num_pending() == 0 && reporter.num_rejected() == 0 ? 0 : 1;
}

}  // namespace
}  // namespace patrol

int main(int argc, char** argv) {
  if (argc != 8) return 2;
  return patrol::report(argv[1], argv[2], argv[3], argv[4], argv[5], std::atof(argv[6]), std::atof(argv[7]));
}
