#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tests/support/number_bytes.h"

/// Writer of E57 files by ASTM E2807-11, for the tests.
namespace patrol::test {

inline constexpr std::size_t kE57PageBytes = 1024;

/// Returns the CRC-32C of the bytes, bit by bit.
inline std::uint32_t crc32c(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0x82F63B78U : 0U);
  }
  return ~crc;
}

/// Returns the pages with checksums of a content that is padded with zeros.
inline std::string with_checksums(std::string content) {
  const std::size_t payload_bytes = kE57PageBytes - 4;
  content.resize((content.size() + payload_bytes - 1) / payload_bytes * payload_bytes, '\0');
  std::string pages;
  for (std::size_t begin = 0; begin < content.size(); begin += payload_bytes) {
    const std::string payload = content.substr(begin, payload_bytes);
    const std::uint32_t crc = crc32c(payload);
    pages += payload;
    for (int shift = 24; shift >= 0; shift -= 8) pages += static_cast<char>(crc >> shift & 0xFF);
  }
  return pages;
}

/// Returns the physical offset of a byte of the content.
inline std::uint64_t physical(std::size_t logical) { return logical + 4 * (logical / (kE57PageBytes - 4)); }

/// Field of the points: its element of the prototype, and the bits of a record for integers (0: floats).
struct E57TestField {
  std::string name, attributes;
  int bits = 0;
  bool is_double = false;
  bool is_constant = false;  ///< has no bytes
};

/// Scan of a file. Values of integer fields are those above the minimum.
struct E57TestScan {
  std::string pose = {};  ///< XML of the pose; empty: none
  std::vector<E57TestField> fields = {};
  std::vector<std::vector<double>> records = {};
  std::string codecs = {};
  std::size_t packet_records = 100;
};

class E57Writer {
 public:
  /// Appends a scan: its binary section and its element.
  void add(const E57TestScan& scan) {
    const std::size_t section = content_.size();
    content_ +=
        bytes(std::uint64_t{1}) + bytes(std::uint64_t{0}) + bytes(physical(section + 32 + 4)) + bytes(std::uint64_t{0});
    content_ += std::string("\x02\x00\x03\x00", 4);  // an empty packet comes first
    std::vector<std::string> streams(scan.fields.size());
    std::vector<std::pair<std::uint64_t, int>> pending(scan.fields.size());
    for (std::size_t begin = 0; begin < scan.records.size(); begin += scan.packet_records) {
      const std::size_t end = std::min(begin + scan.packet_records, scan.records.size());
      for (std::size_t i = begin; i < end; ++i) append(scan.fields, scan.records[i], streams, pending);
      if (end == scan.records.size()) {
        for (std::size_t f = 0; f < streams.size(); ++f) {
          if (pending[f].second > 0) streams[f] += static_cast<char>(pending[f].first);
        }
      }
      write_packet(streams);
    }
    std::string prototype;
    for (const E57TestField& field : scan.fields) prototype += fmt::format("<{0} {1}/>", field.name, field.attributes);
    scans_ += fmt::format(
        "<vectorChild type=\"Structure\">{}<points type=\"CompressedVector\" fileOffset=\"{}\" recordCount=\"{}\">"
        "<prototype type=\"Structure\">{}</prototype><codecs type=\"Vector\">{}</codecs></points></vectorChild>\n",
        scan.pose, physical(section), scan.records.size(), prototype, scan.codecs);
  }

  /// Returns the content of the file without checksums.
  std::string content() const {
    const std::string xml = "<?xml version=\"1.0\"?>\n<e57Root type=\"Structure\">\n<data3D type=\"Vector\">\n" +
                            scans_ + "</data3D></e57Root>";
    std::string content = content_ + xml;
    const std::size_t num_pages = (content.size() + kE57PageBytes - 5) / (kE57PageBytes - 4);
    const std::string header = "ASTM-E57" + bytes(std::uint32_t{1}) + bytes(std::uint32_t{0}) +
                               bytes(std::uint64_t{kE57PageBytes * num_pages}) + bytes(physical(content_.size())) +
                               bytes(std::uint64_t{xml.size()}) + bytes(std::uint64_t{kE57PageBytes});
    return content.replace(0, header.size(), header);
  }
  std::string file() const { return with_checksums(content()); }

 private:
  static void append(const std::vector<E57TestField>& fields, const std::vector<double>& record,
                     std::vector<std::string>& streams, std::vector<std::pair<std::uint64_t, int>>& pending) {
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (fields[f].is_constant) continue;
      if (fields[f].bits == 0) {
        streams[f] += fields[f].is_double ? bytes(record[f]) : bytes(static_cast<float>(record[f]));
        continue;
      }
      auto& [bits, count] = pending[f];
      const auto value = static_cast<std::uint64_t>(record[f]);
      for (int bit = 0; bit < fields[f].bits; ++bit) {
        bits |= (value >> bit & 1) << count;
        if (++count < 8) continue;
        streams[f] += static_cast<char>(bits);
        bits = 0;
        count = 0;
      }
    }
  }

  void write_packet(std::vector<std::string>& streams) {
    std::string body = bytes(static_cast<std::uint16_t>(streams.size()));
    for (const std::string& stream : streams) body += bytes(static_cast<std::uint16_t>(stream.size()));
    for (std::string& stream : streams) body += std::exchange(stream, {});
    while ((body.size() + 4) % 4 != 0) body += '\0';
    content_ += std::string("\x01\x00", 2) + bytes(static_cast<std::uint16_t>(body.size() + 3)) + body;
  }

  std::string content_ = std::string(48, '\0'), scans_;
};

/// Returns the XML of a pose with a rotation about z.
inline std::string e57_pose(double x, double y, double z, double yaw_rad) {
  return fmt::format(
      "<pose type=\"Structure\"><rotation type=\"Structure\"><w type=\"Float\">{}</w><x type=\"Float\"/><y "
      "type=\"Float\"/><z type=\"Float\">{}</z></rotation><translation type=\"Structure\"><x type=\"Float\">{}</x><y "
      "type=\"Float\">{}</y><z type=\"Float\">{}</z></translation></pose>",
      std::cos(yaw_rad / 2.0), std::sin(yaw_rad / 2.0), x, y, z);
}

/// Returns fields of floats of 32 bits with these names.
inline std::vector<E57TestField> e57_floats(const std::vector<std::string>& names) {
  std::vector<E57TestField> fields;
  for (const std::string& name : names)
    fields.push_back({.name = name, .attributes = "type=\"Float\" precision=\"single\""});
  return fields;
}

}  // namespace patrol::test
