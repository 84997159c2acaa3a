#include "importer/site/sdf_world.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string_view>
#include <system_error>

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

constexpr std::string_view kModelScheme = "model://";

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

std::string unknown_model(const std::string& name) {
  return fmt::format("unknown model \"{0}\": give its folder with --package {0}=FOLDER, or the folder above it in {1}",
                     name, fmt::join(kFolderVariables, " or "));
}

bool is_of_network(std::string_view uri) {
  return uri.starts_with("http://") || uri.starts_with("https://") || uri.starts_with("fuel://");
}

constexpr const char* kGroundPlane =
    R"(<sdf version="1.6"><model name="ground_plane"><static>true</static><link name="link">
<collision name="collision"><geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry></collision>
<visual name="visual"><geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
<material><diffuse>0.7 0.7 0.7 1</diffuse></material></visual></link></model></sdf>)";

constexpr const char* kSun = R"(<sdf version="1.6"><light name="sun" type="directional"><pose>0 0 10 0 0 0</pose>
<diffuse>0.8 0.8 0.8 1</diffuse><direction>-0.5 0.1 -0.9</direction></light></sdf>)";

/// Mutes the reader of URDF, which libsdformat tries when it cannot read a file, and what Ignition Math prints.
class QuietLibraries {
 public:
  QuietLibraries() : before_(std::cerr.rdbuf(muted_.rdbuf())) { console_bridge::noOutputHandler(); }
  ~QuietLibraries() {
    console_bridge::restorePreviousOutputHandler();
    std::cerr.rdbuf(before_);
  }
  QuietLibraries(const QuietLibraries&) = delete;
  QuietLibraries& operator=(const QuietLibraries&) = delete;

 private:
  std::ostringstream muted_;
  std::streambuf* before_;
};

/// Returns the place of an error of libsdformat, with the name of the file as it was given.
std::string place_of(const std::filesystem::path& file, const std::string& path, std::optional<int> line) {
  const bool is_file = path.empty() || path == std::filesystem::absolute(file).string() || path.starts_with('<') ||
                       path.starts_with("data-");
  return (is_file ? file.string() : path) + (line ? fmt::format(":{}", *line) : "");
}

}  // namespace

SdfWorld::SdfWorld(const std::filesystem::path& file, const std::map<std::string, std::filesystem::path>& packages)
    : file_(file), source_(file), packages_(packages, file) {
  sdf::Console::Instance()->SetQuiet(true);
  sdf::ParserConfig config;
  config.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
  config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::LOG);
  config.SetDeprecatedElementsPolicy(sdf::EnforcementPolicy::LOG);
  config.SetFindCallback([this](const std::string& uri) { return find(uri); });
  const QuietLibraries quiet;
  // Absolute: libsdformat would read its own file for a name such as "joint.sdf".
  const sdf::Errors errors = root_.Load(std::filesystem::absolute(file).string(), config);
  if (!errors.empty()) fail(errors.front(), config);
}

BuiltInModels::~BuiltInModels() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

std::filesystem::path BuiltInModels::write(const std::string& name) {
  if (name != "ground_plane" && name != "sun") return {};
  if (folder_.empty())
    folder_ = std::filesystem::temp_directory_path() /
              fmt::format("patrol_sdf_{}_{:x}", ::getpid(), reinterpret_cast<std::uintptr_t>(this));
  const std::filesystem::path folder = folder_ / name;
  std::filesystem::create_directories(folder);
  io::save_text(
      folder / "model.config",
      fmt::format("<model><name>{}</name><version>1.0</version><sdf version=\"1.6\">model.sdf</sdf></model>", name));
  io::save_text(folder / "model.sdf", name == "sun" ? kSun : kGroundPlane);
  return folder;
}

std::string SdfWorld::text_of_unlocated(const sdf::Error& error, const sdf::ParserConfig& config,
                                        std::optional<int>& line) const {
  const std::string text = io::on_one_line(error.Message());
  if (const std::size_t at = text.find("with name["); at != std::string::npos) {
    const std::size_t begin = at + 10;
    line = source_.line_of(text.substr(begin, text.find(']', begin) - begin));
    if (line) return text;
  }
  const bool is_unreadable = error.Code() == sdf::ErrorCode::FILE_READ;
  for (const SdfSource::Part& part : source_.parts()) {
    const sdf::Errors errors = sdf::Root().LoadSdfString(part.text, config);
    const bool is_cause = std::any_of(errors.begin(), errors.end(), [&](const sdf::Error& other) {
      return is_unreadable || other.Message() == error.Message();
    });
    if (!is_cause || errors.front().Code() == sdf::ErrorCode::URI_LOOKUP) continue;
    line = part.line;
    const char* why = "a required element is missing, or a value is not one of those allowed";
    return fmt::format("<{}>: {}", part.element, is_unreadable ? why : text);
  }
  return text;
}

