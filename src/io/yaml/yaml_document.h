#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include <yaml-cpp/yaml.h>

namespace patrol::io {

/// Limits of a YAML document. The parsed tree takes about 250 bytes per node.
inline constexpr std::uintmax_t kMaxYamlBytes = std::uintmax_t{16} << 20;
/// Maximum number of scalars, lists and maps; an alias counts as the nodes that it repeats.
inline constexpr std::size_t kMaxYamlNodes = 200'000;

/// Parses a single YAML document. Throws InputError "<place>:<line>: ..." if `text` is not YAML, has content after the
/// first document, exceeds the limits, or an alias refers to a node that contains it. `place` is a file or an option;
/// an option has no lines.
YAML::Node parse_yaml(const std::string& source, const std::string& text, bool has_lines);

/// Parses the single document of a file of at most kMaxYamlBytes. Throws InputError.
YAML::Node load_yaml(const std::filesystem::path& file);

}  // namespace patrol::io
