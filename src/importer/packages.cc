#include "importer/packages.h"

#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/error.h"

namespace patrol::importer {
namespace {

/// Returns the name in a folder's package.xml; empty if there is none.
std::string package_name(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "package.xml";
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return "";
  tinyxml2::XMLDocument document;
  if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) return "";
  const tinyxml2::XMLElement* package = document.FirstChildElement("package");
  const tinyxml2::XMLElement* name = package != nullptr ? package->FirstChildElement("name") : nullptr;
  return name != nullptr && name->GetText() != nullptr ? name->GetText() : "";
}

}  // namespace

Packages::Packages(std::map<std::string, std::filesystem::path> given, const std::filesystem::path& file)
    : given_(std::move(given)), folder_(std::filesystem::absolute(file).lexically_normal().parent_path()) {}

std::optional<std::filesystem::path> Packages::find(const std::string& package) const {
  if (const auto found = given_.find(package); found != given_.end()) return std::filesystem::absolute(found->second);
  std::error_code error;
  for (std::filesystem::path folder = folder_; !folder.empty(); folder = folder.parent_path()) {
    if (folder.filename() == package || package_name(folder) == package) return folder;
    if (const auto inside = folder / package; std::filesystem::is_directory(inside, error)) return inside;
    if (folder == folder.root_path()) break;
    // Packages beside the file's package, with folders of other names.
    if (!std::filesystem::exists(folder / "package.xml", error)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder.parent_path(), error)) {
      if (entry.is_directory(error) && package_name(entry.path()) == package) return entry.path();
    }
  }
  return std::nullopt;
}

std::filesystem::path Packages::resolve(const std::string& uri) const {
  for (const std::string scheme : {"package://", "model://"}) {
    if (!uri.starts_with(scheme)) continue;
    const std::string rest = uri.substr(scheme.size());
    const std::size_t slash = rest.find('/');
    const std::string package = rest.substr(0, slash);
    const auto folder = find(package);
    if (!folder) {
      throw InputError(fmt::format("unknown package \"{0}\": give its folder with --package {0}=FOLDER", package));
    }
    return slash == std::string::npos ? *folder : *folder / rest.substr(slash + 1);
  }
  if (uri.starts_with("file://")) {
    const std::filesystem::path path = uri.substr(7);
    return path.is_absolute() ? path : folder_ / path;
  }
  return folder_ / uri;
}

}  // namespace patrol::importer
