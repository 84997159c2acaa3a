#include "importer/mesh_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

/// Lines of a text that end with LF, CR LF or CR, as words.
class MeshLines {
 public:
  MeshLines(const std::filesystem::path& file, std::string_view text) : file_(file.string()), rest_(text) {}

  /// Reads the next line; false at the end. `joins`: a backslash at the end of a line continues it.
  bool next(bool joins = false) {
    words_.clear();
    if (rest_.empty()) return false;
    line_ += 1 + num_joined_;
    num_joined_ = 0;
    while (add_words() && joins && !rest_.empty()) ++num_joined_;
    return true;
  }

  const std::vector<std::string_view>& words() const { return words_; }
  /// Returns a word; empty if the line has fewer.
  std::string_view word(std::size_t i) const { return i < words_.size() ? words_[i] : std::string_view(); }
  int line() const { return line_; }

  [[noreturn]] void refuse(const std::string& what) const { throw input_error(file_, line_, io::on_one_line(what)); }

  /// Reads a number; decimal commas are points, as for libassimp. Refuses other words, and with `must_be_finite`
  /// numbers that are not finite.
  void check_number(std::string_view key, std::string_view word, bool must_be_finite) const {
    const std::optional<double> value = number(word);
    if (!value) refuse(fmt::format("{}: \"{}\" is not a number", key, word));
    if (must_be_finite && !std::isfinite(*value)) refuse(fmt::format("{}: {}: must be finite", key, word));
  }

  static std::optional<std::int64_t> integer(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
  }

 private:
  static std::optional<double> number(std::string_view word) {
    std::string text(word.starts_with('+') ? word.substr(1) : word);
    std::replace(text.begin(), text.end(), ',', '.');
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error == std::errc::invalid_argument) return std::nullopt;
    if (error != std::errc::result_out_of_range) return value;
    return text.find("e-") != std::string::npos || text.find("E-") != std::string::npos
               ? 0.0
               : std::numeric_limits<double>::infinity();
  }

  /// Appends the words of one line of the text; returns whether it ends with a backslash, which is no word.
  bool add_words() {
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    std::string_view line = rest_.substr(0, end);
    const std::size_t end_size = rest_.substr(end).starts_with("\r\n") ? 2 : 1;
    rest_.remove_prefix(std::min(end + end_size, rest_.size()));
    constexpr std::string_view kBlanks = " \t\v\f";
    const std::size_t last = line.find_last_not_of(kBlanks);
    const bool is_continued = last != std::string_view::npos && line[last] == '\\';
    if (is_continued) line = line.substr(0, last);
    for (std::size_t at = line.find_first_not_of(kBlanks); at < line.size(); at = line.find_first_not_of(kBlanks, at)) {
      const std::size_t word_end = std::min(line.find_first_of(kBlanks, at), line.size());
      words_.push_back(line.substr(at, word_end - at));
      at = word_end;
    }
    return is_continued;
  }

  std::string file_;
  std::string_view rest_;
  std::vector<std::string_view> words_;
  int line_ = 0;
  int num_joined_ = 0;
};

/// Numbers of vertices, texture coordinates and normals of an OBJ file.
using ObjCounts = std::array<std::int64_t, 3>;
constexpr std::array<std::string_view, 3> kObjVectors = {"v", "vt", "vn"};

/// Checks "v", "v/vt", "v//vn" or "v/vt/vn" of a face. `before`: vectors before the face, to which negative indices are
/// relative. libassimp ignores indices of vectors that the file does not have.
void check_obj_corner(const MeshLines& lines, std::string_view corner, const ObjCounts& before, const ObjCounts& all) {
  std::string_view rest = corner;
  for (std::size_t kind = 0; kind < 3 && (kind == 0 || !rest.empty()); ++kind) {
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    const std::string_view word = rest.substr(0, slash);
    rest.remove_prefix(std::min(slash + 1, rest.size()));
    if (kind > 0 && (word.empty() || all[kind] == 0)) continue;
    const auto index = MeshLines::integer(word);
    if (!index) lines.refuse(fmt::format("f: \"{}\" is not an index", corner));
    const bool is_known = *index > 0 ? *index <= all[kind] : *index < 0 && -*index <= before[kind];
    if (!is_known) lines.refuse(fmt::format("f: {}: must be one of the {} {}", corner, all[kind], kObjVectors[kind]));
  }
}

