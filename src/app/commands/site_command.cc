#include <fmt/format.h>

#include "app/check/site_surfaces.h"
#include "app/commands/commands.h"
#include "app/scenario/data_folders.h"
#include "app/scenario/scenario.h"
#include "core/text.h"

namespace patrol::app {
namespace {

std::string table_of(const SiteSurfaces& surfaces) {
  std::string text = fmt::format("  {:<12}{:>7}{:>9}  {}\n", "", "geoms", "lidar", "first");
  for (const auto& row : kSurfaceKinds) {
    const SurfaceGroup& group = surfaces.of(row.value);
    if (group.num_geoms == 0) continue;
    text +=
        fmt::format("  {:<12}{:>7}{:>9}  {}\n", row.name, group.num_geoms, group.num_lidar, join(group.examples, ", "));
  }
  const Eigen::Vector3d size = surfaces.upper_m - surfaces.lower_m;
  return text + fmt::format("\nSurfaces with contact: {:.1f} x {:.1f} x {:.1f} m\n", size.x(), size.y(), size.z());
}

io::Metrics json_of(const SiteSurfaces& surfaces) {
  io::Metrics json = io::Metrics::object();
  for (const auto& row : kSurfaceKinds) {
    const SurfaceGroup& group = surfaces.of(row.value);
    json[std::string(row.name)] = {
        {"geoms", group.num_geoms}, {"lidar", group.num_lidar}, {"examples", group.examples}};
  }
  for (const auto& [key, corner] : {std::pair("lower_m", surfaces.lower_m), std::pair("upper_m", surfaces.upper_m)})
    json[key] = {corner.x(), corner.y(), corner.z()};
  return json;
}

}  // namespace

ExitCode site_command(const SiteOptions& options) {
  const LoadedSite site = load_site(options.world, find_data_root({}));
  const sim::ModelPtr model = sim::compile(*sim::load_spec(site.world_xml.string()), site.world_xml.string());
  const SiteSurfaces surfaces = site_surfaces(*model, site.settings.ground);
  const std::string title = fmt::format("{}: {}\n\n", options.world, site.world_xml.string());
  print_result(options.form, title + table_of(surfaces), json_of(surfaces));
  return ExitCode::kDone;
}

}  // namespace patrol::app
