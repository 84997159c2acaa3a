#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tinyxml2.h>

namespace patrol::importer {

/// Returns why an element of SDF is refused; none: it is not.
std::optional<std::string_view> sdf_refusal(std::string_view element);

/// Text of an SDF file as XML: checks before libsdformat reads it, and places for its errors without a line.
class SdfSource {
 public:
  /// Throws InputError "file:line: what" unless the file is XML with a root <sdf> of version 1.0 to 1.9 and one world,
  /// and for the first element that is refused or is no geometry of the format.
  explicit SdfSource(const std::filesystem::path& file);

  /// Returns the line of the last element with this name in its attribute "name".
  std::optional<int> line_of(const std::string& name) const;

  /// Element of the world alone in a world.
  struct Part {
    int line = 0;
    std::string element;
    std::string text;  ///< SDF
  };

  /// Returns each element of the world, to find which one is invalid.
  std::vector<Part> parts() const;

  /// Returns the text of the element at the line if it has no elements below it.
  std::optional<std::string> text_at(int line, std::string_view element) const;

 private:
  void check(const tinyxml2::XMLElement& element) const;
  [[noreturn]] void fail(const tinyxml2::XMLElement& element, const std::string& what) const;

  std::filesystem::path file_;
  tinyxml2::XMLDocument document_;
};

}  // namespace patrol::importer
