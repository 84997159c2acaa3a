#include "app/campaign/sweep/sweep_options.h"

#include <charconv>
#include <numeric>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::app {
namespace {

/// Converts the whole text to a number; none if it is not one.
template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

std::vector<std::uint64_t> parse_seeds(const std::string& text, const std::string& option) {
  constexpr std::uint64_t kMax = 1'000'000;
  const std::size_t dots = text.find("..");
  const auto first =
      dots == std::string::npos ? std::optional<std::uint64_t>(1) : parse_number<std::uint64_t>(text.substr(0, dots));
  const auto last = parse_number<std::uint64_t>(dots == std::string::npos ? text : text.substr(dots + 2));
  if (!first || !last || *last < *first || *last - *first >= kMax) {
    throw InputError(fmt::format("{} {}: must be N (seeds 1 ... N) or A..B, at most {} of them", option, text, kMax));
  }
  std::vector<std::uint64_t> seeds(*last - *first + 1);
  std::iota(seeds.begin(), seeds.end(), *first);
  return seeds;
}

Shard parse_shard(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t slash = text.find('/');
  const std::size_t index = parse_number<std::size_t>(text.substr(0, slash)).value_or(0);
  const std::size_t count =
      slash == std::string::npos ? 0 : parse_number<std::size_t>(text.substr(slash + 1)).value_or(0);
  if (index < 1 || index > count) throw InputError(fmt::format("--shard {}: must be i/n with 1 <= i <= n", text));
  return {.index = index - 1, .count = count};
}

}  // namespace patrol::app
