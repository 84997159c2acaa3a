#include "app/campaign/test/seed_table.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/json/metrics_json.h"

namespace patrol::app {

SeedTable::SeedTable(const std::filesystem::path& file) {
  const io::Metrics json = io::load_metrics(file);
  if (!json.is_object())
    throw InputError(fmt::format("{}: must be an object of scenarios and their seeds", file.string()));
  for (const auto& [key, seed] : json.items()) {
    if (!seed.is_number_unsigned())
      throw InputError(
          fmt::format("{}: {} = {}: must be a seed, an integer of at least 0", file.string(), key, seed.dump()));
    rows_.push_back({.key = key, .seed = seed.get<std::uint64_t>()});
  }
}

std::optional<std::uint64_t> SeedTable::seed_of(const std::filesystem::path& scenario) const {
  const std::string path = "/" + std::filesystem::absolute(scenario).lexically_normal().generic_string();
  const Row* best = nullptr;
  for (const Row& row : rows_) {
    if (path.ends_with("/" + row.key) && (best == nullptr || row.key.size() > best->key.size())) best = &row;
  }
  return best == nullptr ? std::nullopt : std::optional(best->seed);
}

}  // namespace patrol::app
