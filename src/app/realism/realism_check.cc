#include "app/realism/realism_check.h"

#include <fmt/format.h>

#include "app/common/progress_bar.h"
#include "core/geometry/angles.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::app {
namespace {

/// Progress of positioning in the terminal; stops on an interrupt.
auto progress(const std::string& name, const InterruptGuard& guard, ProgressBar& bar) {
  return [&guard, &bar, name](std::size_t done, std::size_t total) {
    bar.show(fmt::format("{}  {} of {} scans", name, done, total),
             static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, total)));
    return !guard.is_interrupted();
  };
}

}  // namespace

RealismSettings realism_settings(const LogOnSiteOptions& options, std::vector<std::string> overrides,
                                 bool skip_invalid) {
  if (skip_invalid) overrides.emplace_back("input.log.skip_invalid=true");
  RealismSettings settings;
  settings.positions.align = !is_path_exact(options);
  io::SettingsReader::read_section({"--set", overrides}, io::parse_overrides(overrides), "", settings);
  return settings;
}

std::optional<RealismInput> read_realism_input(const LogOnSiteOptions& options, const RealismSettings& settings) {
  LogOnSite source = find_log_on_site(options, settings.input);
  realism::Site site(source.world_xml);
  std::optional<ScansOnPath> scans = read_scans_on_path(source, settings.input);
  if (!scans) return std::nullopt;
  return RealismInput{.source = std::move(source), .scans = std::move(*scans), .site = std::move(site)};
}

std::vector<std::pair<std::string, std::string>> facts_of(const RealismInput& input, const RealismSettings& settings) {
  const LaserScan& scan = input.scans.scans.front().scan;
  return {
      {"log", input.source.log.filename().string()},
      {"site", input.source.world_xml.filename().string()},
      {"path", input.source.path_name},
      {"scans", fmt::format("{} of {}", input.scans.scans.size(), input.scans.num_read)},
      {"beams", fmt::format("{} over {:.0f}°", scan.ranges_m.size(),
                            std::abs(to_deg(scan.angle_increment_rad)) * static_cast<double>(scan.ranges_m.size()))},
      {"height of the lidar",
       fmt::format("{:.2f} m{}", input.scans.lidar_height_m, input.scans.is_height_assumed ? " (assumed)" : "")},
      {"simulated lidar", input.source.lidar_name},
      {"alignment of the scans", settings.positions.align ? "on" : "off"},
      {"seed", std::to_string(settings.seed)},
      {"patrol", PATROL_VERSION}};
}

std::vector<std::string> notes_of(const RealismInput& input, const RealismSettings& settings,
                                  const RealismResult& result) {
  const realism::BeamRules& rules = settings.positions.rules;
  std::vector<std::string> notes = {fmt::format(
      "A residual is the recorded range minus the range that a beam without errors has in the site, from the pose of "
      "its "
      "own instant. Static surfaces: smooth surfaces of the site whose return is within {:g} m. Returns farther off, "
      "like their neighbors, are moving or unmapped objects and are excluded: {:.1f} % of all beams.",
      rules.max_residual_m,
      100.0 * static_cast<double>(count_of(result.recorded.set.beams, realism::BeamClass::kMoving)) /
          std::max<double>(1.0, static_cast<double>(result.recorded.set.beams.size())))};
  notes.push_back(
      "The residuals contain the errors of the site. A site that was made from a map with cells of 5 cm has surfaces "
      "that are off by 1 to 3 cm even where nothing has changed; a fitted noise includes them.");
  if (settings.positions.align) {
    notes.push_back(fmt::format(
        "Each scan is aligned to the site (x, y, yaw), recorded and simulated ones alike, so that errors of the path "
        "are "
        "not counted as errors of the lidar. The alignment also removes {:.0f} % of a constant range error of all "
        "beams (mean over the scans, computed from their surfaces); the rest stays in the residuals. It removes a "
        "constant error of the azimuth completely.",
        100.0 * result.recorded.set.absorbed_bias));
  } else {
    notes.push_back("The scans are not aligned to the site: errors of the path are counted as errors of the lidar.");
  }
  if (input.scans.is_height_assumed)
    notes.push_back(fmt::format("The log has no height of the lidar: {:.1f} m is assumed (input.lidar_height_m).",
                                input.scans.lidar_height_m));
  return notes;
}

std::optional<realism::PositionedScans> position(const RealismInput& input, const RealismSettings& settings,
                                                 const std::string& name) {
  const InterruptGuard guard;
  ProgressBar bar;
  realism::PositionedScans scans =
      position_scans(input.site, input.scans.scans, settings.positions, progress(name + ", recorded", guard, bar));
  if (guard.is_interrupted()) return std::nullopt;
  return scans;
}

std::optional<RealismResult> compare(const RealismInput& input, const RealismSettings& settings,
                                     const realism::LidarDevice& device, const std::string& name) {
  std::optional<realism::PositionedScans> recorded = position(input, settings, name);
  if (!recorded) return std::nullopt;
  const InterruptGuard guard;
  ProgressBar bar;
  realism::PositionedScans simulated = simulate_like(input.site, *recorded, device, settings.positions, settings.seed,
                                                     progress(name + ", simulated", guard, bar));
  if (guard.is_interrupted()) return std::nullopt;
  return RealismResult{.recorded = std::move(*recorded), .simulated = std::move(simulated)};
}

}  // namespace patrol::app
