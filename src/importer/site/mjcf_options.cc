#include "importer/site/mjcf_options.h"

#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

using tinyxml2::XMLElement;

/// Attribute that a site determines.
struct FixedAttribute {
  std::string_view element;
  const char* attribute;
  const char* value;  ///< value in a site, or the default of MuJoCo; the attribute is removed
  bool is_number;     ///< equal numbers agree, not only equal texts
};

constexpr std::array kFixed = std::to_array<FixedAttribute>({
    {"option", "timestep", "0.002", true},
    {"option", "integrator", "Euler", false},
    {"option", "wind", "0 0 0", false},
    {"option", "density", "0", true},
    {"option", "viscosity", "0", true},
    {"option", "noslip_iterations", "0", true},
    {"option", "actuatorgroupdisable", "", false},
    {"compiler", "settotalmass", "-1", true},
    {"compiler", "boundmass", "0", true},
    {"compiler", "boundinertia", "0", true},
    {"compiler", "balanceinertia", "false", false},
    {"compiler", "inertiafromgeom", "auto", false},
    {"compiler", "inertiagrouprange", "0 5", false},
    {"compiler", "discardvisual", "false", false},
    {"compiler", "fusestatic", "false", false},
    {"compiler", "alignfree", "false", false},
    {"size", "memory", "-1", false},
    {"size", "njmax", "-1", true},
    {"size", "nconmax", "-1", true},
    {"size", "nstack", "-1", true},
});

[[noreturn]] void refuse_gravity(const std::filesystem::path& file, const XMLElement& element) {
  throw InputError(fmt::format("{}:{}: <{}>: gravity: must be that of the earth, 0 0 -9.81", file.string(),
                               element.GetLineNum(), element.Name()));
}

/// MuJoCo refuses a text that is no vector.
void check_gravity(const std::filesystem::path& file, const XMLElement& option) {
  const char* text = option.Attribute("gravity");
  if (text == nullptr) return;
  constexpr double kTolerance_mps2 = 0.1;
  double x = 0.0, y = 0.0, z = 0.0;
  if (!(std::istringstream(text) >> x >> y >> z)) return;
  const bool is_of_earth =
      std::abs(x) < kTolerance_mps2 && std::abs(y) < kTolerance_mps2 && std::abs(z + 9.81) < kTolerance_mps2;
  if (!is_of_earth) refuse_gravity(file, option);
}

/// Removes the attributes that a site determines and returns those that differ, as texts.
std::vector<std::string> remove_fixed(XMLElement& element) {
  std::vector<std::string> removed;
  for (const FixedAttribute& fixed : kFixed) {
    const char* text = element.Attribute(fixed.attribute);
    if (fixed.element != element.Name() || text == nullptr) continue;
    double value = 0.0, fixed_value = 0.0;
    const bool is_equal = std::string_view(text) == fixed.value ||
                          (fixed.is_number && tinyxml2::XMLUtil::ToDouble(text, &value) &&
                           tinyxml2::XMLUtil::ToDouble(fixed.value, &fixed_value) && value == fixed_value);
    if (!is_equal) {
      const std::string was = fmt::format("{} = {}", fixed.attribute, io::on_one_line(text));
      removed.push_back(fixed.element == "option" && *fixed.value != '\0' ? fmt::format("{} is {}", was, fixed.value)
                                                                          : was + " is removed");
    }
    element.DeleteAttribute(fixed.attribute);
  }
  return removed;
}

/// Removes the flags of an option and returns them as texts.
std::vector<std::string> remove_flags(const std::filesystem::path& file, XMLElement& option) {
  std::vector<std::string> removed;
  for (XMLElement* flag = option.FirstChildElement("flag"); flag != nullptr; flag = option.FirstChildElement("flag")) {
    for (const tinyxml2::XMLAttribute* at = flag->FirstAttribute(); at != nullptr; at = at->Next()) {
      if (std::string_view(at->Name()) == "gravity" && std::string_view(at->Value()) == "disable")
        refuse_gravity(file, *flag);
      removed.push_back(fmt::format("flag {} = {} is removed", at->Name(), io::on_one_line(at->Value())));
    }
    option.DeleteChild(flag);
  }
  return removed;
}

}  // namespace

std::vector<Assumption> replace_options(const std::filesystem::path& file, XMLElement& root) {
  std::vector<Assumption> rows;
  for (XMLElement* element = root.FirstChildElement(); element != nullptr; element = element->NextSiblingElement()) {
    std::vector<std::string> removed = remove_fixed(*element);
    if (std::string_view(element->Name()) == "option") {
      check_gravity(file, *element);
      for (std::string& flag : remove_flags(file, *element)) removed.push_back(std::move(flag));
    }
    if (removed.empty()) continue;
    rows.push_back(
        {fmt::format("<{}>, line {} of {}", element->Name(), element->GetLineNum(), file.filename().string()),
         patrol::join(removed, ", ") + ": physics is that of all sites", ""});
  }
  return rows;
}

}  // namespace patrol::importer
