#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "importer/assumptions.h"
#include "importer/site/sdf_models.h"
#include "importer/site/sdf_source.h"
#include "importer/site/site_import.h"

namespace patrol::importer {

/// Temporary folder that is removed with its content at the end.
class SdfFolder {
 public:
  SdfFolder();
  ~SdfFolder();
  SdfFolder(const SdfFolder&) = delete;
  SdfFolder& operator=(const SdfFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// SDF world and the models that it includes, at any depth, as copies for libsdformat 12. Copies name the files that
/// they include: the library does not find the models that an included model includes, and prefers the working
/// directory. Versions and lines of copies: SdfSource::text.
class SdfFiles {
 public:
  struct File {
    std::filesystem::path path;
    std::filesystem::path copy;
    std::unique_ptr<SdfSource> source;
    std::size_t num_models = 1;  ///< models with all those that they include
  };

  /// `model://ground_plane` and `model://sun` are known without a folder. Throws InputError "file:line: ..." for what
  /// SdfSource refuses, and for models that are not found or include themselves, or are more than 100,000. The error
  /// about models that are not found names all of them. Uses `file`, `packages`, `without`, `xacro_arguments` and
  /// `python`. The arguments must outlive the object.
  SdfFiles(const SiteImportOptions& options, const SdfModels& models);

  const File& world() const { return files_.back(); }

  /// Each file follows those that it includes; the world is the last one. Files of URDF are missing.
  const std::vector<File>& files() const { return files_; }

  /// Returns the file of a copy; nullptr if the path is not one.
  const File* find_copy(const std::filesystem::path& copy) const;

  const std::vector<Assumption>& rows() const { return rows_; }

 private:
  /// Model that is not found.
  struct Missing {
    std::string location;  ///< "file:line"
    std::string uri;
  };

  const File* find(const std::filesystem::path& path) const;
  File read(const std::filesystem::path& path, SdfContent content);
  const File& add(File file);
  void take(SdfSource& source, tinyxml2::XMLElement& include, std::size_t& num_models);
  std::optional<std::filesystem::path> resolve(const SdfSource& source, const tinyxml2::XMLElement& uri);
  /// Returns the file of the plain ground plane or the sun of Gazebo, as a model or from Fuel; none for other models.
  std::optional<std::filesystem::path> built_in(const std::string& uri);

  const SiteImportOptions& options_;
  const SdfModels& models_;
  SdfFolder folder_;
  std::vector<File> files_;
  std::vector<std::filesystem::path> open_;  ///< files whose models are being read, outermost first
  std::vector<Missing> missing_;
  std::vector<Assumption> rows_;
};

}  // namespace patrol::importer
