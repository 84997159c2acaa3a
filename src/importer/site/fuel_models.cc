#include "importer/site/fuel_models.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <system_error>
#include <vector>

#include "core/letter_case.h"

namespace patrol::importer {
namespace {

/// Hosts of the same models: the name of the site changed.
constexpr std::array kFuelHosts = {"fuel.gazebosim.org", "fuel.ignitionrobotics.org"};

/// Replaces codes such as %20 by their characters.
std::string decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    const char* digits = text.data() + i + 1;
    const bool is_code = text[i] == '%' && i + 2 < text.size() &&
                         std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2 && value >= 0x20;
    result += is_code ? static_cast<char>(value) : text[i];
    if (is_code) i += 2;
  }
  return result;
}

std::vector<std::string> parts_of(std::string_view path) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= path.size();) {
    const std::size_t end = std::min(path.find('/', at), path.size());
    if (end > at) parts.push_back(decoded(path.substr(at, end - at)));
    at = end + 1;
  }
  return parts;
}

std::optional<int> version_number(const std::string& text) {
  int number = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && at == end && number >= 0 ? std::optional(number) : std::nullopt;
}

/// Returns the first folder of this name in any case, by alphabet.
std::optional<std::filesystem::path> child_of(const std::filesystem::path& folder, const std::string& name) {
  std::error_code error;
  std::optional<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const bool is_named = to_lower(entry.path().filename().string()) == to_lower(name) && entry.is_directory(error);
    if (is_named && (!found || entry.path() < *found)) found = entry.path();
  }
  return found;
}

std::vector<std::filesystem::path> cache_folders() {
  std::vector<std::filesystem::path> folders;
  for (const char* variable : {"GZ_FUEL_CACHE_PATH", "IGN_FUEL_CACHE_PATH"}) {
    const char* folder = std::getenv(variable);
    if (folder != nullptr && *folder != '\0') folders.emplace_back(folder);
  }
  for (const char* folder : {".gz/fuel", ".ignition/fuel"}) {
    if (const auto path = folder_at_home(folder)) folders.push_back(*path);
  }
  return folders;
}

bool is_model(const std::filesystem::path& folder) {
  std::error_code error;
  return std::filesystem::is_regular_file(folder / "model.config", error);
}

}  // namespace

bool is_of_network(std::string_view uri) {
  return uri.starts_with("http://") || uri.starts_with("https://") || uri.starts_with("fuel://");
}

std::optional<FuelModel> fuel_model(std::string_view uri) {
  if (!is_of_network(uri)) return std::nullopt;
  uri = uri.substr(uri.find("://") + 3);
  uri = uri.substr(0, uri.find_first_of("?#"));
  const std::vector<std::string> parts = parts_of(uri);
  if (parts.size() < 2) return std::nullopt;
  const auto models = std::find(parts.begin() + 1, parts.end(), "models");
  if (models == parts.end()) return FuelModel{.host = parts.front(), .owner = {}, .name = parts.back()};
  if (models + 1 == parts.end()) return std::nullopt;
  // A page of a model has the owner before a folder `fuel`.
  auto owner = models - 1;
  if (*owner == "fuel" && owner > parts.begin() + 1) --owner;
  FuelModel model{.host = parts.front(), .owner = owner > parts.begin() ? *owner : "", .name = *(models + 1)};
  auto at = models + 2;
  if (at != parts.end() && version_number(*at)) model.version = *at;
  at = std::find(at, parts.end(), "files");
  for (at += at == parts.end() ? 0 : 1; at != parts.end(); ++at) model.file /= *at;
  return model;
}

std::optional<std::filesystem::path> version_folder(const std::filesystem::path& folder, const FuelModel& model) {
  if (is_model(folder)) return folder;
  std::optional<std::filesystem::path> newest;
  int newest_number = -1;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const int number = version_number(name).value_or(-1);
    if (number <= newest_number || !is_model(entry.path()) || (!model.version.empty() && name != model.version))
      continue;
    newest = entry.path();
    newest_number = number;
  }
  return newest;
}

std::optional<std::filesystem::path> find_in_fuel_cache(const FuelModel& model) {
  std::vector<std::string> hosts = {model.host};
  if (std::find(kFuelHosts.begin(), kFuelHosts.end(), model.host) != kFuelHosts.end())
    hosts.insert(hosts.end(), kFuelHosts.begin(), kFuelHosts.end());
  for (const std::filesystem::path& cache : cache_folders()) {
    for (const std::string& host : hosts) {
      const auto owner = child_of(cache / host, model.owner);
      const auto folder = owner ? child_of(*owner / "models", model.name) : std::nullopt;
      const auto version = folder ? version_folder(*folder, model) : std::nullopt;
      if (version) return std::filesystem::absolute(*version);
    }
  }
  return std::nullopt;
}

std::optional<std::filesystem::path> folder_at_home(const std::string& path) {
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0') return std::nullopt;
  return std::filesystem::path(home) / path;
}

}  // namespace patrol::importer
