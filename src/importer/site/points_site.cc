#include "importer/site/points_site.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "importer/site/points/cloud_patches.h"
#include "importer/site/points/contact_boxes.h"
#include "importer/site/points/filled_ground.h"
#include "importer/site/points/intensity_scale.h"
#include "importer/site/points/panorama.h"
#include "importer/site/points/panorama_patches.h"
#include "importer/site/points/scanned_ground.h"
#include "importer/site/points/sorted_scans.h"
#include "importer/site/points/static_points.h"
#include "importer/site/points/thin_objects.h"
#include "io/points/e57.h"

namespace patrol::importer {
namespace {

/// Reflectivities of the materials of measured surfaces.
constexpr std::array kReflectivities = {0.04, 0.1, 0.2, 0.3, 0.4, 0.5, 0.65, 0.85};
constexpr double kUnknownReflectivity = 0.5;

std::size_t class_of(float reflectivity) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < kReflectivities.size(); ++i) {
    if (std::abs(kReflectivities[i] - double{reflectivity}) < std::abs(kReflectivities[best] - double{reflectivity}))
      best = i;
  }
  return best;
}

std::string name_of_class(std::size_t i) { return fmt::format("measured_{:02.0f}", 100.0 * kReflectivities[i]); }

/// Meters per unit of the file.
double unit_of_points(const SiteImportOptions& options) { return options.scale > 0.0 ? options.scale : 1.0; }

/// Rotation from the frame of the file to z up.
Eigen::Matrix3d upright(const SiteImportOptions& options) {
  if (options.up != "y") return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d R;
  R << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return R;
}

void append(Mesh& mesh, const Patch& patch) {
  const int first = static_cast<int>(mesh.vertices_m.size());
  for (std::size_t i = 0; i < patch.num_corners; ++i) mesh.vertices_m.push_back(patch.corners_m[i].cast<double>());
  for (int i = 1; i + 1 < patch.num_corners; ++i) mesh.triangles.push_back({first, first + i, first + i + 1});
}

/// Adds the materials and the meshes of the patches, one for each reflectivity, and one of the filled-in surfaces.
void add_surfaces(ImportedSite& site, const std::vector<Patch>& patches, float ground_reflectivity) {
  std::array<Mesh, kReflectivities.size()> measured;
  Mesh filled_in;
  for (const Patch& patch : patches)
    append(patch.is_filled_in ? filled_in : measured[class_of(patch.reflectivity)], patch);
  const auto add = [&](const std::string& name, const Eigen::Vector4d& rgba, Mesh mesh) {
    if (mesh.empty()) return;
    site.materials.push_back({.name = name, .rgba = rgba});
    site.shapes.push_back({.name = name,
                           .type = SiteShapeType::kMesh,
                           .use = ShapeUse::kSeen,
                           .material = name,
                           .mesh = std::move(mesh)});
  };
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const double gray = kReflectivities[i];
    add(name_of_class(i), {gray, gray, gray, 1.0}, std::move(measured[i]));
  }
  // Bluish, with the luminance of the measured ground.
  const Eigen::Vector3d tint(0.7, 1.0, 1.9);
  const double luminance = 0.2126 * tint.x() + 0.7152 * tint.y() + 0.0722 * tint.z();
  const Eigen::Vector3d color = (double{ground_reflectivity} / luminance * tint).cwiseMin(1.0);
  add("filled_in", {color.x(), color.y(), color.z(), 1.0}, std::move(filled_in));
}

void add_contact(ImportedSite& site, const std::vector<Patch>& patches, const ScannedGround& ground) {
  site.materials.push_back({.name = "contact", .rgba = {0.5, 0.5, 0.5, 1.0}});
  site.shapes.push_back({.name = "ground",
                         .type = SiteShapeType::kHeightField,
                         .use = ShapeUse::kContactOnly,
                         .material = "contact",
                         .height_field = {.height_m = ground.height_m}});
  const ContactBoxSettings settings;
  const std::vector<Eigen::AlignedBox3d> boxes = contact_boxes(patches, ground, settings);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    site.shapes.push_back({.name = fmt::format("obstacle_{}", i + 1),
                           .use = ShapeUse::kContactOnly,
                           .T_site_shape = {boxes[i].center(), Eigen::Quaterniond::Identity()},
                           .size_m = 0.5 * boxes[i].sizes(),
                           .material = "contact"});
  }
  use_height_fields_as_ground(site);
  site.ground.max_step_m = 0.0;
  site.assumptions.push_back(
      {"contact",
       fmt::format(
           "height field of the ground with cells of {:g} m, and {} boxes around the surfaces {:g} to {:g} m above it",
           ground.height_m.geometry().resolution_m, boxes.size(), settings.lowest_m, settings.highest_m),
       ""});
}

