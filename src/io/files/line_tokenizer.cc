#include "io/files/line_tokenizer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace patrol::io {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr double kMaxDistance_m = 1e8;
constexpr std::int64_t kMaxSeconds = 9'000'000'000;  ///< limit of int64 nanoseconds, with margin

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Quotes a word for error messages, truncated.
std::string quoted(std::string_view word) {
  constexpr std::size_t kMaxQuoted = 24;
  return word.size() <= kMaxQuoted ? fmt::format("'{}'", word) : fmt::format("'{}...'", word.substr(0, kMaxQuoted));
}

template <typename Number>
bool parse_all(std::string_view text, Number& value) {
  // std::from_chars does not accept a plus sign.
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

/// Converts the digits of the fraction to nanoseconds; negative if they are not digits.
std::int64_t parse_fraction(std::string_view digits) {
  if (!std::all_of(digits.begin(), digits.end(), is_digit)) return -1;
  std::int64_t nanoseconds = 0;
  for (std::size_t i = 0; i < 9; ++i) nanoseconds = 10 * nanoseconds + (i < digits.size() ? digits[i] - '0' : 0);
  return nanoseconds;
}

}  // namespace

std::optional<Time> parse_stamp(std::string_view text) {
  const std::size_t point = text.find('.');
  std::string_view whole = text.substr(0, point);
  const bool is_negative = whole.starts_with('-');
  if (is_negative) whole.remove_prefix(1);
  std::int64_t seconds = 0;
  const std::int64_t nanoseconds = point == std::string_view::npos ? 0 : parse_fraction(text.substr(point + 1));
  const bool is_decimal = !whole.empty() && is_digit(whole.front()) && parse_all(whole, seconds) && nanoseconds >= 0;
  if (is_decimal) {
    if (seconds > kMaxSeconds) return std::nullopt;
    const std::int64_t count = seconds * kNanosecondsPerSecond + nanoseconds;
    return Time{is_negative ? -count : count};
  }
  double number = 0.0;  // fallback for ".5", "1e3"
  if (!parse_all(text, number) || !(std::abs(number) <= static_cast<double>(kMaxSeconds))) return std::nullopt;
  return from_seconds(number);
}

std::string format_stamp(Time stamp) {
  const std::int64_t count = std::abs(stamp.count());
  return fmt::format("{}{}.{:09}", stamp < Time{} ? "-" : "", count / kNanosecondsPerSecond,
                     count % kNanosecondsPerSecond);
}

void LineTokenizer::skip_blanks() {
  std::size_t count = 0;
  while (count < rest_.size() && is_blank(rest_[count])) ++count;
  rest_.remove_prefix(count);
}

std::size_t LineTokenizer::num_words() const {
  std::size_t count = 0;
  bool was_blank = true;
  for (const char c : rest_) {
    const bool is_now_blank = is_blank(c);
    if (was_blank && !is_now_blank) ++count;
    was_blank = is_now_blank;
  }
  return count;
}

std::string_view LineTokenizer::word(const char* what) {
  if (rest_.empty()) throw ParseError(fmt::format("ends before {}", what));
  std::size_t size = 1;
  while (size < rest_.size() && !is_blank(rest_[size])) ++size;
  const std::string_view taken = rest_.substr(0, size);
  rest_.remove_prefix(size);
  skip_blanks();
  return taken;
}

double LineTokenizer::any_number(const char* what) {
  const std::string_view text = word(what);
  double value = 0.0;
  if (!parse_all(text, value)) throw ParseError(fmt::format("{} {} is not a number", what, quoted(text)));
  return value;
}

double LineTokenizer::number(const char* what) {
  const std::string_view text = word(what);
  double value = 0.0;
  if (!parse_all(text, value) || !std::isfinite(value))
    throw ParseError(fmt::format("{} {} is not a finite number", what, quoted(text)));
  return value;
}

double LineTokenizer::distance(const char* what) {
  const double distance_m = number(what);
  if (std::abs(distance_m) > kMaxDistance_m)
    throw ParseError(fmt::format("{} {:.4g} m is off the earth", what, distance_m));
  return distance_m;
}

std::int64_t LineTokenizer::integer(const char* what, std::int64_t min, std::int64_t max) {
  const std::string_view text = word(what);
  std::int64_t value = 0;
  if (!parse_all(text, value) || value < min || value > max) {
    throw ParseError(fmt::format("{} {} must be an integer in [{}, {}]", what, quoted(text), min, max));
  }
  return value;
}

Time LineTokenizer::stamp(const char* what) {
  const std::string_view text = word(what);
  const std::optional<Time> stamp = parse_stamp(text);
  if (stamp) return *stamp;
  double number = 0.0;
  if (parse_all(text, number) && std::isfinite(number))
    throw ParseError(fmt::format("{} {} is out of range: must be at most {:g} s", what, quoted(text),
                                 static_cast<double>(kMaxSeconds)));
  throw ParseError(fmt::format("{} {} is not a time in seconds", what, quoted(text)));
}

Pose2 LineTokenizer::pose(const char* what) {
  const double x = number(what), y = number(what), yaw = number(what);
  if (std::abs(x) > kMaxDistance_m || std::abs(y) > kMaxDistance_m)
    throw ParseError(fmt::format("{} ({:.4g} m, {:.4g} m) is off the earth", what, x, y));
  return {x, y, wrap_angle(yaw)};
}

}  // namespace patrol::io
