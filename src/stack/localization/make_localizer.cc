#include "stack/localization/make_localizer.h"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "stack/localization/known_map_localizer.h"
#include "stack/localization/map_then_localize.h"
#include "stack/localization/slam_localizer.h"

namespace patrol::stack {
namespace {

std::optional<Pose3> antenna_of(const RobotDescription& robot) {
  const auto frame = robot.T_body_sensor.find("uwb");
  return frame == robot.T_body_sensor.end() ? std::nullopt : std::optional(frame->second);
}

Eigen::Matrix3d map_covariance(const localize::RegistrationSettings& settings) {
  return Eigen::Vector3d(settings.map_std_m, settings.map_std_m, to_rad(settings.map_yaw_std_deg))
      .cwiseAbs2()
      .asDiagonal();
}

/// Returns the settings of the mapper with the calibration of the radio, which all users of UWB ranges have in common.
slam::MapperSettings mapper_settings(const StackSettings& settings) {
  slam::MapperSettings mapper = settings.slam;
  mapper.graph.ranges.calibration = mapper.rbpf.filter.ranges.calibration = settings.uwb_filter.calibration();
  return mapper;
}

std::string method_of(const StackSettings& settings, const LocalizerStart& start) {
  if (settings.localizer != "automatic") return settings.localizer;
  if (start.map) return "monte_carlo";
  return start.has_mapping_drive ? "slam_then_monte_carlo" : "slam";
}

}  // namespace

std::unique_ptr<Localizer> make_localizer(const StackSettings& settings, const RobotDescription& robot,
                                          const Route& site_in_map, const LocalizerStart& start, std::uint64_t seed) {
  const std::string method = method_of(settings, start);
  const auto refuse = [&](const char* why) { throw InputError(fmt::format("stack.localizer = {}: {}", method, why)); };
  const std::optional<Pose3> T_body_uwb = antenna_of(robot);
  const auto make_on_map =
      [settings = settings.localization, anchors = site_in_map.anchors, height_m = robot.body_height_m(), T_body_uwb,
       covariance = map_covariance(settings.registration), calibration = settings.uwb_filter.calibration(),
       seed](OccupancyGrid map) -> std::unique_ptr<Localizer> {
    return std::make_unique<KnownMapLocalizer>(settings, std::move(map), anchors, height_m,
                                               T_body_uwb.value_or(Pose3{}), covariance, seed, calibration);
  };
  if (method == "monte_carlo") {
    if (!start.map) refuse("requires a map: set the key map, or select slam or slam_then_monte_carlo");
    return make_on_map(*start.map);
  }
  if (start.map) refuse("would replace the given map: remove the key map, or select monte_carlo");
  auto slam = std::make_unique<SlamLocalizer>(slam::make_mapper(mapper_settings(settings), start.neighbor_model, seed),
                                              site_in_map.anchors, T_body_uwb, map_covariance(settings.registration));
  if (method == "slam") return slam;
  if (!start.has_mapping_drive) refuse("requires a teleoperated mapping drive: select slam");
  return std::make_unique<MapThenLocalize>(std::move(slam), site_in_map.anchors, make_on_map,
                                           settings.uwb_filter.calibration());
}

}  // namespace patrol::stack
