#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <tinyxml2.h>

#include "importer/site/sdf_left_out.h"
#include "importer/xacro.h"

namespace patrol::importer {

/// Returns why an element of SDF is refused; none: it is not.
std::optional<std::string_view> sdf_refusal(std::string_view element);

/// Latest minor version of SDF 1 that libsdformat 12 reads.
constexpr int kMaxLibraryVersion = 9;

/// Returns N of the version "1.N"; none if the text is not of this form.
std::optional<int> minor_sdf_version(std::string_view version);

/// Content that an SDF file must have: one <world>, or one <model>, <light> or <actor> to include.
enum class SdfContent { kWorld, kModel };

/// Text of an SDF file as XML: checks before libsdformat reads it, and places for its errors without a line.
class SdfSource {
 public:
  /// Leaves out elements (sdf_left_out.h). `text`: content of the file, or its expansion by xacro. Throws InputError
  /// "file:line: what" unless the file is XML with a root <sdf> of version 1.3 to 1.12 and the content, and for the
  /// first element that is refused or is no geometry of the format.
  SdfSource(const std::filesystem::path& file, std::string_view text, SdfContent content);

  /// Returns whether the file is a light or an actor alone, which are left out.
  bool is_left_out() const { return content_ != "world" && content_ != "model"; }

  /// Returns the content: "world", "model", "light" or "actor".
  const std::string& content() const { return content_; }

  /// Leaves out an <include> of a light or an actor.
  void leave_out(tinyxml2::XMLElement& include, const std::string& content);

  /// Leaves out models of the world. Throws InputError for a name that the world does not have.
  void leave_out_models(const std::set<std::string>& names);

  /// Returns the elements that are left out, those of a file first, then includes.
  const std::vector<LeftOutElement>& left_out() const { return left_out_; }

  /// Returns the elements <include>, in the order of the file.
  std::vector<tinyxml2::XMLElement*> includes();

  /// Returns the text for libsdformat, with every element in its line of the file. Versions above 1.9, the latest that
  /// libsdformat 12 reads, are replaced by it: they only add elements, which it copies, such as <cone>.
  std::string text() const;

  const std::filesystem::path& file() const { return file_; }
  /// Returns "FILE:LINE" of an element that begins in a line of the text, for messages; of an expanded text in the
  /// xacro file that has the element.
  std::string location(int line) const { return location_in(file_.string(), positions_, line); }
  bool is_expanded() const { return !positions_.empty(); }

  /// Throws InputError "file:line: <element>: what".
  [[noreturn]] void fail(const tinyxml2::XMLElement& element, const std::string& what) const;

  /// Returns the last element with this name in its attribute "name" that is `wanted`; nullptr: none is.
  const tinyxml2::XMLElement* named(const std::string& name,
                                    const std::function<bool(const tinyxml2::XMLElement&)>& wanted) const;

  /// Returns the line of the first element with this name.
  std::optional<int> line_of_first(const std::string& name) const;

  /// Element of the world alone in a world.
  struct Part {
    int line = 0;
    std::string element;
    std::string text;  ///< SDF
  };

  /// Returns each element of the world, to find which one is invalid; none if the file is that of a model.
  std::vector<Part> parts() const;

  /// Returns the text of the element at the line if it has no elements below it.
  std::optional<std::string> text_at(int line, std::string_view element) const;

 private:
  void check_content(SdfContent content);
  void check(const tinyxml2::XMLElement& element) const;

  std::filesystem::path file_;
  std::map<int, std::string> positions_;  ///< positions of the elements of an expanded text (xacro.h)
  tinyxml2::XMLDocument document_;
  std::string content_;
  std::vector<LeftOutElement> left_out_;
};

}  // namespace patrol::importer
