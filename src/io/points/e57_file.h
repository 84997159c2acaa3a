#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace patrol::io {

/// Container of E57 (ASTM E2807-11): pages with checksums, which hold an XML section and binary sections.
class E57File {
 public:
  /// Reads a file. Throws InputError if it is no E57 file, if its size differs from the header, or if the checksum of a
  /// page is wrong.
  explicit E57File(const std::filesystem::path& file);

  std::string_view xml() const { return xml_; }
  /// Returns the size of the content without checksums.
  std::size_t num_bytes() const { return bytes_.size(); }
  /// Returns the bytes from a physical offset to the end of the file, without checksums. `path`: element of the XML
  /// section that has the offset, for messages. Throws InputError if the offset is outside the file or in a checksum.
  std::string_view from(std::uint64_t physical_offset, std::string_view path) const;
  /// Throws InputError with the file and an element of the XML section.
  [[noreturn]] void refuse(std::string_view path, std::string_view reason) const;

 private:
  std::string file_;
  std::string bytes_;  ///< all pages without checksums
  std::uint64_t page_bytes_ = 0;
  std::string_view xml_;  ///< in `bytes_`
};

}  // namespace patrol::io
