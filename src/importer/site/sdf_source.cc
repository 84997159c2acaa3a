#include "importer/site/sdf_source.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "io/files/one_line.h"
#include "io/files/utf16_mark.h"
#include "io/files/xml_problem.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::importer {
namespace {

struct RefusedElement {
  std::string_view element;
  std::string_view text;
};

constexpr std::array kRefusedElements = std::to_array<RefusedElement>({
    {"population", "populations are not supported: write the models out"},
    {"image", "extruded images are not supported: use a mesh or a floor plan"},
    {"insertions", "insertions of a state are not supported: write the models out"},
    {"deletions", "deletions of a state are not supported: remove the models"},
});

/// Minor versions of SDF 1 whose elements are known here. libsdformat converts older ones only below a root <gazebo>,
/// and reads their poses and sizes as the defaults otherwise.
constexpr int kMinMinorVersion = 3, kMaxMinorVersion = 12;
constexpr const char* kOldSyntaxHint = ": write <origin pose=\"...\"> as <pose>, and attributes as elements";

const std::set<std::string_view> kGeometries = {"box",       "cone",  "capsule", "cylinder", "ellipsoid", "empty",
                                                "heightmap", "image", "mesh",    "plane",    "polyline",  "sphere"};

/// Calls `visit` with the element and all below it, in the order of the file.
void for_each_element(const tinyxml2::XMLElement& element,
                      const std::function<void(const tinyxml2::XMLElement&)>& visit) {
  visit(element);
  for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    for_each_element(*child, visit);
}

/// Elements whose content is not that of a site.
bool is_opaque(std::string_view element) {
  return element == "plugin" || element == "sensor" || element == "gui" || element == "script";
}

/// Printer that starts every element in its line of the file.
class LinePrinter : public tinyxml2::XMLPrinter {
 public:
  LinePrinter() : tinyxml2::XMLPrinter(nullptr, true) {}

  bool VisitEnter(const tinyxml2::XMLElement& element, const tinyxml2::XMLAttribute* attribute) override {
    const int missing = element.GetLineNum() - line_;
    if (missing > 0) PushText(std::string(static_cast<std::size_t>(missing), '\n').c_str());
    return tinyxml2::XMLPrinter::VisitEnter(element, attribute);
  }
  using tinyxml2::XMLPrinter::VisitEnter;

 protected:
  void Write(const char* data, std::size_t size) override {
    line_ += static_cast<int>(std::count(data, data + size, '\n'));
    tinyxml2::XMLPrinter::Write(data, size);
  }
  void Putc(char c) override {
    line_ += c == '\n' ? 1 : 0;
    tinyxml2::XMLPrinter::Putc(c);
  }

 private:
  int line_ = 1;
};

/// Refuses a text that is not XML because of its encoding, or because it is of another simulator.
void refuse_other_text(const std::filesystem::path& file, std::string_view text) {
  if (io::has_utf16_mark(text)) throw InputError(fmt::format("{}: {}", file.string(), io::kUtf16Refusal));
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string_view::npos || text[first] == '<') return;
  throw InputError(
      file.string() +
      ": not XML: must be SDF; of a world of Stage, import the picture of its map as a floor plan (.yaml)");
}

void add_includes(tinyxml2::XMLElement& element, std::vector<tinyxml2::XMLElement*>& includes) {
  if (is_opaque(element.Name())) return;
  for (auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (std::string_view(child->Name()) == "include") includes.push_back(child);
    else add_includes(*child, includes);
  }
}

}  // namespace

std::optional<int> minor_sdf_version(std::string_view version) {
  if (!version.starts_with("1.")) return std::nullopt;
  const std::string_view digits = version.substr(2);
  int minor = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), minor);
  const bool is_number = error == std::errc() && end == digits.data() + digits.size() && minor >= 0;
  return is_number ? std::optional(minor) : std::nullopt;
}

std::optional<std::string_view> sdf_refusal(std::string_view element) {
  const auto found = std::find_if(kRefusedElements.begin(), kRefusedElements.end(),
                                  [&](const RefusedElement& refused) { return refused.element == element; });
  if (found == kRefusedElements.end()) return std::nullopt;
  return found->text;
}

void SdfSource::fail(const tinyxml2::XMLElement& element, const std::string& what) const {
  throw InputError(fmt::format("{}: <{}>: {}", location(element.GetLineNum()), io::on_one_line(element.Name()),
                               io::on_one_line(what)));
}

