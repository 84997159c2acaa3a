#include "importer/output_folder.h"

#include <unistd.h>

#include <system_error>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

std::filesystem::path without_last_slash(const std::filesystem::path& folder) {
  if (folder.empty()) throw InputError("output folder: is empty: must be the path of a folder");
  const std::filesystem::path normal = std::filesystem::absolute(folder).lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

}  // namespace

OutputFolder::OutputFolder(const std::filesystem::path& target)
    : target_(without_last_slash(target)),
      staging_(fmt::format("{}.{}{}", target_.string(), ::getpid(), kStagingExtension)) {
  std::error_code error;
  if (std::filesystem::exists(target_, error) &&
      (!std::filesystem::is_directory(target_, error) || !std::filesystem::is_empty(target_, error)))
    throw InputError(target_.string() + ": exists and is not an empty folder");
  std::filesystem::remove_all(staging_, error);
  std::filesystem::create_directories(staging_, error);
  if (error) throw InputError(fmt::format("{}: cannot be written: {}", target_.string(), error.message()));
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(staging_, ignored);
}

void OutputFolder::publish() {
  std::error_code error;
  std::filesystem::remove(target_, error);  // an empty folder
  std::filesystem::rename(staging_, target_, error);
  if (error) throw InputError(fmt::format("{}: cannot be written: {}", target_.string(), error.message()));
}

void require_folder_name(const std::string& name, const std::string& file, const char* subject) {
  const bool is_path = name.find('/') != std::string::npos || name == "." || name == "..";
  if (name.empty() || is_path || io::has_control_characters(name) || !io::is_utf8(name)) {
    throw InputError(
        fmt::format("{}: name of the {} = \"{}\": must be the name of a folder", file, subject, io::on_one_line(name)));
  }
}

}  // namespace patrol::importer
