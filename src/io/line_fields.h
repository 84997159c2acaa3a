#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/frames.h"
#include "core/time.h"

namespace patrol::io {

/// A line's word is not what belongs there; the reader of the file adds where.
class FieldError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Seconds in decimal figures as integer nanoseconds: exact, where a double of seconds since 1970 is good to a tenth of a
/// microsecond. Digits beyond the ninth are cut off. None when it is no number, or too large (292 years).
std::optional<Time> parse_stamp(std::string_view text);

/// The same with nine digits after the point: what parse_stamp reads back as it was.
std::string format_stamp(Time stamp);

/// Takes a line of words, parted by blanks, apart. `what` names the word in messages. Throws FieldError.
class LineFields {
 public:
  explicit LineFields(std::string_view line) : rest_(line) { skip_blanks(); }

  bool is_empty() const { return rest_.empty(); }
  /// How many words are left.
  std::size_t num_words() const;

  std::string_view word(const char* what);
  /// Any number, "inf" and "nan" too.
  double any_number(const char* what);
  /// A finite one.
  double number(const char* what);
  std::int64_t integer(const char* what, std::int64_t min, std::int64_t max);
  Time stamp(const char* what);
  /// x y yaw; m, rad. No further than 100,000 km away; the yaw is wrapped.
  Pose2 pose(const char* what);

 private:
  void skip_blanks();

  std::string_view rest_;
};

}  // namespace patrol::io