SdfSource::SdfSource(const std::filesystem::path& file, std::string_view text, SdfContent content) : file_(file) {
  refuse_other_text(file, text);
  if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS || document_.RootElement() == nullptr)
    throw input_error(file.string(), document_.ErrorLineNum(), "not XML: " + io::xml_problem(document_));
  positions_ = take_positions(document_);
  const tinyxml2::XMLElement& root = *document_.RootElement();
  if (std::string_view(root.Name()) != "sdf") fail(root, "must be <sdf>");
  const char* version = root.Attribute("version");
  const std::string_view digits = version == nullptr ? "" : version;
  const int minor = minor_sdf_version(digits).value_or(kMaxMinorVersion + 1);
  if (minor < kMinMinorVersion || minor > kMaxMinorVersion)
    fail(root, fmt::format("version = \"{}\": must be 1.{} to 1.{}{}", digits, kMinMinorVersion, kMaxMinorVersion,
                           minor < kMinMinorVersion ? kOldSyntaxHint : ""));
  check_content(content);
  left_out_ = leave_out_elements(*document_.RootElement());
  check(root);
  if (minor > kMaxLibraryVersion)
    document_.RootElement()->SetAttribute("version", fmt::format("1.{}", kMaxLibraryVersion).c_str());
}

void SdfSource::check_content(SdfContent content) {
  const tinyxml2::XMLElement& root = *document_.RootElement();
  const bool is_world = content == SdfContent::kWorld;
  int count = 0;
  for (const auto* child = root.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    const std::string_view name = child->Name();
    const bool is_content = is_world ? name == "world" : name == "model" || name == "light" || name == "actor";
    if (is_content && ++count > 1) fail(*child, fmt::format("second {}: must be one", name));
    if (is_content) content_ = name;
  }
  if (count > 0) return;
  fail(root, is_world ? "has no <world>: import a world that includes the model" : "has no <model> to include");
}

void SdfSource::leave_out(tinyxml2::XMLElement& include, const std::string& content) {
  if (auto row = left_out_element(content, include.GetLineNum())) left_out_.push_back(*std::move(row));
  include.Parent()->DeleteChild(&include);
}

void SdfSource::leave_out_models(const std::set<std::string>& names) {
  if (names.empty()) return;
  const std::set<std::string> known = importer::leave_out_models(*document_.RootElement(), names);
  for (const std::string& name : names) {
    if (known.contains(name)) continue;
    std::vector<std::string> names_of_world(known.begin(), known.end());
    const std::string match = io::closest_match(name, names_of_world);
    constexpr std::size_t kMaxNames = 20;
    const bool is_cut = names_of_world.size() > kMaxNames;
    if (is_cut) names_of_world.resize(kMaxNames);
    const std::string hint = match.empty()
                                 ? fmt::format("it has {}{}", fmt::join(names_of_world, ", "), is_cut ? ", ..." : "")
                                 : fmt::format("did you mean {}?", match);
    throw InputError(
        io::on_one_line(fmt::format("--without {}: is not a model of {}: {}", name, file_.string(), hint)));
  }
}

std::vector<tinyxml2::XMLElement*> SdfSource::includes() {
  std::vector<tinyxml2::XMLElement*> includes;
  add_includes(*document_.RootElement(), includes);
  return includes;
}

std::string SdfSource::text() const {
  LinePrinter printer;
  document_.Accept(&printer);
  return printer.CStr();
}

void SdfSource::check(const tinyxml2::XMLElement& element) const {
  const std::string_view name = element.Name();
  if (is_opaque(name)) return;
  if (const auto refusal = sdf_refusal(name)) fail(element, std::string(*refusal));
  for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (name == "geometry" && !kGeometries.contains(child->Name())) fail(*child, "is not a geometry of the format");
    check(*child);
  }
}

const tinyxml2::XMLElement* SdfSource::named(const std::string& name,
                                             const std::function<bool(const tinyxml2::XMLElement&)>& wanted) const {
  const tinyxml2::XMLElement* last = nullptr;
  for_each_element(*document_.RootElement(), [&](const tinyxml2::XMLElement& element) {
    const char* attribute = element.Attribute("name");
    if (attribute != nullptr && name == attribute && wanted(element)) last = &element;
  });
  return last;
}

std::optional<int> SdfSource::line_of_first(const std::string& name) const {
  std::optional<int> line;
  for_each_element(*document_.RootElement(), [&](const tinyxml2::XMLElement& element) {
    if (!line && name == element.Name()) line = element.GetLineNum();
  });
  return line;
}

std::vector<SdfSource::Part> SdfSource::parts() const {
  std::vector<Part> parts;
  const tinyxml2::XMLElement& root = *document_.RootElement();
  const tinyxml2::XMLElement* world = root.FirstChildElement("world");
  if (world == nullptr) return parts;
  for (const auto* child = world->FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    tinyxml2::XMLPrinter printer;
    child->Accept(&printer);
    parts.push_back({.line = child->GetLineNum(),
                     .element = child->Name(),
                     .text = fmt::format("<sdf version=\"{}\"><world name=\"part\">{}</world></sdf>",
                                         root.Attribute("version"), printer.CStr())});
  }
  return parts;
}

std::optional<std::string> SdfSource::text_at(int line, std::string_view name) const {
  std::optional<std::string> text;
  for_each_element(*document_.RootElement(), [&](const tinyxml2::XMLElement& element) {
    if (element.GetLineNum() != line || name != element.Name() || element.FirstChildElement() != nullptr) return;
    const char* content = element.GetText();
    text = io::on_one_line(content == nullptr ? "" : content);
  });
  return text;
}

}  // namespace patrol::importer
