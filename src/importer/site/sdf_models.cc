#include "importer/site/sdf_models.h"

#include <array>
#include <cstdlib>
#include <iterator>
#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "importer/site/sdf_source.h"
#include "importer/xml_elements.h"
#include "io/files/one_line.h"
#include "io/files/xml_problem.h"

namespace patrol::importer {
namespace {

/// Variables of Gazebo Classic and of Gazebo with lists of folders of models, separated by colons.
constexpr std::array kFolderVariables = {"GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH"};

/// Variable of Gazebo Classic with a list of folders of other files.
constexpr const char* kFileVariable = "GAZEBO_RESOURCE_PATH";

std::vector<std::filesystem::path> folders_of(const char* variable) {
  std::vector<std::filesystem::path> folders;
  const char* text = std::getenv(variable);
  std::istringstream list(text != nullptr ? text : "");
  for (std::string folder; std::getline(list, folder, ':');) {
    if (!folder.empty()) folders.emplace_back(folder);
  }
  return folders;
}

std::vector<std::filesystem::path> folders_of_models() {
  std::vector<std::filesystem::path> folders;
  for (const char* variable : kFolderVariables) {
    const std::vector<std::filesystem::path> more = folders_of(variable);
    folders.insert(folders.end(), more.begin(), more.end());
  }
  if (const auto models = folder_at_home(".gazebo/models")) folders.push_back(*models);
  return folders;
}

bool is_present(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

}  // namespace

std::string name_in(const std::string& uri) {
  if (uri.starts_with(kModelScheme)) {
    const std::string rest = uri.substr(kModelScheme.size());
    return rest.substr(0, rest.find('/'));
  }
  const auto model = fuel_model(uri);
  return model ? model->name : std::string();
}

std::string unknown_model(const std::string& uri) {
  const std::string variables = fmt::format("{}", fmt::join(kFolderVariables, " or "));
  if (is_of_network(uri))
    return fmt::format(
        "model \"{0}\" is not in the cache ~/.gz/fuel: download it, and give its folder with --package "
        "\"{0}=FOLDER\" or the folder above it in {1}: {2}",
        name_in(uri), variables, uri);
  return fmt::format("unknown model \"{0}\": give its folder with --package {0}=FOLDER, or the folder above it in {1}",
                     name_in(uri), variables);
}

std::string unknown_models(const std::vector<std::string>& uris) {
  std::vector<std::string> names;
  bool has_network = false;
  for (const std::string& uri : uris) {
    if (std::ranges::find(names, name_in(uri)) == names.end()) names.push_back(name_in(uri));
    has_network |= is_of_network(uri);
  }
  if (names.size() == 1) return unknown_model(uris.front());
  return fmt::format(
      "{} unknown models: \"{}\": {}give the folder of each with --package NAME=FOLDER, or the folder "
      "above them in {}",
      names.size(), fmt::join(names, "\", \""), has_network ? "download those of a network, and " : "",
      fmt::join(kFolderVariables, " or "));
}

std::string unknown_file(const std::string& uri) {
  return fmt::format(
      "{}: file not found, also in the three folders above the file and above the world: put it there, or "
      "name a folder in {}",
      uri, kFileVariable);
}

SdfModels::SdfModels(const std::filesystem::path& world, const std::map<std::string, std::filesystem::path>& packages)
    : world_(std::filesystem::absolute(world)), packages_(packages, world) {
  for (const auto& [name, folder] : packages) lower_case_.emplace(to_lower(name), std::filesystem::absolute(folder));
}

std::optional<std::filesystem::path> SdfModels::find(const std::string& name) const {
  if (const auto found = packages_.find(name)) return found;
  std::error_code error;
  for (std::filesystem::path folder = world_.parent_path();; folder = folder.parent_path()) {
    const std::filesystem::path model = folder / "models" / name;
    if (std::filesystem::is_directory(model, error)) return model;
    if (folder == folder.root_path()) break;
  }
  for (const std::filesystem::path& folder : folders_of_models()) {
    if (std::filesystem::is_directory(folder / name, error)) return std::filesystem::absolute(folder / name);
  }
  return std::nullopt;
}

std::optional<std::filesystem::path> SdfModels::find(const FuelModel& model) const {
  if (const auto given = lower_case_.find(to_lower(model.name)); given != lower_case_.end())
    return version_folder(given->second, model).value_or(given->second);
  for (const std::string& name : {model.name, to_lower(model.name)}) {
    const auto found = find(name);
    const auto version = found ? version_folder(*found, model) : std::nullopt;
    if (version) return version;
  }
  return find_in_fuel_cache(model);
}

std::optional<std::filesystem::path> SdfModels::find_uri(const std::string& uri,
                                                         const std::filesystem::path& folder) const {
  if (is_of_network(uri)) {
    const auto model = fuel_model(uri);
    const auto found = model ? find(*model) : std::nullopt;
    return found && !model->file.empty() ? *found / model->file : found;
  }
  if (!uri.starts_with(kModelScheme)) return find_file(uri, folder);
  const std::string name = name_in(uri);
  const auto found = find(name);
  if (!found) return std::nullopt;
  const std::size_t end = kModelScheme.size() + name.size();
  return end + 1 < uri.size() ? *found / uri.substr(end + 1) : *found;
}

std::filesystem::path SdfModels::find_file(const std::string& uri, const std::filesystem::path& folder) const {
  constexpr std::string_view kFileScheme = "file://";
  const std::filesystem::path path = uri.starts_with(kFileScheme) ? uri.substr(kFileScheme.size()) : uri;
  const std::filesystem::path world = world_.parent_path();
  for (const std::filesystem::path& beside : {folder / path, world / path}) {
    if (is_present(beside)) return beside;
  }
  for (auto part = path.begin(); part != path.end(); ++part) {
    auto given = packages_.given(part->string());
    for (auto next = std::next(part); given && next != path.end(); ++next) *given /= *next;
    if (given && is_present(*given)) return *given;
  }
  std::vector<std::filesystem::path> searched = Packages::with_folders_above(folder);
  const std::vector<std::filesystem::path> variables = folders_of(kFileVariable);
  for (const auto& more : {Packages::with_folders_above(world), folders_of_models(), variables})
    searched.insert(searched.end(), more.begin(), more.end());
  for (const std::filesystem::path& end : Packages::ends_of(uri)) {
    for (const std::filesystem::path& above : searched) {
      if (is_present(above / end)) return std::filesystem::absolute(above / end);
    }
  }
  return world / path;
}

std::filesystem::path sdf_file_of_model(const std::filesystem::path& folder) {
  const std::filesystem::path config = folder / "model.config";
  std::error_code error;
  if (!std::filesystem::is_regular_file(config, error)) throw InputError(config.string() + ": file not found");
  tinyxml2::XMLDocument document;
  if (document.LoadFile(config.c_str()) != tinyxml2::XML_SUCCESS || document.RootElement() == nullptr)
    throw input_error(config.string(), document.ErrorLineNum(), "not XML: " + io::xml_problem(document));
  std::string best;
  int best_version = -1;
  for (const auto* sdf = document.RootElement()->FirstChildElement("sdf"); sdf != nullptr;
       sdf = sdf->NextSiblingElement("sdf")) {
    const char* name = sdf->GetText();
    if (name == nullptr) continue;
    const char* text = sdf->Attribute("version");
    const int version = minor_sdf_version(text == nullptr ? "" : text).value_or(0);
    const bool is_read = version <= kMaxLibraryVersion;
    const bool is_better =
        best_version > kMaxLibraryVersion ? is_read || version < best_version : is_read && version > best_version;
    if (!best.empty() && !is_better) continue;
    best = trimmed(name);
    best_version = version;
  }
  if (best.empty()) throw InputError(config.string() + ": names no file in <sdf>");
  const std::filesystem::path file = folder / best;
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(fmt::format("{}: <sdf>: {}: file not found", config.string(), io::on_one_line(best)));
  return file;
}

}  // namespace patrol::importer
