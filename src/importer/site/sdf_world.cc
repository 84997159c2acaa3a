#include "importer/site/sdf_world.h"

#include <algorithm>
#include <iostream>
#include <sstream>
#include <string_view>
#include <system_error>

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/error.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

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

  /// Returns whether libsdformat printed errors: it does not return those of models that an included model includes.
  bool has_errors() const { return muted_.str().find("Error Code") != std::string::npos; }

 private:
  std::ostringstream muted_;
  std::streambuf* before_;
};

/// Returns the text of an error about a cycle of frames, and its line; none if it is another error.
std::optional<std::string> text_of_cycle(const SdfSource& source, const std::string& text, std::optional<int>& line) {
  constexpr std::string_view kVertex = "cycle detected, already visited vertex [";
  const std::size_t at = text.find(kVertex);
  if (at == std::string::npos) return std::nullopt;
  std::string name = text.substr(at + kVertex.size(), text.find(']', at + kVertex.size()) - at - kVertex.size());
  if (const std::size_t scope = name.rfind("::"); scope != std::string::npos) name = name.substr(scope + 2);
  const bool is_attached = text.starts_with("FrameAttachedTo");
  const tinyxml2::XMLElement* frame = source.named(name, [&](const tinyxml2::XMLElement& element) {
    const tinyxml2::XMLElement* pose = element.FirstChildElement("pose");
    return is_attached ? element.Attribute("attached_to") != nullptr
                       : pose != nullptr && pose->Attribute("relative_to") != nullptr;
  });
  if (frame == nullptr) return std::nullopt;
  line = frame->GetLineNum();
  return fmt::format("<{}>: \"{}\": {}: cycle of frames: must lead to a link, a model or the world", frame->Name(),
                     name, is_attached ? "attached_to" : "relative_to");
}

/// Returns the text of an error without a line, and its line in the source if it is found.
std::string text_of_unlocated(const SdfSource& source, const sdf::Error& error, const sdf::ParserConfig& config,
                              std::optional<int>& line) {
  const std::string text = io::on_one_line(error.Message());
  if (const auto cycle = text_of_cycle(source, text, line)) return *cycle;
  if (const std::size_t at = text.find("with name["); at != std::string::npos) {
    const std::size_t begin = at + 10;
    const std::string name = text.substr(begin, text.find(']', begin) - begin);
    const tinyxml2::XMLElement* element = source.named(name, [](const tinyxml2::XMLElement&) { return true; });
    if (element != nullptr) {
      line = element->GetLineNum();
      return text;
    }
  }
  const bool is_unreadable = error.Code() == sdf::ErrorCode::FILE_READ;
  for (const SdfSource::Part& part : source.parts()) {
    const sdf::Errors errors = sdf::Root().LoadSdfString(part.text, config);
    const bool is_cause = std::any_of(errors.begin(), errors.end(), [&](const sdf::Error& other) {
      return is_unreadable || other.Message() == error.Message();
    });
    if (!is_cause) continue;
    line = part.line;
    const char* why = "a required element is missing, or a value is not one of those allowed";
    return fmt::format("<{}>: {}", part.element, is_unreadable ? why : text);
  }
  return text;
}

}  // namespace

SdfWorld::SdfWorld(const SiteImportOptions& options)
    : models_(options.file, options.packages), files_(options, models_) {
  sdf::Console::Instance()->SetQuiet(true);
  sdf::ParserConfig config;
  config.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
  config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::LOG);
  config.SetDeprecatedElementsPolicy(sdf::EnforcementPolicy::LOG);
  const QuietLibraries quiet;
  const sdf::Errors errors = root_.Load(files_.world().copy.string(), config);
  if (!errors.empty() || quiet.has_errors()) fail(errors, config);
}