void SdfWorld::fail(const sdf::Error& error, const sdf::ParserConfig& config) const {
  std::string text = io::on_one_line(error.Message());
  if (text.find("http://") != std::string::npos || text.find("https://") != std::string::npos) {
    text = "models of a network are not supported: download it and give its folder with --package: " + text;
  } else if (const std::size_t at = text.find(kModelScheme); at != std::string::npos) {
    const std::size_t begin = at + kModelScheme.size();
    const std::string name = text.substr(begin, text.find_first_of("]/\"' ", begin) - begin);
    text = "<include>: " + unknown_model(name);
  }
  const std::string path = error.FilePath().value_or("");
  std::optional<int> line = error.LineNumber();
  constexpr std::string_view kReading = "Error reading element <";
  if (text.starts_with(kReading)) {
    const std::string element = text.substr(kReading.size(), text.find('>') - kReading.size());
    const auto value = line ? source_.text_at(*line, element) : std::nullopt;
    text = value ? fmt::format("<{}>: \"{}\" is not a valid value", element, *value)
                 : fmt::format("<{}>: is incomplete or invalid", element);
  } else if (!line) {
    text = text_of_unlocated(error, config, line);
  }
  throw InputError(place_of(file_, path, line) + ": " + text);
}

void SdfWorld::fail(const sdf::ElementPtr& element, const std::string& what) const {
  throw InputError(fmt::format("{}: <{}>: {}", place_of(file_, element->FilePath(), element->LineNumber()),
                               element->GetName(), io::on_one_line(what)));
}

std::optional<std::filesystem::path> SdfWorld::find_model(const std::string& name) const {
  if (const auto found = packages_.find(name)) return found;
  std::error_code error;
  for (std::filesystem::path folder = std::filesystem::absolute(file_).parent_path();; folder = folder.parent_path()) {
    const std::filesystem::path model = folder / "models" / name;
    if (std::filesystem::is_directory(model, error)) return model;
    if (folder == folder.root_path()) return find_in_variables(name);
  }
}

std::string SdfWorld::built_in(const std::string& name) {
  const std::filesystem::path folder = built_in_.write(name);
  if (folder.empty()) return {};
  const bool is_new =
      std::none_of(rows_.begin(), rows_.end(), [&](const Assumption& row) { return row.subject == "model://" + name; });
  if (is_new)
    rows_.push_back({"model://" + name,
                     name == "sun" ? "no folder is given: a directional light" : "no folder is given: the plane z = 0",
                     fmt::format("--package {}=FOLDER", name)});
  return folder.string();
}

std::string SdfWorld::find(const std::string& uri) {
  if (is_of_network(uri)) return {};
  if (!uri.starts_with(kModelScheme)) {
    std::error_code error;
    const std::string path = uri.starts_with("file://") ? uri.substr(7) : uri;
    const std::filesystem::path beside = std::filesystem::absolute(file_).parent_path() / path;
    return std::filesystem::exists(beside, error) ? beside.string() : std::string();
  }
  const std::string rest = uri.substr(kModelScheme.size());
  const std::size_t slash = rest.find('/');
  const std::string name = rest.substr(0, slash);
  if (const auto folder = find_model(name))
    return slash == std::string::npos ? folder->string() : (*folder / rest.substr(slash + 1)).string();
  return slash == std::string::npos ? built_in(name) : std::string();
}

std::filesystem::path SdfWorld::resolve(const std::string& uri, const sdf::ElementPtr& element) const {
  if (is_of_network(uri)) fail(element, uri + ": files of a network are not supported");
  std::filesystem::path path;
  if (uri.starts_with(kModelScheme)) {
    const std::string rest = uri.substr(kModelScheme.size());
    const std::string name = rest.substr(0, rest.find('/'));
    const auto folder = find_model(name);
    if (!folder) fail(element, unknown_model(name));
    path = *folder / rest.substr(std::min(rest.size(), name.size() + 1));
  } else if (uri.starts_with("package://") || uri.starts_with("file://")) {
    try {
      path = packages_.resolve(uri);
    } catch (const InputError& error) {
      fail(element, error.what());
    }
  } else {
    const std::filesystem::path beside = std::filesystem::path(element->FilePath()).parent_path() / uri;
    std::error_code error;
    path = std::filesystem::exists(beside, error) ? beside : std::filesystem::absolute(file_).parent_path() / uri;
  }
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) fail(element, uri + ": file not found");
  return path;
}

Pose3 to_pose(const ignition::math::Pose3d& pose) {
  const ignition::math::Vector3d& p = pose.Pos();
  const ignition::math::Quaterniond& q = pose.Rot();
  return {{p.X(), p.Y(), p.Z()}, Eigen::Quaterniond(q.W(), q.X(), q.Y(), q.Z()).normalized()};
}

std::string path_of(const sdf::ElementPtr& element) {
  std::string text;
  for (sdf::ElementPtr at = element; at && at->GetName() != "sdf"; at = at->GetParent()) {
    const std::string name = at->HasAttribute("name") ? " " + at->GetAttribute("name")->GetAsString() : "";
    text = at->GetName() + name + (text.empty() ? "" : " / ") + text;
  }
  return io::on_one_line(text);
}

}  // namespace patrol::importer
