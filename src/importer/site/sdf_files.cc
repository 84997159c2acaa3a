#include "importer/site/sdf_files.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sdf/sdf.hh>
#include <tinyxml2.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "importer/site/fuel_models.h"
#include "importer/xacro.h"
#include "importer/xml_elements.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

constexpr std::size_t kMaxModels = 100'000;

constexpr const char* kGroundPlane =
    R"(<sdf version="1.6"><model name="ground_plane"><static>true</static><link name="link">
<collision name="collision"><geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry></collision>
<visual name="visual"><geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
<material><diffuse>0.7 0.7 0.7 1</diffuse></material></visual></link></model></sdf>)";

constexpr const char* kSun = R"(<sdf version="1.6"><light name="sun" type="directional"><pose>0 0 10 0 0 0</pose>
<diffuse>0.8 0.8 0.8 1</diffuse><direction>-0.5 0.1 -0.9</direction></light></sdf>)";

/// Returns whether libsdformat reads the file as URDF.
bool is_urdf(const std::filesystem::path& file) {
  tinyxml2::XMLDocument document;
  return document.LoadFile(file.c_str()) == tinyxml2::XML_SUCCESS && document.RootElement() != nullptr &&
         std::string_view(document.RootElement()->Name()) == "robot";
}

}  // namespace

SdfFolder::SdfFolder() {
  std::string name =
      (std::filesystem::temp_directory_path() / fmt::format("patrol_sdf_{}_XXXXXX", ::getpid())).string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be created");
  path_ = name;
}

SdfFolder::~SdfFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

SdfFiles::SdfFiles(const SiteImportOptions& options, const SdfModels& models) : options_(options), models_(models) {
  File file = read(options.file, SdfContent::kWorld);
  file.source->leave_out_models(options.without);
  for (const std::string& name : options.without)
    rows_.push_back({"model " + io::on_one_line(name), "left out", "--without"});
  add(std::move(file));
  if (missing_.empty()) return;
  std::vector<std::string> uris;
  for (const Missing& missing : missing_) {
    if (std::find(uris.begin(), uris.end(), missing.uri) == uris.end()) uris.push_back(missing.uri);
  }
  throw InputError(fmt::format("{}: <include>: {}", missing_.front().location, io::on_one_line(unknown_models(uris))));
}

const SdfFiles::File* SdfFiles::find(const std::filesystem::path& path) const {
  const auto known = std::find_if(files_.begin(), files_.end(), [&](const File& file) { return file.path == path; });
  return known == files_.end() ? nullptr : &*known;
}

SdfFiles::File SdfFiles::read(const std::filesystem::path& path, SdfContent content) {
  XacroOptions xacro{.arguments = {}, .packages = options_.packages, .python = options_.python};
  if (content == SdfContent::kWorld) xacro.arguments = options_.xacro_arguments;
  const ExpandedFile loaded = load_expanded(path, xacro);
  rows_.insert(rows_.end(), loaded.rows.begin(), loaded.rows.end());
  return {.path = path, .copy = {}, .source = std::make_unique<SdfSource>(path, loaded.text, content)};
}

const SdfFiles::File& SdfFiles::add(File file) {
  open_.push_back(file.path);
  for (tinyxml2::XMLElement* include : file.source->includes()) {
    const int line = include->GetLineNum();
    if (include->FirstChildElement("uri") == nullptr) file.source->fail(*include, "has no <uri>");
    take(*file.source, *include, file.num_models);
    if (file.num_models > kMaxModels)
      throw InputError(fmt::format("{}: <include>: {} models: must be at most {}", file.source->location(line),
                                   file.num_models, kMaxModels));
  }
  open_.pop_back();
  file.copy = folder_.path() / fmt::format("{}.sdf", files_.size());
  io::save_text(file.copy, file.source->text());
  return files_.emplace_back(std::move(file));
}

void SdfFiles::take(SdfSource& source, tinyxml2::XMLElement& include, std::size_t& num_models) {
  // libsdformat reads the text of these elements without a check.
  for (const char* name : {"uri", "name", "static", "placement_frame"}) {
    const tinyxml2::XMLElement* child = include.FirstChildElement(name);
    if (child != nullptr && child->GetText() == nullptr) source.fail(*child, "is empty");
  }
  tinyxml2::XMLElement& uri = *include.FirstChildElement("uri");
  const auto path = resolve(source, uri);
  if (!path) return;
  if (std::find(open_.begin(), open_.end(), *path) != open_.end())
    source.fail(include, fmt::format("\"{}\": the model includes itself", uri.GetText()));
  const File* included = find(*path);
  if (included == nullptr && is_urdf(*path)) return uri.SetText(path->c_str());
  if (included == nullptr) {
    File file = read(*path, SdfContent::kModel);
    if (file.source->is_left_out()) return source.leave_out(include, file.source->content());
    included = &add(std::move(file));
  }
  num_models += included->num_models;
  uri.SetText(included->copy.c_str());
}

std::optional<std::filesystem::path> SdfFiles::resolve(const SdfSource& source, const tinyxml2::XMLElement& element) {
  const auto fail = [&](const std::string& what) {
    return InputError(source.location(element.GetLineNum()) + ": " + io::on_one_line(what));
  };
  const std::string uri = trimmed(element.GetText());
  auto path = models_.find_uri(uri, std::filesystem::absolute(source.file()).parent_path());
  std::error_code error;
  if (!path) path = built_in(uri);
  if (!is_of_network(uri) && (!path || !std::filesystem::exists(*path, error))) {
    // The folders that libsdformat searches: the working directory and those of SDF_PATH.
    if (const std::string found = sdf::findFile(uri, true, false); !found.empty()) path = found;
  }
  if (!path && !name_in(uri).empty()) {
    missing_.push_back({source.location(element.GetLineNum()), uri});
    return std::nullopt;
  }
  if (!path) throw fail(fmt::format("<include>: {}: names no model", uri));
  try {
    if (std::filesystem::is_directory(*path, error)) path = sdf_file_of_model(*path);
  } catch (const InputError& unknown) {
    throw fail(fmt::format("<include>: {}", unknown.what()));
  }
  if (!std::filesystem::is_regular_file(*path, error)) throw fail("<include>: " + unknown_file(uri));
  return std::filesystem::absolute(*path).lexically_normal();
}

std::optional<std::filesystem::path> SdfFiles::built_in(const std::string& uri) {
  std::string name = name_in(uri);
  if (const std::optional<FuelModel> model = fuel_model(uri)) {
    const bool is_of_gazebo = model->owner.empty() || to_lower(model->owner) == "openrobotics";
    if (!is_of_gazebo || !model->file.empty()) return std::nullopt;
    name = to_lower(name);
    std::replace(name.begin(), name.end(), ' ', '_');
  } else if (uri != std::string(kModelScheme) + name) {
    return std::nullopt;
  }
  if (name != "ground_plane" && name != "sun") return std::nullopt;
  const std::filesystem::path file = folder_.path() / (name + ".sdf");
  if (std::filesystem::exists(file)) return file;
  io::save_text(file, name == "sun" ? kSun : kGroundPlane);
  if (name == "ground_plane")
    rows_.push_back({io::on_one_line(uri), "no folder is given: the plane z = 0",
                     fmt::format("--package \"{}=FOLDER\"", name_in(uri))});
  return file;
}

const SdfFiles::File* SdfFiles::find_copy(const std::filesystem::path& copy) const {
  const auto found = std::find_if(files_.begin(), files_.end(), [&](const File& file) { return file.copy == copy; });
  return found == files_.end() ? nullptr : &*found;
}

}  // namespace patrol::importer