void check_obj_text(const std::filesystem::path& file, const std::string& text) {
  ObjCounts all{};
  const auto kind_of = [](const MeshLines& lines) {
    return static_cast<std::size_t>(std::find(kObjVectors.begin(), kObjVectors.end(), lines.word(0)) -
                                    kObjVectors.begin());
  };
  for (MeshLines lines(file, text); lines.next(true);) {
    if (const std::size_t kind = kind_of(lines); kind < all.size()) ++all[kind];
  }
  ObjCounts before{};
  for (MeshLines lines(file, text); lines.next(true);) {
    const std::size_t kind = kind_of(lines);
    if (kind < before.size()) ++before[kind];
    const bool is_face = lines.word(0) == "f";
    if (kind != 0 && !is_face) continue;
    std::size_t num_values = 0;
    for (std::size_t i = 1; i < lines.words().size() && !lines.word(i).starts_with('#'); ++i, ++num_values) {
      if (is_face) check_obj_corner(lines, lines.word(i), before, all);
      else lines.check_number("v", lines.word(i), i <= 3);
    }
    if (!is_face && num_values < 3) lines.refuse(fmt::format("v: {} values: must be at least 3", num_values));
  }
}

void check_stl_text(const std::filesystem::path& file, const std::string& text) {
  int num_vertices = -1;  // of the facet; -1: outside of facets
  bool is_inside_normal = false;
  MeshLines lines(file, text);
  while (lines.next()) {
    for (std::size_t i = 0; i < lines.words().size(); ++i) {
      const std::string_view word = lines.word(i);
      if (word == "solid" || word == "endsolid") {
        if (num_vertices >= 0) lines.refuse(fmt::format("{}: the facet before it has no endfacet", word));
        break;  // a name follows
      }
      const bool is_inside = num_vertices >= 0;
      if (word == "facet") {
        if (is_inside) lines.refuse("facet: the facet before it has no endfacet");
        num_vertices = 0;
        is_inside_normal = true;
      } else if (word == "endfacet") {
        if (num_vertices != 3) lines.refuse(fmt::format("facet: {} vertices: must be 3", std::max(num_vertices, 0)));
        num_vertices = -1;
      } else if (word == "vertex") {
        if (!is_inside) lines.refuse("vertex: must be in a facet");
        for (std::size_t k = 1; k <= 3; ++k) lines.check_number("vertex", lines.word(i + k), true);
        i += 3;
        ++num_vertices;
        is_inside_normal = false;
      } else if (word == "outer" || word == "loop" || word == "endloop") {
        is_inside_normal = false;
      } else if (is_inside && !is_inside_normal) {
        lines.refuse(fmt::format("\"{}\": must be outer loop, vertex, endloop or endfacet", word));
      }
    }
  }
  if (num_vertices >= 0) lines.refuse("facet: the file ends before its endfacet");
}

void check_stl(const std::filesystem::path& file, const std::string& bytes) {
  constexpr std::size_t kHeader_bytes = 84, kTriangle_bytes = 50;
  std::uint32_t count = 0;
  if (bytes.size() >= kHeader_bytes) std::memcpy(&count, bytes.data() + kHeader_bytes - sizeof count, sizeof count);
  const std::size_t size = kHeader_bytes + kTriangle_bytes * count;
  if (bytes.size() == size) return;
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  const bool is_text = bytes.substr(0, 500).find('\0') == std::string::npos;
  if (is_text) {
    if (bytes.compare(std::min(first, bytes.size()), 5, "solid") == 0) check_stl_text(file, bytes);
    return;
  }
  throw InputError(
      fmt::format("{}: mesh cannot be read: a binary STL file of {} triangles has {} bytes, this one has {}",
                  file.string(), count, size, bytes.size()));
}