/// Returns the median reflectivity of patches that face upward.
float ground_reflectivity_of(const std::vector<Patch>& patches) {
  std::vector<float> values;
  for (const Patch& patch : patches) {
    const Eigen::Vector3d normal = patch.area_normal();
    if (std::abs(normal.z()) > 0.9 * normal.norm()) values.push_back(patch.reflectivity);
  }
  if (values.empty()) return static_cast<float>(kUnknownReflectivity);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Adds the filled-in ground, the meshes and the contact geometry. `closed`: sides of thin objects.
void complete(ImportedSite& site, std::vector<Patch> patches, const std::vector<Patch>& closed,
              const ScannedGround& ground) {
  const float reflectivity = ground_reflectivity_of(patches);
  double measured_m2 = 0.0, sides_m2 = 0.0, ground_m2 = 0.0;
  patches.insert(patches.end(), closed.begin(), closed.end());
  for (const Patch& patch : patches) (patch.is_filled_in ? sides_m2 : measured_m2) += patch.area_m2();
  add_contact(site, patches, ground);
  for (const Patch& patch : filled_ground(ground, reflectivity)) {
    ground_m2 += patch.area_m2();
    patches.push_back(patch);
  }
  site.assumptions.push_back(
      {"measured", fmt::format("{:.0f} m2 of surfaces, materials measured_NN with a reflectivity of NN %", measured_m2),
       ""});
  site.assumptions.push_back(
      {"filled in",
       fmt::format("{:.0f} m2 of ground in holes and within 8 m of the measured ground ({:.0f} m2) are interpolated, "
                   "material filled_in",
                   ground_m2, ground.area_m2(GroundOrigin::kMeasured)),
       ""});
  site.assumptions.push_back(
      {"thin objects",
       fmt::format("of objects of at most {:g} m as circles, rectangles or convex outlines, {:.0f} m2 of sides that no "
                   "scan measured are filled in, material filled_in",
                   ThinObjectSettings{}.max_extent_m, sides_m2),
       ""});
  add_surfaces(site, patches, reflectivity);
}

/// Adds the row about the ground with its heights.
void add_ground_row(ImportedSite& site, const std::string& rule, const ScannedGround& ground) {
  double lowest_m = std::numeric_limits<double>::infinity(), highest_m = -lowest_m;
  for (std::size_t i = 0; i < ground.height_m.values().size(); ++i) {
    if (ground.origin.values()[i] != GroundOrigin::kMeasured) continue;
    lowest_m = std::min(lowest_m, double{ground.height_m.values()[i]});
    highest_m = std::max(highest_m, double{ground.height_m.values()[i]});
  }
  site.assumptions.push_back(
      {"ground", fmt::format("{}: heights from {:.2f} to {:.2f} m", rule, lowest_m, highest_m), ""});
}

/// Adds a row about surfaces of a cloud below its ground. Throws InputError if they are most of the surfaces off the
/// ground, as below the ceiling of a room without a floor.
void check_below(ImportedSite& site, const ScannedGround& ground, const std::vector<Patch>& patches,
                 const std::string& location) {
  constexpr double kOff_m = 0.3, kMaxOffRatio = 0.5, kMaxRatio = 0.25, kFewRatio = 0.05;
  double below_m2 = 0.0, above_m2 = 0.0, all_m2 = 0.0;
  for (const Patch& patch : patches) {
    const Eigen::Vector3d p = patch.corners_m[0].cast<double>();
    const double height_m = p.z() - ground.height_at(p.head<2>()), area_m2 = patch.area_m2();
    all_m2 += area_m2;
    if (height_m < -kOff_m) below_m2 += area_m2;
    if (height_m > kOff_m) above_m2 += area_m2;
  }
  if (below_m2 > kMaxRatio * all_m2 && below_m2 > kMaxOffRatio * (below_m2 + above_m2)) {
    const float lowest_m = *std::min_element(ground.height_m.values().begin(), ground.height_m.values().end());
    throw InputError(
        fmt::format("{}: {:.0f} % of the surfaces are below the lowest large level one, at {:.2f} m: the cloud must "
                    "contain the floor",
                    location, 100.0 * below_m2 / all_m2, lowest_m));
  }
  if (below_m2 > kFewRatio * all_m2) {
    site.assumptions.push_back(
        {"below the ground",
         fmt::format("{:.0f} % of the surfaces are more than {:g} m below the ground and have no contact",
                     100.0 * below_m2 / all_m2, kOff_m),
         ""});
  }
}

ImportProgress progress_of(const SiteImportOptions& options) {
  return options.on_progress ? options.on_progress : [](const std::string&, double) {};
}

void add_frame_rows(ImportedSite& site, const Eigen::Vector3d& origin, std::size_t num_dropped,
                    const SiteImportOptions& options) {
  site.assumptions.push_back({"scale", fmt::format("{:g} m per unit of the file", unit_of_points(options)), "--scale"});
  site.assumptions.push_back({"up", fmt::format("axis {}", options.up.empty() ? "z" : options.up), "--up"});
  if (!origin.isZero()) {
    site.assumptions.push_back(
        {"origin",
         fmt::format("the origin of site is ({:.0f}, {:.0f}, {:.0f}) in the file", origin.x(), origin.y(), origin.z()),
         ""});
  }
  if (num_dropped > 0)
    site.assumptions.push_back(
        {"invalid points", fmt::format("{} points are not finite, invalid, noise or withheld: left out", num_dropped),
         ""});
}

/// Refuses coordinates whose floats of 32 bits are too coarse for surfaces.
void check_precision(const Eigen::Vector3d& origin, double step, const std::string& location, double unit_m) {
  constexpr double kMaxStep_m = 0.02, kMaxOrigin_m = 1e8;
  const double origin_m = unit_m * origin.cwiseAbs().maxCoeff(), step_m = unit_m * step;
  if (origin_m > kMaxOrigin_m)
    throw InputError(
        fmt::format("{}: coordinates up to {:.3g} m: must be at most {:g} m", location, origin_m, kMaxOrigin_m));
  if (step_m <= kMaxStep_m) return;
  throw InputError(
      fmt::format("{}: coordinates up to {:.3g} m in single precision are up to {:.2g} m apart: must be double "
                  "precision, or relative to an origin near the site",
                  location, origin_m, step_m));
}

/// Refuses a cloud with a few points on surfaces.
void check_points_on_surfaces(const io::RelativePoints& cloud, const CloudPatches& found, const std::string& location) {
  constexpr std::size_t kMinPoints = 100;
  const std::size_t count = cloud.points.size() - found.num_outliers;
  if (count < kMinPoints) {
    throw InputError(fmt::format("{}: {} of {} points are on surfaces: at least {} are needed", location, count,
                                 cloud.points.size(), kMinPoints));
  }
}

SortedScans sort_with_progress(std::vector<io::StationScan>& scans, const SiteImportOptions& options) {
  const auto progress = progress_of(options);
  const auto num_scans = static_cast<double>(scans.size());
  return sort_scans(scans, upright(options), unit_of_points(options), [&](std::size_t i) {
    progress(fmt::format("sort scan {}", i + 1), 0.15 + 0.1 * static_cast<double>(i) / num_scans);
  });
}

/// Returns the site of sorted scans, whose panoramas are changed.
ImportedSite site_of_panoramas(SortedScans& scans, const Eigen::Vector3d& origin, std::size_t num_dropped,
                               const std::string& source, const SiteImportOptions& options) {
  const auto progress = progress_of(options);
  ImportedSite site{.name = options.name, .source = source};
  std::vector<Panorama>& panoramas = scans.panoramas;
  const auto num_scans = static_cast<double>(panoramas.size());
  const StaticPointCounts counts = find_static_points(panoramas, [&](std::size_t i) {
    progress(fmt::format("compare scan {} with the others", i + 1), 0.25 + 0.35 * static_cast<double>(i) / num_scans);
  });
  const IntensityScale scale = scale_of(scans.max_intensity);
  const auto reflectivity = [&](float intensity, double cosine) {
    if (!scale.is_known()) return static_cast<float>(kUnknownReflectivity);
    return std::clamp(scale.factor * intensity / static_cast<float>(cosine), 0.0f, 1.0f);
  };
  progress("find surfaces", 0.6);
  std::vector<Patch> patches;
  std::vector<Eigen::Vector3d> scanners_m;
  for (Panorama& panorama : panoramas) {
    for (Patch& patch : patches_of(panorama, {}, reflectivity)) patches.push_back(patch);
    scanners_m.push_back(panorama.origin());
  }
  const double step_deg = to_deg(panoramas.front().step_rad());
  add_frame_rows(site, origin, num_dropped, options);
  site.assumptions.push_back({"points",
                              fmt::format("{} of {} scans; the first has a step of {:.3f} degrees", counts.num_points,
                                          scanners_m.size(), step_deg),
                              ""});
  site.assumptions.push_back(
      {"outliers", fmt::format("{} points between surfaces are removed", counts.num_outliers), ""});
  site.assumptions.push_back(
      {"moving objects",
       fmt::format("{} points that another scan looks through and none observes are removed", counts.num_moving), ""});
  site.assumptions.push_back({"reflectivity", scale.rule + ", divided by the cosine of incidence", ""});
  const ScannedGround ground = find_scanned_ground(patches, scanners_m, true, {}, source);
  add_ground_row(site, "the surface around the scanners and what is connected by steps of at most 0.12 m", ground);
  progress("close thin objects", 0.7);
  const std::vector<Patch> sides = close_thin_objects(patches, panoramas, ground, {});
  progress("find surfaces without thin objects", 0.85);
  patches.clear();
  for (const Panorama& panorama : panoramas) {
    for (Patch& patch : patches_of(panorama, {}, reflectivity)) patches.push_back(patch);
  }
  progress("make contact geometry", 0.95);
  complete(site, std::move(patches), sides, ground);
  return site;
}

}  // namespace

