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

/// Invalid word in a line. The message has no file and line; the caller adds them.
class ParseError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parses decimal seconds as integer nanoseconds, exactly. A double of seconds since 1970 resolves only 0.1
/// microseconds. Digits beyond the ninth are truncated. Returns nullopt if the text is not a number or exceeds 292
/// years.
std::optional<Time> parse_stamp(std::string_view text);

/// Formats a stamp in seconds with nine decimals, which parse_stamp reads back exactly.
std::string format_stamp(Time stamp);

/// Tokenizer of a line of words separated by blanks. `what` names the word in error messages. Throws ParseError.
class LineTokenizer {
 public:
  explicit LineTokenizer(std::string_view line) : rest_(line) { skip_blanks(); }

  bool is_empty() const { return rest_.empty(); }
  /// Returns the number of remaining words.
  std::size_t num_words() const;

  std::string_view word(const char* what);
  /// Reads a number, including "inf" and "nan".
  double any_number(const char* what);
  /// Reads a finite number.
  double number(const char* what);
  /// Reads a coordinate, m: at most 100,000 km.
  double distance(const char* what);
  std::int64_t integer(const char* what, std::int64_t min, std::int64_t max);
  Time stamp(const char* what);
  /// Reads a pose x y yaw; m, rad. At most 100,000 km from the origin; the yaw is wrapped.
  Pose2 pose(const char* what);

 private:
  void skip_blanks();

  std::string_view rest_;
};

}  // namespace patrol::io