struct PlyTextProperty {
  std::string name;
  bool is_list = false;
};

struct PlyTextElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyTextProperty> properties = {};
};

/// Reads the header of an ASCII PLY file; empty if the file is of another format or the header is invalid.
std::vector<PlyTextElement> read_ply_text_header(MeshLines& lines) {
  std::vector<PlyTextElement> elements;
  bool is_ascii = false;
  while (lines.next()) {
    const std::string_view key = lines.word(0);
    if (key == "end_header") return is_ascii ? elements : std::vector<PlyTextElement>();
    if (key == "format") is_ascii = lines.word(1) == "ascii";
    if (key == "element")
      elements.push_back({std::string(lines.word(1)), MeshLines::integer(lines.word(2)).value_or(0)});
    if (key == "property" && !elements.empty())
      elements.back().properties.push_back({std::string(lines.words().back()), lines.word(1) == "list"});
  }
  return {};
}

/// Checks the values of one row. `num_vertices`: vertices of the file.
void check_ply_row(const MeshLines& lines, const PlyTextElement& element, std::int64_t num_vertices) {
  const std::size_t num_words = lines.words().size();
  std::size_t at = 0;
  for (const PlyTextProperty& property : element.properties) {
    std::int64_t count = 1;
    if (property.is_list) {
      count = MeshLines::integer(lines.word(at)).value_or(-1);
      if (count < 0) lines.refuse(fmt::format("{}: \"{}\" is not a number of values", property.name, lines.word(at)));
      ++at;
    }
    if (at > num_words || static_cast<std::uint64_t>(count) > num_words - at)
      lines.refuse(
          fmt::format("{}: {} values: too few for the properties up to {}", element.name, num_words, property.name));
    const bool is_index = property.name == "vertex_indices" || property.name == "vertex_index";
    const bool is_position =
        element.name == "vertex" && (property.name == "x" || property.name == "y" || property.name == "z");
    for (const std::size_t end = at + static_cast<std::size_t>(count); at < end; ++at) {
      if (!is_index) {
        lines.check_number(property.name, lines.word(at), is_position);
        continue;
      }
      const auto index = MeshLines::integer(lines.word(at));
      if (!index || *index < 0 || *index >= num_vertices)
        lines.refuse(
            fmt::format("{}: {}: must be one of the {} vertices, from 0", property.name, lines.word(at), num_vertices));
    }
  }
  if (at < num_words) lines.refuse(fmt::format("{}: {} values: the header has {}", element.name, num_words, at));
}

void check_ply_text(const std::filesystem::path& file, const std::string& text) {
  MeshLines lines(file, text);
  const std::vector<PlyTextElement> elements = read_ply_text_header(lines);
  std::int64_t num_vertices = 0;
  for (const PlyTextElement& element : elements) num_vertices += element.name == "vertex" ? element.count : 0;
  for (const PlyTextElement& element : elements) {
    for (std::int64_t row = 0; row < element.count; ++row) {
      do {
        if (!lines.next())
          lines.refuse(fmt::format("{}: the file ends after {} of {} rows", element.name, row, element.count));
      } while (lines.words().empty());
      check_ply_row(lines, element, num_vertices);
    }
  }
}

}  // namespace

void check_mesh_text(const std::filesystem::path& file) {
  const std::string extension = to_lower(file.extension().string());
  if (extension == ".obj") check_obj_text(file, io::load_text(file));
  if (extension == ".stl") check_stl(file, io::load_text(file));
  if (extension == ".ply") check_ply_text(file, io::load_text(file));
}

std::string mesh_error(std::string_view message) {
  constexpr std::size_t kMaxMessage_bytes = 200;
  return io::on_one_line(message.substr(0, kMaxMessage_bytes));
}

}  // namespace patrol::importer
