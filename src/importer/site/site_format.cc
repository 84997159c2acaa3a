#include "importer/site/site_format.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "core/text.h"
#include "importer/xacro.h"
#include "io/points/point_reading.h"

namespace patrol::importer {
namespace {

struct ExtensionFormat {
  std::string_view extension;
  SiteFormat format;
};

constexpr std::array kExtensions = std::to_array<ExtensionFormat>({
    {".yaml", SiteFormat::kPlan}, {".mcap", SiteFormat::kLog},  {".clf", SiteFormat::kLog},
    {".log", SiteFormat::kLog},   {".gz", SiteFormat::kLog},    {".gltf", SiteFormat::kMesh},
    {".glb", SiteFormat::kMesh},  {".obj", SiteFormat::kMesh},  {".dae", SiteFormat::kMesh},
    {".stl", SiteFormat::kMesh},  {".sdf", SiteFormat::kSdf},   {".world", SiteFormat::kSdf},
    {".xml", SiteFormat::kMjcf},  {".ply", SiteFormat::kMesh},  {".pcd", SiteFormat::kCloud},
    {".las", SiteFormat::kCloud}, {".laz", SiteFormat::kCloud}, {".xyz", SiteFormat::kCloud},
    {".pts", SiteFormat::kCloud}, {".asc", SiteFormat::kCloud}, {".csv", SiteFormat::kCloud},
    {".txt", SiteFormat::kCloud}, {".e57", SiteFormat::kScans},
});

/// Option and the formats that use it.
struct FormatOption {
  std::string_view option;
  std::vector<SiteFormat> formats;
  std::string_view names;  ///< names of the formats
};

const std::vector<FormatOption>& format_options() {
  static const std::vector<FormatOption> options = {
      {"--wall-height", {SiteFormat::kPlan, SiteFormat::kLog}, "floor plans and lidar logs"},
      {"--scale", {SiteFormat::kMesh, SiteFormat::kCloud, SiteFormat::kScans}, "meshes, point clouds and scans"},
      {"--up", {SiteFormat::kMesh, SiteFormat::kCloud, SiteFormat::kScans}, "meshes, point clouds and scans"},
      {"--contact-cell", {SiteFormat::kMesh, SiteFormat::kSdf}, "meshes and SDF"},
      {"--package", {SiteFormat::kSdf}, "SDF"},
      {"--xacro-arg", {SiteFormat::kSdf}, "SDF"},
      {"--without", {SiteFormat::kSdf}, "SDF"}};
  return options;
}

}  // namespace

SiteFormat site_format(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) return SiteFormat::kScans;
  const bool has_xacro_name = is_xacro(file);
  const std::string extension = to_lower((has_xacro_name ? file.stem() : file).extension().string());
  std::vector<std::string_view> known;
  for (const ExtensionFormat& row : kExtensions) {
    if (extension == row.extension && (!has_xacro_name || row.format == SiteFormat::kSdf))
      return extension == ".ply" && !io::has_faces(file) ? SiteFormat::kCloud : row.format;
    known.push_back(row.extension);
  }
  throw InputError(fmt::format(
      "{}: extension of a site file must be one of {}, .sdf.xacro, .world.xacro; a folder must contain scans",
      file.string(), patrol::join(known, ", ")));
}

void refuse_unused_options(const std::filesystem::path& file, const std::vector<std::string>& options) {
  const SiteFormat format = site_format(file);
  for (const FormatOption& row : format_options()) {
    const bool is_given = std::find(options.begin(), options.end(), row.option) != options.end();
    if (is_given && std::find(row.formats.begin(), row.formats.end(), format) == row.formats.end())
      throw InputError(fmt::format("{}: has no effect on {}: only for {}", row.option, file.string(), row.names));
  }
}

}  // namespace patrol::importer
