#include "importer/packages.h"

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/error.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

constexpr int kMaxFoldersAbove = 3;                // searched for a mesh
constexpr int kMaxDepth = 6, kMaxEntries = 20000;  // of the search for the name of a mesh

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

/// Returns the parts of a path of a description behind its scheme, package, root and leading "..".
std::filesystem::path tail_of(const std::string& uri) {
  const std::size_t scheme = uri.find("://");
  std::string rest = scheme == std::string::npos ? uri : uri.substr(scheme + 3);
  if (scheme != std::string::npos && !uri.starts_with("file://")) rest.erase(0, std::min(rest.find('/'), rest.size()));
  std::filesystem::path tail;
  for (const auto& part : std::filesystem::path(rest).relative_path()) {
    if (!tail.empty() || (part != ".." && part != ".")) tail /= part;
  }
  return tail;
}

}  // namespace

Packages::Packages(std::map<std::string, std::filesystem::path> given, const std::filesystem::path& file)
    : given_(std::move(given)), folder_(std::filesystem::absolute(file).lexically_normal().parent_path()) {
  std::error_code error;
  for (const auto& [name, folder] : given_) {
    if (std::filesystem::is_directory(folder, error)) continue;
    throw InputError(
        fmt::format("--package {}={}: folder not found", io::on_one_line(name), io::on_one_line(folder.string())));
  }
}

std::optional<std::filesystem::path> Packages::find(const std::string& package) const {
  if (const auto found = given(package)) return found;
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

std::optional<std::filesystem::path> Packages::given(const std::string& package) const {
  const auto found = given_.find(package);
  return found == given_.end() ? std::nullopt : std::optional(std::filesystem::absolute(found->second));
}

std::vector<std::filesystem::path> Packages::with_folders_above(std::filesystem::path folder) {
  std::vector<std::filesystem::path> folders = {folder};
  for (int i = 0; i < kMaxFoldersAbove && folder != folder.root_path(); ++i) {
    folder = folder.parent_path();
    folders.push_back(folder);
  }
  return folders;
}

std::vector<std::filesystem::path> Packages::ends_of(const std::string& uri) {
  std::vector<std::filesystem::path> parts, ends;
  for (const auto& part : tail_of(uri)) parts.push_back(part);
  for (std::size_t first = 0; first < parts.size() && (first == 0 || first + 1 < parts.size()); ++first) {
    std::filesystem::path end;
    for (std::size_t i = first; i < parts.size(); ++i) end /= parts[i];
    ends.push_back(end);
  }
  return ends;
}

std::optional<std::filesystem::path> Packages::with_name(const std::string& name) const {
  std::error_code error;
  std::filesystem::path root = folder_, folder = folder_;
  for (int i = 0; i <= kMaxFoldersAbove && folder != folder.root_path(); ++i, folder = folder.parent_path()) {
    if (!std::filesystem::exists(folder / "package.xml", error)) continue;
    root = folder;
    break;
  }
  std::optional<std::filesystem::path> found;
  int num_entries = 0;
  std::filesystem::recursive_directory_iterator at(root, std::filesystem::directory_options::skip_permission_denied,
                                                   error);
  for (; !error && at != std::filesystem::recursive_directory_iterator(); at.increment(error)) {
    if (++num_entries > kMaxEntries) return std::nullopt;
    if (at.depth() > kMaxDepth || at->path().filename().string().starts_with('.')) at.disable_recursion_pending();
    if (at->path().filename() != name || !at->is_regular_file(error)) continue;
    if (found) return std::nullopt;
    found = at->path();
  }
  return found;
}

std::filesystem::path Packages::find_mesh(const std::string& uri) const {
  std::error_code error;
  std::filesystem::path named;
  std::string unknown_package;
  try {
    named = resolve(uri);
    if (std::filesystem::is_regular_file(named, error)) return named;
  } catch (const InputError& refused) {
    unknown_package = refused.what();
  }
  const std::vector<std::filesystem::path> ends = ends_of(uri);
  for (const std::filesystem::path& end : ends) {
    for (const std::filesystem::path& folder : with_folders_above(folder_)) {
      if (std::filesystem::is_regular_file(folder / end, error)) return folder / end;
    }
  }
  if (!ends.empty()) {
    if (const auto found = with_name(ends.back().filename().string())) return *found;
  }
  if (!unknown_package.empty()) throw InputError(unknown_package);
  throw MeshNotFound(
      fmt::format("{}: mesh file not found: put it there, or give the folder of its package with --package NAME=FOLDER",
                  named.string()));
}

std::string Packages::relative(const std::filesystem::path& path) const {
  return path.lexically_normal().lexically_proximate(folder_).string();
}

}  // namespace patrol::importer
