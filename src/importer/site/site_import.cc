#include "importer/site/site_import.h"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "core/text.h"
#include "importer/site/mesh_site.h"
#include "importer/site/mjcf_site.h"
#include "importer/site/plan_site.h"
#include "importer/site/points_site.h"
#include "importer/site/sdf_site.h"
#include "io/points/point_reading.h"

namespace patrol::importer {
namespace {

/// Reader of one kind of file.
struct SiteReader {
  std::string_view extension;
  ImportedSite (*read)(const SiteImportOptions& options);
};

/// A PLY file with faces is a mesh, one without is a cloud.
ImportedSite read_ply_site(const SiteImportOptions& options) {
  return io::has_faces(options.file) ? read_mesh_site(options) : read_cloud_site(options);
}

constexpr std::array kReaders = std::to_array<SiteReader>({
    {".yaml", read_plan_site},
    {".gltf", read_mesh_site},
    {".glb", read_mesh_site},
    {".obj", read_mesh_site},
    {".dae", read_mesh_site},
    {".stl", read_mesh_site},
    {".sdf", read_sdf_site},
    {".world", read_sdf_site},
    {".xml", read_mjcf_site},
    {".ply", read_ply_site},
    {".pcd", read_cloud_site},
});

ImportedSite read_site(const SiteImportOptions& options) {
  if (std::filesystem::is_directory(options.file)) return read_scans_site(options);
  const std::string extension = to_lower(options.file.extension().string());
  std::vector<std::string> known;
  for (const SiteReader& reader : kReaders) {
    if (extension == reader.extension) return reader.read(options);
    known.emplace_back(reader.extension);
  }
  throw InputError(
      fmt::format("{}: extension of a site file must be one of {}", options.file.string(), patrol::join(known, ", ")));
}

}  // namespace

ImportedSite import_site(const SiteImportOptions& options) {
  ImportedSite site = read_site(options);
  add_mission(options.mission, site);
  return site;
}

}  // namespace patrol::importer