ImportedSite read_scans_site(const SiteImportOptions& options) {
  progress_of(options)("read scans", 0.0);
  const std::string source = options.file.string();
  const double unit_m = unit_of_points(options);
  if (std::filesystem::is_directory(options.file))
    return site_of_scans(io::load_relative_scans(options.file, unit_m), source, options);
  io::E57Scans file = io::load_e57(options.file, unit_m);
  if (file.scans.scans.empty()) throw InputError(source + ": has no points");
  check_precision(file.scans.origin, file.step, source, unit_m);
  std::string reason = "a scan has no pose";
  if (file.has_scanners) {
    SortedScans sorted = sort_with_progress(file.scans.scans, options);
    if (sorted.problem.empty())
      return site_of_panoramas(sorted, file.scans.origin, file.scans.num_dropped, source, options);
    reason = sorted.problem;
    file = io::load_e57(options.file, unit_m);
  }
  ImportedSite site = site_of_cloud(io::joined_points(std::move(file)), source, options);
  site.assumptions.push_back({"scanner positions", "not used: " + reason, ""});
  return site;
}

ImportedSite read_cloud_site(const SiteImportOptions& options) {
  progress_of(options)("read points", 0.0);
  return site_of_cloud(io::load_points(options.file, {}, unit_of_points(options)), options.file.string(), options);
}

