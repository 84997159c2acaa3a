#include "io/log_compare.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "io/mcap_reader.h"

namespace patrol::io {
namespace {

struct Entry {
  std::string topic;
  Time log_time{};
  std::string cdr;
};

std::vector<Entry> read_all(const std::filesystem::path& log) {
  std::vector<Entry> entries;
  read_mcap(log, [&](const McapMessage& message) { entries.push_back({message.topic, message.log_time, std::string(message.cdr)}); });
  return entries;
}

bool same_bytes(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::ifstream first(a, std::ios::binary), second(b, std::ios::binary);
  return std::equal(std::istreambuf_iterator<char>(first), {}, std::istreambuf_iterator<char>(second), {});
}

std::string difference_of(const std::string& was, const std::string& is) {
  if (was.size() != is.size()) return fmt::format("the message has {} bytes, was {}", is.size(), was.size());
  const auto [a, b] = std::mismatch(was.begin(), was.end(), is.begin());
  return fmt::format("byte {} of the message is {:#04x}, was {:#04x}", a - was.begin(), static_cast<unsigned char>(*b),
                     static_cast<unsigned char>(*a));
}

}  // namespace

std::optional<LogDifference> first_difference(const std::filesystem::path& log, const std::filesystem::path& again) {
  if (same_bytes(log, again)) return std::nullopt;
  const std::vector<Entry> was = read_all(log), is = read_all(again);
  for (std::size_t i = 0; i < std::min(was.size(), is.size()); ++i) {
    if (was[i].topic != is[i].topic || was[i].log_time != is[i].log_time) {
      return LogDifference{was[i].topic, was[i].log_time, "here the other log has " + is[i].topic};
    }
    if (was[i].cdr != is[i].cdr) return LogDifference{was[i].topic, was[i].log_time, difference_of(was[i].cdr, is[i].cdr)};
  }
  if (was.size() == is.size()) return LogDifference{"", {}, "the same messages in another packing"};
  const std::vector<Entry>& longer = was.size() > is.size() ? was : is;
  const Entry& extra = longer[std::min(was.size(), is.size())];
  return LogDifference{extra.topic, extra.log_time, was.size() > is.size() ? "the other log ends here" : "the log ended here"};
}

}  // namespace patrol::io
