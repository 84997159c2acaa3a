#include "importer/site/imported_site.h"

#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "importer/output_folder.h"
#include "importer/site/compiled_site.h"
#include "importer/site/site_mjcf.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"
#include "io/json/registration_json.h"
#include "io/json/route_json.h"
#include "io/maps/map_server.h"
#include "io/yaml/settings_yaml.h"
#include "sim/mujoco.h"

namespace patrol::importer {
namespace {

void write_shape_files(const ImportedSite& site, const std::filesystem::path& folder) {
  for (const SiteShape& shape : site.shapes) {
    if (shape.type != SiteShapeType::kMesh && shape.type != SiteShapeType::kHeightField) continue;
    std::filesystem::create_directories(folder / "meshes");
    io::save_text(folder / shape_file(shape), shape_content(shape));
  }
  for (const SiteFile& file : site.files) {
    std::filesystem::create_directories((folder / file.path).parent_path());
    io::save_text(folder / file.path, file.content);
  }
}

/// Registration of a plan that is drawn in site: exact, with the covariance of a micrometer and a microradian.
SiteRegistration identity_registration() {
  SiteRegistration registration;
  registration.covariance = 1e-12 * Eigen::Matrix3d::Identity();
  return registration;
}

/// Writes the MJCF and the files that it names.
void write_model(const ImportedSite& site, const std::filesystem::path& folder) {
  io::save_text(folder / (site.name + ".xml"), site.mjcf.empty() ? to_mjcf(site) : site.mjcf);
  write_shape_files(site, folder);
}

sim::ModelPtr compile_in(const ImportedSite& site, const std::filesystem::path& folder) {
  try {
    return sim::compile(*sim::load_spec((folder / (site.name + ".xml")).string()), site.name + ".xml");
  } catch (const InputError& refused) {
    throw InputError(fmt::format("{}: MuJoCo refuses the site: {}", site.source, io::on_one_line(refused.what())));
  }
}

/// Compiles a site whose files are in a folder, and checks its coordinates.
sim::ModelPtr checked_model(const ImportedSite& site, const std::filesystem::path& folder) {
  sim::ModelPtr model = compile_in(site, folder);
  check_coordinates(*model, site.source);
  return model;
}

/// Text as a YAML scalar, quoted where YAML needs it.
std::string yaml_text(const std::string& text) {
  YAML::Emitter out;
  out << text;
  return out.c_str();
}

void write_mission(const ImportedSite& site, const std::filesystem::path& folder) {
  if (!site.route) return;
  std::filesystem::create_directories(folder / "routes");
  std::filesystem::create_directories(folder / "scenarios");
  io::save_text(folder / "routes" / "patrol.json", io::to_json_text(*site.route, site.T_site_start));
  io::save_text(
      folder / "scenarios" / "patrol.yaml",
      fmt::format("# Patrol of {} stations, made by patrol import site from {}.\nworld: {}\nrobot: {}\n"
                  "mission: routes/patrol.json\n{}stack:\n  mission_type: gas  # stations of the mission file\n{}"
                  "expect:\n  mission.completed: true\n  mission.collisions: {{max: 0}}\n",
                  site.route->stations.size(), site.source_name(), yaml_text(site.name), yaml_text(site.robot),
                  site.scenario_keys, site.stack_keys));
}

void check(const ImportedSite& site) {
  std::set<std::string> materials, shapes;
  for (const SiteMaterial& material : site.materials) {
    if (!materials.insert(material.name).second) throw std::invalid_argument("site: material twice: " + material.name);
  }
  for (const SiteShape& shape : site.shapes) {
    if (!shapes.insert(shape.name).second) throw std::invalid_argument("site: shape twice: " + shape.name);
    if (!materials.contains(shape.material)) throw std::invalid_argument("site: no material of " + shape.name);
  }
  if (site.shapes.empty() && site.mjcf.empty()) throw InputError(site.source + ": has no shapes");
}

}  // namespace

std::string far_text(double coordinate_m) {
  return fmt::format("coordinates up to {:.3g} m: must be at most {:g} m: move the origin of the file near the site",
                     coordinate_m, kMaxCoordinate_m);
}

void use_height_fields_as_ground(ImportedSite& site) {
  for (const SiteShape& shape : site.shapes) {
    const bool has_contact = shape.use == ShapeUse::kSolid || shape.use == ShapeUse::kContactOnly;
    if (shape.type == SiteShapeType::kHeightField && has_contact) site.ground.all.geoms.push_back(shape.name);
  }
}

std::optional<std::vector<Assumption>> write_site(const ImportedSite& site, const std::filesystem::path& folder,
                                                  const std::function<bool()>& is_interrupted) {
  require_folder_name(site.name, site.source, "site");
  check(site);
  OutputFolder output(folder);
  write_model(site, output.staging());
  io::save_settings(output.staging() / (site.name + ".yaml"), sim::SiteSettings{.ground = site.ground},
                    "Settings of the site (src/sim/site_settings.h)");
  if (site.map) {
    std::filesystem::create_directories(output.staging() / "map");
    io::save_map(output.staging() / "map" / "map.yaml", *site.map);
    io::save_registration(output.staging() / "map" / "registration.json", identity_registration());
  }
  write_mission(site, output.staging());
  const auto must_stop = [&] { return is_interrupted && is_interrupted(); };
  if (must_stop()) return std::nullopt;
  std::vector<Assumption> rows = site.assumptions;
  for (Assumption& row : rows_of_compiled(*checked_model(site, output.staging()), site)) rows.push_back(std::move(row));
  io::save_text(output.staging() / "README.md", report_of(site, rows));
  if (must_stop()) return std::nullopt;
  output.publish();
  return rows;
}

sim::ModelPtr compile_site(const ImportedSite& site) {
  require_folder_name(site.name, site.source, "site");
  check(site);
  const OutputFolder output(std::filesystem::temp_directory_path() / ("site_" + site.name));
  write_model(site, output.staging());
  return checked_model(site, output.staging());
}

std::string ImportedSite::source_name() const {
  return io::on_one_line(std::filesystem::path(source).filename().string());
}

std::string report_of(const ImportedSite& site, const std::vector<Assumption>& assumptions) {
  std::size_t triangles = 0, solid = 0;
  for (const SiteShape& shape : site.shapes) {
    triangles += shape.mesh.triangles.size();
    if (shape.use == ShapeUse::kSolid || shape.use == ShapeUse::kContactOnly) ++solid;
  }
  const std::string content = site.mjcf.empty() ? fmt::format("{} shapes, {} of them with contact, {} triangles",
                                                              site.shapes.size(), solid, triangles)
                                                : fmt::format("a MuJoCo model with {} files", site.files.size());
  return fmt::format(
             "# {}\n\nMade by `patrol import site` from `{}`: {}. `patrol site {}` reports the ground and the "
             "obstacles.\n\n## Assumptions\n\n",
             io::on_one_line(site.name), site.source_name(), content, site.name) +
         to_markdown(assumptions, "None: the file determines the site.\n");
}

}  // namespace patrol::importer
