#include "app/study/scan_world.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "app/scenario/data_folders.h"
#include "app/scenario/scenario.h"
#include "io/files/atomic_file.h"
#include "sim/sensors/panoramic_scanner.h"
#include "sim/sensors/uwb.h"
#include "sim/static_obstacles.h"

namespace patrol::app {
namespace {

/// Adds a standing person of capsules.
void add_person(mjsBody& world, const Eigen::Vector2d& p_m, double ground_m) {
  const auto capsule = [&](double x, double y, double low, double high, double radius) {
    mjsGeom* geom = mjs_addGeom(&world, nullptr);
    geom->type = mjGEOM_CAPSULE;
    geom->pos[0] = p_m.x() + x;
    geom->pos[1] = p_m.y() + y;
    geom->pos[2] = ground_m + 0.5 * (low + high);
    geom->size[0] = radius;
    geom->size[1] = 0.5 * (high - low) - radius;
    geom->group = 0;
    geom->contype = geom->conaffinity = 0;
    const float gray[4] = {0.4f, 0.4f, 0.4f, 1.0f};
    std::copy_n(gray, 4, geom->rgba);
  };
  for (const double side : {-0.11, 0.11}) capsule(0.0, side, 0.0, 0.9, 0.08);
  for (const double side : {-0.25, 0.25}) capsule(0.0, side, 0.75, 1.42, 0.05);
  capsule(0.0, 0.0, 0.8, 1.5, 0.17);
  capsule(0.0, 0.0, 1.45, 1.78, 0.1);
}

}  // namespace

std::string world_xml(const ScannedWorld& world) {
  return load_site(world.name, find_data_root("")).world_xml.string();
}

RayWorld::RayWorld(const std::string& xml, const ScannedWorld* guests) {
  const sim::SpecPtr spec = sim::load_spec(xml);
  if (guests != nullptr) {
    sim::add_static_obstacles(
        *spec,
        {{.kind = "truck", .x_m = guests->truck_m.x(), .y_m = guests->truck_m.y(), .yaw_deg = guests->truck_yaw_deg}});
    add_person(*mjs_findBody(spec.get(), "world"), guests->person_m, 0.0);
  }
  model_ = sim::compile(*spec, xml);
  scene_ = std::make_unique<sim::LidarScene>(*model_);
}

double RayWorld::ground_m(const Eigen::Vector2d& p_m, double from_m) const {
  const auto hit = scene_->cast({p_m.x(), p_m.y(), from_m}, -Eigen::Vector3d::UnitZ(), 10.0, sim::kRayScenery);
  return hit ? from_m - hit->distance_m : std::numeric_limits<double>::quiet_NaN();
}

std::vector<io::StationScan> take_scans(const ScannedWorld& world, std::uint64_t seed) {
  const RayWorld empty(world_xml(world)), busy(world_xml(world), &world);
  PanoramicScannerSettings settings;
  settings.enabled = true;
  settings.step_deg = world.step_deg;
  settings.elevation_min_deg = world.elevation_min_deg;
  std::vector<io::StationScan> scans;
  for (std::size_t i = 0; i < world.scanners_m.size(); ++i) {
    const RayWorld& rays = i == world.guest_scan ? busy : empty;
    const Eigen::Vector2d& p = world.scanners_m[i];
    const Pose3 T_world_scanner{{p.x(), p.y(), rays.ground_m(p) + kScannerHeight_m},
                                quaternion_from_yaw(0.3 * static_cast<double>(i))};
    // A stream of its own for each scan.
    sim::PanoramicScanner scanner(settings, rays.scene(), Pose3{}, 1000 * seed + i);
    scanner.begin(Time{}, T_world_scanner);
    scanner.advance(Time{}, from_seconds(settings.duration_s + 1.0), T_world_scanner, T_world_scanner);
    io::StationScan scan{.station = fmt::format("station_{}", i + 1), .T_map_scanner = T_world_scanner, .points = {}};
    for (PanoramicScan& taken : scanner.take_scans()) scan.points = std::move(taken.points);
    for (ScannerPoint& point : scan.points) {
      const Eigen::Vector3f moved =
          (T_world_scanner * Eigen::Vector3f(point.x, point.y, point.z).cast<double>()).cast<float>();
      point = {moved.x(), moved.y(), moved.z(), point.intensity};
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

std::size_t save_scans(const ScannedWorld& world, std::uint64_t seed, const std::filesystem::path& folder) {
  const std::vector<io::StationScan> scans = take_scans(world, seed);
  io::save_station_scans(folder, scans);
  std::size_t num_points = 0;
  for (const io::StationScan& scan : scans) num_points += scan.points.size();
  return num_points;
}

void add_anchors(const ScannedWorld& world, const std::filesystem::path& site_xml) {
  const std::string file = world_xml(world), end = "</worldbody>";
  const sim::SpecPtr spec = sim::load_spec(file);
  const sim::ModelPtr model = sim::compile(*spec, file);
  std::string anchors;
  for (const sim::UwbAnchor& anchor : sim::uwb_anchors(*model)) {
    const Eigen::Vector3d& p = anchor.p_world;
    anchors += fmt::format("  <site name=\"{}{}\" pos=\"{} {} {}\"/>\n  ", sim::kUwbAnchor, anchor.number, p.x(), p.y(),
                           p.z());
  }
  std::string mjcf = io::load_text(site_xml);
  mjcf.insert(mjcf.rfind(end), anchors);
  io::save_text(site_xml, mjcf);
}

}  // namespace patrol::app
