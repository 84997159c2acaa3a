#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/points/e57_file.h"

namespace patrol::io {

enum class E57Type : std::uint8_t { kFloat32, kFloat64, kInteger, kText };

/// Field of the records of a compressed vector, with its bytes of all records.
struct E57Column {
  std::string name;  ///< "cartesianX"
  E57Type type = E57Type::kFloat64;
  std::size_t bits = 64;     ///< number of bits of a record; integers: as many as their limits need, 0 for a constant
  std::int64_t minimum = 0;  ///< integers: value of the bits 0
  double scale = 1.0;        ///< integers: value of a step
  double offset = 0.0;       ///< integers: value of the integer 0
  bool is_needed = true;     ///< else its bytes are skipped
  std::string bytes = {};    ///< records without gaps, lowest bit first

  /// Returns whether the bytes of a number of records are there.
  bool is_complete(std::uint64_t num_records) const;
  /// Returns the value of a record; not for texts.
  double number(std::size_t record) const;
};

/// Reads the data packets of the binary section at a physical offset until all columns that are needed are complete.
/// `columns`: all fields, in the order of the prototype. `path`: element of the vector, for messages. Throws InputError
/// for an invalid section.
void read_e57_columns(const E57File& file, std::uint64_t section_offset, std::uint64_t num_records,
                      std::string_view path, std::vector<E57Column>& columns);

}  // namespace patrol::io
