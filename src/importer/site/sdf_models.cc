#include "importer/site/sdf_models.h"

#include <array>
#include <cstdlib>
#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include "core/error.h"
#include "importer/site/sdf_source.h"
#include "importer/source_reader.h"
#include "io/files/one_line.h"
#include "io/files/xml_problem.h"

namespace patrol::importer {
namespace {

/// Variables of Gazebo Classic and of Gazebo with lists of folders of models, separated by colons.
constexpr std::array kFolderVariables = {"GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH"};

std::optional<std::filesystem::path> find_in_variables(const std::string& model) {
  for (const char* variable : kFolderVariables) {
    const char* folders = std::getenv(variable);
    std::istringstream list(folders != nullptr ? folders : "");
    for (std::string folder; std::getline(list, folder, ':');) {
      std::error_code error;
      const std::filesystem::path path = std::filesystem::path(folder) / model;
      if (!folder.empty() && std::filesystem::is_directory(path, error)) return std::filesystem::absolute(path);
    }
  }
  return std::nullopt;
}

}  // namespace

bool is_of_network(std::string_view uri) {
  return uri.starts_with("http://") || uri.starts_with("https://") || uri.starts_with("fuel://");
}

std::string model_name_of(std::string_view uri) {
  const std::string_view rest = uri.substr(kModelScheme.size());
  return std::string(rest.substr(0, rest.find('/')));
}

std::string unknown_model(const std::string& name) {
  return fmt::format("unknown model \"{0}\": give its folder with --package {0}=FOLDER, or the folder above it in {1}",
                     name, fmt::join(kFolderVariables, " or "));
}

SdfModels::SdfModels(const std::filesystem::path& world, const std::map<std::string, std::filesystem::path>& packages)
    : world_(std::filesystem::absolute(world)), packages_(packages, world) {}

std::optional<std::filesystem::path> SdfModels::find(const std::string& name) const {
  if (const auto found = packages_.find(name)) return found;
  std::error_code error;
  for (std::filesystem::path folder = world_.parent_path();; folder = folder.parent_path()) {
    const std::filesystem::path model = folder / "models" / name;
    if (std::filesystem::is_directory(model, error)) return model;
    if (folder == folder.root_path()) return find_in_variables(name);
  }
}

std::optional<std::filesystem::path> SdfModels::find_uri(const std::string& uri,
                                                         const std::filesystem::path& folder) const {
  if (uri.starts_with(kModelScheme)) {
    const std::string name = model_name_of(uri);
    const auto found = find(name);
    if (!found) return std::nullopt;
    const std::size_t end = kModelScheme.size() + name.size();
    return end + 1 < uri.size() ? *found / uri.substr(end + 1) : *found;
  }
  constexpr std::string_view kFileScheme = "file://";
  const std::string path = uri.starts_with(kFileScheme) ? uri.substr(kFileScheme.size()) : uri;
  std::error_code error;
  const std::filesystem::path beside = folder / path;
  return std::filesystem::exists(beside, error) ? beside : world_.parent_path() / path;
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
