#include "importer/site/site_import.h"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "importer/site/plan_site.h"
#include "importer/site/points_site.h"

namespace patrol::importer {
namespace {

/// Reader of one kind of file.
struct SiteReader {
  std::string_view extension;
  ImportedSite (*read)(const SiteImportOptions& options);
};

constexpr std::array kReaders = std::to_array<SiteReader>({
    {".yaml", read_plan_site},
    {".ply", read_cloud_site},
    {".pcd", read_cloud_site},
});

}  // namespace

ImportedSite import_site(const SiteImportOptions& options) {
  if (std::filesystem::is_directory(options.file)) return read_scans_site(options);
  std::vector<std::string> known;
  for (const SiteReader& reader : kReaders) {
    if (options.file.extension() == reader.extension) return reader.read(options);
    known.emplace_back(reader.extension);
  }
  throw InputError(
      fmt::format("{}: extension of a site file must be one of {}", options.file.string(), patrol::join(known, ", ")));
}

}  // namespace patrol::importer
