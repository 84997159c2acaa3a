#include "app/study/scan_import_study.h"

#include <fmt/format.h>

#include "app/common/process_cost.h"
#include "app/common/temporary_folder.h"
#include "app/study/scan_world.h"
#include "app/study/site_comparison.h"
#include "importer/site/site_import.h"

namespace patrol::app {
namespace {

constexpr int kPoses = 200;

std::vector<double> import_scans(const ScannedWorld& world, std::uint64_t seed) {
  const TemporaryFolder folder(fmt::format("scan-import-{}-{}", world.name, seed));
  const std::size_t num_points = save_scans(world, seed, folder.path() / "scans");
  const std::string name = "imported_" + world.name;
  const double begin_s = process_seconds();
  const importer::ImportedSite site = importer::import_site({.file = folder.path() / "scans", .name = name});
  importer::write_site(site, folder.path() / name);
  const double time_s = process_seconds() - begin_s, memory_mb = peak_memory_mb();
  double num_triangles = 0.0, num_boxes = 0.0;
  for (const importer::SiteShape& shape : site.shapes) {
    num_triangles += static_cast<double>(shape.mesh.triangles.size());
    num_boxes += shape.type == importer::SiteShapeType::kBox ? 1.0 : 0.0;
  }
  const SiteComparison c = compare_site(world, site, (folder.path() / name / (name + ".xml")).string(), kPoses, seed);
  return {100.0 * c.planar.median_m,
          100.0 * c.planar.p95_m,
          100.0 * c.planar.within_10cm,
          100.0 * c.planar.seen,
          100.0 * c.planar.seen_within_10cm,
          100.0 * c.spatial.median_m,
          100.0 * c.spatial.p95_m,
          100.0 * c.spatial.within_10cm,
          100.0 * c.spatial.seen,
          100.0 * c.spatial.seen_within_10cm,
          100.0 * c.ground_median_m,
          100.0 * c.ground_p95_m,
          100.0 * c.person_hits,
          100.0 * c.truck_hits,
          static_cast<double>(c.num_phantoms),
          1e-6 * static_cast<double>(num_points),
          1e-6 * num_triangles,
          num_boxes,
          time_s,
          memory_mb};
}

}  // namespace

studies::Study scan_import_study() {
  studies::Study study{
      .name = "scan-import",
      .title = "Sites from panoramic scans",
      .source = "no publication; test of the import of sites",
      .conditions =
          "Each seed: 12 panoramic scans 1.7 m above the ground of the tunnel (every 13 m, step 0.18 degrees) and of "
          "the substation (at positions on the roads that see what lidars there see, step 0.1 degrees, down to 40 "
          "degrees below the horizon), with the noise of the scanner's data sheet and exact poses. A person and a "
          "truck are present in one scan. The site of the points alone is compared with the world at 200 "
          "held-out poses on the roads with a clearance of 0.6 m: a 2D lidar 0.55 m above the ground, 720 beams to 30 "
          "m, and a 3D lidar 0.8 m above it, 16 rings within 15 degrees of 360 beams to 100 m, both without noise and "
          "with returns up to an incidence of 85 degrees. A beam that the world returns and the site has no surface "
          "for, or the reverse, has an infinite error. Seen: beams whose surface a scanner has a free line to, at most "
          "70 m "
          "long and at an incidence of at most 85 degrees; the others cannot be measured. Hits: beams to the places of "
          "the person and the truck that "
          "meet a surface there in the site and not in the world. Blocked: poses, free in the world, at which a robot "
          "of 0.4 m in radius touches the site's geometry for contact.",
      .default_seeds = 3};
  study.metrics = {{.name = "2D median", .unit = "cm", .is_compared = true},
                   {.name = "2D 95 %", .unit = "cm"},
                   {.name = "2D within 10 cm", .unit = "%", .is_compared = true},
                   {.name = "2D seen", .unit = "%"},
                   {.name = "2D seen within 10 cm", .unit = "%"},
                   {.name = "3D median", .unit = "cm", .is_compared = true},
                   {.name = "3D 95 %", .unit = "cm"},
                   {.name = "3D within 10 cm", .unit = "%", .is_compared = true},
                   {.name = "3D seen", .unit = "%"},
                   {.name = "3D seen within 10 cm", .unit = "%"},
                   {.name = "ground median", .unit = "cm"},
                   {.name = "ground 95 %", .unit = "cm"},
                   {.name = "person hits", .unit = "%"},
                   {.name = "truck hits", .unit = "%"},
                   {.name = "blocked", .unit = ""},
                   {.name = "points", .unit = "million"},
                   {.name = "triangles", .unit = "million"},
                   {.name = "contact boxes", .unit = ""},
                   {.name = "time", .unit = "s", .is_processor_time = true},
                   {.name = "memory", .unit = "MB", .is_processor_time = true}};
  for (const ScannedWorld& world : scanned_worlds())
    study.variants.push_back({.world = world.name,
                              .method = fmt::format("step {:g} degrees", world.step_deg),
                              .reference = study.variants.size()});
  study.run = [](std::uint64_t seed) {
    studies::StudySample sample;
    for (const ScannedWorld& world : scanned_worlds()) sample.push_back(import_scans(world, seed));
    return sample;
  };
  study.illustrate = [](std::uint64_t) { return std::vector<report::Section>{}; };
  return study;
}

}  // namespace patrol::app