ImportedSite site_of_scans(io::RelativeScans scans, const std::string& source, const SiteImportOptions& options) {
  if (scans.scans.empty()) throw InputError(source + ": has no scans");
  SortedScans sorted = sort_with_progress(scans.scans, options);
  if (!sorted.problem.empty()) throw InputError(fmt::format("{}: {}", source, sorted.problem));
  return site_of_panoramas(sorted, scans.origin, scans.num_dropped, source, options);
}

ImportedSite site_of_cloud(io::RelativePoints cloud, const std::string& source, const SiteImportOptions& options) {
  const auto progress = progress_of(options);
  check_precision(cloud.origin, cloud.step, source, unit_of_points(options));
  progress("find surfaces", 0.3);
  ImportedSite site{.name = options.name, .source = source};
  transform(cloud.points, unit_of_points(options) * upright(options));
  const IntensityScale scale = scale_of_cloud(cloud.points);
  CloudPatches found = patches_of_cloud(
      cloud.points,
      [&](float intensity) {
        return scale.is_known() ? scale.light_of(intensity) : static_cast<float>(kUnknownReflectivity);
      },
      source);
  check_points_on_surfaces(cloud, found, source);
  add_frame_rows(site, cloud.origin, cloud.num_dropped, options);
  if (!cloud.columns.empty()) site.assumptions.push_back({"columns", cloud.columns, "a first line with their names"});
  site.assumptions.push_back(
      {"points",
       fmt::format("{}; smallest cell {:g} m, noise {:.4f} m", cloud.points.size(), found.cell_m, found.noise_m), ""});
  site.assumptions.push_back(
      {"outliers",
       fmt::format("{} points without a surface are removed{}", found.num_outliers,
                   2 * found.num_outliers > cloud.points.size() ? ": more than half of the cloud" : ""),
       ""});
  site.assumptions.push_back(
      {"moving objects", "remain: without scanner positions, no point can be looked through", ""});
  site.assumptions.push_back(
      {"normals", "surfaces face the nearest place where a person can stand, 1.5 m above the ground", ""});
  site.assumptions.push_back({"reflectivity", scale.rule + ", at any incidence", ""});
  progress("find the ground", 0.8);
  const ScannedGround ground = find_scanned_ground(found.patches, {}, false, {}, source);
  add_ground_row(site, "the lowest large level surface and what is connected by steps of at most 0.12 m", ground);
  check_below(site, ground, found.patches, source);
  orient(found.patches, ground);
  constexpr double kUnseenExtent_m = 0.6;  // without beams, only small convex hulls are likely
  std::vector<Panorama> no_scans;
  const std::vector<Patch> sides =
      close_thin_objects(found.patches, no_scans, ground, {.max_extent_m = kUnseenExtent_m});
  complete(site, std::move(found.patches), sides, ground);
  return site;
}

}  // namespace patrol::importer
