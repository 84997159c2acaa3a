#include "importer/site/sdf_source.h"

#include <algorithm>
#include <array>
#include <functional>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

struct RefusedElement {
  std::string_view element;
  std::string_view text;
};

constexpr std::array kRefusedElements = std::to_array<RefusedElement>({
    {"actor", "animated actors are not supported: add pedestrians to the scenario"},
    {"population", "populations are not supported: write the models out"},
    {"road", "roads are not supported: use a mesh or boxes"},
    {"image", "extruded images are not supported: use a mesh or a floor plan"},
    {"insertions", "insertions of a state are not supported: write the models out"},
    {"deletions", "deletions of a state are not supported: remove the models"},
});

const std::set<std::string_view> kGeometries = {"box",   "capsule", "cylinder", "ellipsoid", "empty", "heightmap",
                                                "image", "mesh",    "plane",    "polyline",  "sphere"};

/// Calls `visit` with the element and all below it, in the order of the file.
void for_each_element(const tinyxml2::XMLElement& element,
                      const std::function<void(const tinyxml2::XMLElement&)>& visit) {
  visit(element);
  for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    for_each_element(*child, visit);
}

}  // namespace

std::optional<std::string_view> sdf_refusal(std::string_view element) {
  const auto found = std::find_if(kRefusedElements.begin(), kRefusedElements.end(),
                                  [&](const RefusedElement& refused) { return refused.element == element; });
  if (found == kRefusedElements.end()) return std::nullopt;
  return found->text;
}

void SdfSource::fail(const tinyxml2::XMLElement& element, const std::string& what) const {
  throw InputError(fmt::format("{}:{}: <{}>: {}", file_.string(), element.GetLineNum(), io::on_one_line(element.Name()),
                               io::on_one_line(what)));
}

SdfSource::SdfSource(const std::filesystem::path& file) : file_(file) {
  const std::string text = io::load_text(file);
  if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS || document_.RootElement() == nullptr)
    throw input_error(file.string(), document_.ErrorLineNum(),
                      fmt::format("not XML: {}", io::on_one_line(document_.ErrorName())));
  const tinyxml2::XMLElement& root = *document_.RootElement();
  if (std::string_view(root.Name()) != "sdf") fail(root, "must be <sdf>");
  const char* version = root.Attribute("version");
  const std::string_view digits = version == nullptr ? "" : version;
  if (digits.size() != 3 || !digits.starts_with("1.") || digits[2] < '0' || digits[2] > '9')
    fail(root, fmt::format("version = \"{}\": must be 1.0 to 1.9", digits));
  int num_worlds = 0;
  for (const auto* child = root.FirstChildElement("world"); child != nullptr;
       child = child->NextSiblingElement("world")) {
    if (++num_worlds > 1) fail(*child, "second world: must be one");
  }
  if (num_worlds == 0) fail(root, "has no <world>: import a world that includes the model");
  check(root);
}

void SdfSource::check(const tinyxml2::XMLElement& element) const {
  const std::string_view name = element.Name();
  if (name == "plugin" || name == "sensor" || name == "gui" || name == "script") return;  // elements of their own
  if (const auto refusal = sdf_refusal(name)) fail(element, std::string(*refusal));
  for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (name == "geometry" && !kGeometries.contains(child->Name())) fail(*child, "is not a geometry of the format");
    check(*child);
  }
}

std::optional<int> SdfSource::line_of(const std::string& name) const {
  std::optional<int> line;
  for_each_element(*document_.RootElement(), [&](const tinyxml2::XMLElement& element) {
    const char* attribute = element.Attribute("name");
    if (attribute != nullptr && name == attribute) line = element.GetLineNum();
  });
  return line;
}

std::vector<SdfSource::Part> SdfSource::parts() const {
  std::vector<Part> parts;
  const tinyxml2::XMLElement& root = *document_.RootElement();
  for (const auto* child = root.FirstChildElement("world")->FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
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
