#include "importer/site/site_import.h"

#include <stdexcept>

#include "importer/site/ground_slope.h"
#include "importer/site/mesh_site.h"
#include "importer/site/mjcf_site.h"
#include "importer/site/plan_site.h"
#include "importer/site/points_site.h"
#include "importer/site/sdf_site.h"
#include "importer/site/site_format.h"

namespace patrol::importer {
namespace {

ImportedSite read_site(const SiteImportOptions& options) {
  switch (site_format(options.file)) {
    case SiteFormat::kPlan:
      return read_plan_site(options);
    case SiteFormat::kMesh:
      return read_mesh_site(options);
    case SiteFormat::kSdf:
      return read_sdf_site(options);
    case SiteFormat::kMjcf:
      return read_mjcf_site(options);
    case SiteFormat::kCloud:
      return read_cloud_site(options);
    case SiteFormat::kScans:
      return read_scans_site(options);
    case SiteFormat::kLog:
      break;
  }
  throw std::invalid_argument(options.file.string() + ": a log is mapped by app/mapping/log_site.h");
}

}  // namespace

ImportedSite import_site(const SiteImportOptions& options) {
  ImportedSite site = read_site(options);
  add_slope_rows(site);
  add_mission(options.mission, site);
  return site;
}

}  // namespace patrol::importer