void SdfWorld::fail(const sdf::Errors& errors, const sdf::ParserConfig& config) const {
  const bool is_located =
      !errors.empty() && errors.front().LineNumber() && errors.front().Code() != sdf::ErrorCode::FILE_READ;
  for (const SdfFiles::File& file : files_.files()) {
    if (is_located || &file == &files_.world()) break;
    const sdf::Errors of_file = sdf::Root().Load(file.copy.string(), config);
    const bool is_cause = std::any_of(of_file.begin(), of_file.end(), [&](const sdf::Error& other) {
      return errors.empty() || other.Code() == errors.front().Code();
    });
    if (is_cause) fail(file, of_file.front(), config);
  }
  if (errors.empty())
    throw InputError(files_.world().source->file().string() + ": a model that it includes is invalid");
  const SdfFiles::File* file = files_.find_copy(errors.front().FilePath().value_or(""));
  fail(file != nullptr ? *file : files_.world(), errors.front(), config);
}

void SdfWorld::fail(const SdfFiles::File& file, const sdf::Error& error, const sdf::ParserConfig& config) const {
  std::string text = io::on_one_line(error.Message());
  std::optional<int> line = error.LineNumber();
  constexpr std::string_view kReading = "Error reading element <";
  if (text.starts_with(kReading)) {
    const std::string element = text.substr(kReading.size(), text.find('>') - kReading.size());
    const auto value = line ? file.source->text_at(*line, element) : std::nullopt;
    text = value ? fmt::format("<{}>: \"{}\" is not a valid value", element, *value)
                 : fmt::format("<{}>: is incomplete or invalid", element);
  } else if (!line) {
    text = text_of_unlocated(*file.source, error, config, line);
  }
  throw InputError(place_of(file.copy, line) + ": " + text);
}

void SdfWorld::fail(const sdf::ElementPtr& element, const std::string& what) const {
  throw InputError(fmt::format("{}: <{}>: {}", place_of(element->FilePath(), element->LineNumber()), element->GetName(),
                               io::on_one_line(what)));
}

std::string SdfWorld::place_of(const std::filesystem::path& path, std::optional<int> line) const {
  const SdfFiles::File* copied = files_.find_copy(path);
  if (copied == nullptr && path.empty()) copied = &files_.world();
  if (copied != nullptr) return copied->source->location(line.value_or(0));
  return path.string() + (line ? fmt::format(":{}", *line) : "");
}

std::string SdfWorld::short_location_of(const SdfFiles::File& file, std::optional<int> line) const {
  if (file.source->is_expanded())
    return std::filesystem::path(file.source->location(line.value_or(0))).filename().string();
  if (&file == &files_.world()) return line ? fmt::format("line {}", *line) : std::string();
  return (file.path.parent_path().filename() / file.path.filename()).string() + (line ? fmt::format(":{}", *line) : "");
}

std::string SdfWorld::short_location_of(const sdf::ElementPtr& element) const {
  const std::optional<int> line = element->LineNumber();
  const SdfFiles::File* file = files_.find_copy(element->FilePath());
  if (line) return short_location_of(file != nullptr ? *file : files_.world(), line);
  for (auto at = files_.files().rbegin(); at != files_.files().rend(); ++at) {
    if (const auto first = at->source->line_of_first(element->GetName())) return short_location_of(*at, first);
  }
  return {};
}

std::filesystem::path SdfWorld::resolve(const std::string& uri, const sdf::ElementPtr& element) const {
  if (const auto model = fuel_model(uri); is_of_network(uri) && (!model || model->file.empty()))
    fail(element, uri + ": files of a network are not supported");
  std::optional<std::filesystem::path> path;
  if (uri.starts_with("package://")) {
    try {
      path = models_.packages().resolve(uri);
    } catch (const InputError& error) {
      fail(element, error.what());
    }
  } else {
    const SdfFiles::File* file = files_.find_copy(element->FilePath());
    const std::filesystem::path including(file != nullptr ? file->path.string() : element->FilePath());
    path = models_.find_uri(uri, std::filesystem::absolute(including).parent_path());
  }
  if (!path) fail(element, unknown_model(uri));
  std::error_code error;
  if (!std::filesystem::is_regular_file(*path, error)) fail(element, unknown_file(uri));
  return *path;
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
