#include "importer/site/sdf_left_out.h"

#include <algorithm>
#include <array>

#include "importer/xml_elements.h"

namespace patrol::importer {
namespace {

/// Element that is left out, with the texts of its row. Empty text: it has no row.
struct LeftOutKind {
  std::string_view element;
  std::string_view text;
  std::string_view override_with;
};

constexpr std::array kLeftOut = std::to_array<LeftOutKind>({
    {"light", "ignored: the site has one sun", "the file"},
    {"actor", "left out: animated actors are not supported", "pedestrians in the scenario"},
    {"road", "left out: a picture without contact", "a mesh or boxes"},
    {"inertial", "", ""},
});

const LeftOutKind* kind_of(std::string_view element) {
  const auto found =
      std::find_if(kLeftOut.begin(), kLeftOut.end(), [&](const LeftOutKind& kind) { return kind.element == element; });
  return found == kLeftOut.end() ? nullptr : &*found;
}

/// Elements that keep their content.
bool keeps_content(std::string_view element) {
  return element == "plugin" || element == "sensor" || element == "gui" || element == "state";
}

std::string name_of_include(const tinyxml2::XMLElement& include) {
  if (const auto* name = include.FirstChildElement("name")) return trimmed(name->GetText());
  const auto* uri = include.FirstChildElement("uri");
  const std::string text = uri == nullptr ? "" : trimmed(uri->GetText());
  const std::size_t end = text.find_last_not_of('/');
  const std::string path = text.substr(0, end == std::string::npos ? 0 : end + 1);
  return path.substr(path.rfind('/') + 1);
}

void leave_out_below(tinyxml2::XMLElement& element, std::vector<LeftOutElement>& left_out) {
  for (auto* child = element.FirstChildElement(); child != nullptr;) {
    auto* next = child->NextSiblingElement();
    if (kind_of(child->Name()) != nullptr) {
      if (auto row = left_out_element(child->Name(), child->GetLineNum())) left_out.push_back(*std::move(row));
      element.DeleteChild(child);
    } else if (!keeps_content(child->Name())) {
      leave_out_below(*child, left_out);
    }
    child = next;
  }
}

}  // namespace

std::optional<LeftOutElement> left_out_element(std::string_view element, int line) {
  const LeftOutKind* kind = kind_of(element);
  if (kind == nullptr || kind->text.empty()) return std::nullopt;
  return LeftOutElement{.element = std::string(element),
                        .line = line,
                        .text = std::string(kind->text),
                        .override_with = std::string(kind->override_with)};
}

std::vector<LeftOutElement> leave_out_elements(tinyxml2::XMLElement& root) {
  std::vector<LeftOutElement> left_out;
  leave_out_below(root, left_out);
  return left_out;
}

std::set<std::string> leave_out_models(tinyxml2::XMLElement& root, const std::set<std::string>& names) {
  std::set<std::string> known;
  tinyxml2::XMLElement* world = root.FirstChildElement("world");
  if (world == nullptr) return known;
  for (auto* child = world->FirstChildElement(); child != nullptr;) {
    auto* next = child->NextSiblingElement();
    const std::string_view element = child->Name();
    if (element == "model" || element == "include") {
      const std::string name = element == "model" ? attribute_text(*child, "name") : name_of_include(*child);
      known.insert(name);
      if (names.contains(name)) world->DeleteChild(child);
    }
    child = next;
  }
  return known;
}

}  // namespace patrol::importer
