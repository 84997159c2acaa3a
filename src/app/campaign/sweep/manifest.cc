#include "app/campaign/sweep/manifest.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/files/atomic_file.h"

namespace patrol::app {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int kVersion = 2;

OrderedJson json_of(const SweepManifest& manifest) {
  OrderedJson json{{"version", kVersion},
                   {"kind", row_of(kSweepKinds, manifest.kind).name},
                   {"scenario", manifest.scenario},
                   {"overrides", manifest.overrides},
                   {"paths", manifest.paths},
                   {"metrics", manifest.metrics},
                   {"early_stop", manifest.stop.is_early},
                   {"equivalence_margin", manifest.stop.equivalence_margin},
                   {"seeds", manifest.seeds},
                   {"variants", OrderedJson::array()},
                   {"runs", OrderedJson::array()}};
  for (const Variant& variant : manifest.variants) {
    json["variants"].push_back({{"name", variant.name}, {"overrides", variant.overrides}});
  }
  for (const PlannedRun& run : manifest.runs) {
    json["runs"].push_back(
        {{"variant", run.variant}, {"seed", run.seed}, {"overrides", run.overrides}, {"hash", run.hash}});
  }
  return json;
}

SweepManifest manifest_of(const OrderedJson& json) {
  SweepManifest manifest;
  manifest.kind = row_named(kSweepKinds, json.at("kind").get<std::string>(), "kind").value;
  json.at("scenario").get_to(manifest.scenario);
  json.at("overrides").get_to(manifest.overrides);
  json.at("paths").get_to(manifest.paths);
  json.at("metrics").get_to(manifest.metrics);
  json.at("early_stop").get_to(manifest.stop.is_early);
  json.at("equivalence_margin").get_to(manifest.stop.equivalence_margin);
  json.at("seeds").get_to(manifest.seeds);
  for (const OrderedJson& variant : json.at("variants")) {
    manifest.variants.push_back({.name = variant.at("name"), .overrides = variant.at("overrides")});
  }
  for (const OrderedJson& run : json.at("runs")) {
    manifest.runs.push_back({.variant = run.at("variant"),
                             .seed = run.at("seed"),
                             .overrides = run.at("overrides"),
                             .hash = run.at("hash")});
    if (manifest.runs.back().variant >= manifest.variants.size()) throw InputError("runs: unknown variant");
  }
  for (const auto& [key, is_empty] :
       {std::pair("metrics", manifest.metrics.empty()), std::pair("seeds", manifest.seeds.empty()),
        std::pair("variants", manifest.variants.empty())}) {
    if (is_empty) throw InputError(fmt::format("{}: is empty", key));
  }
  if (manifest.runs.size() != manifest.variants.size() * manifest.seeds.size())
    throw InputError("runs: must have one run per variant and seed");
  return manifest;
}

}  // namespace

std::vector<std::string> overrides_of(const SweepManifest& manifest, const PlannedRun& run) {
  std::vector<std::string> overrides = manifest.overrides;
  overrides.insert(overrides.end(), run.overrides.begin(), run.overrides.end());
  overrides.push_back(fmt::format("seed={}", run.seed));
  return overrides;
}

void save_manifest(const std::filesystem::path& file, const SweepManifest& manifest) {
  io::save_text(file, json_of(manifest).dump(1) + "\n");
}

SweepManifest load_manifest(const std::filesystem::path& file) {
  const std::string text = io::load_text(file);
  try {
    const OrderedJson json = OrderedJson::parse(text);
    if (json.at("version") != kVersion) throw InputError("version: must be 2");
    return manifest_of(json);
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: invalid sweep manifest: {}", file.string(), error.what()));
  }
}

}  // namespace patrol::app
