#include "io/json/json_check.h"

#include <algorithm>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace patrol::io {
namespace {

using Json = nlohmann::json;

constexpr int kNumberOverflow = 406;  // exception id of the library
constexpr std::size_t kMaxJsonDepth = 20;

/// SAX handler that checks each value while the library parses it.
class Checker final : public nlohmann::json_sax<Json> {
 public:
  Checker(const std::string& file, const std::string& text, std::size_t max_entries)
      : file_(file), text_(text), max_entries_(max_entries) {}

  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(std::int64_t) override { return count(); }
  bool number_unsigned(std::uint64_t) override { return count(); }
  bool number_float(double, const std::string&) override { return count(); }
  bool string(std::string&) override { return count(); }
  bool binary(Json::binary_t&) override { return count(); }
  bool start_array(std::size_t) override { return open({.is_list = true}); }
  bool start_object(std::size_t) override { return open({}); }
  bool end_array() override { return close(); }
  bool end_object() override { return close(); }

  bool key(std::string& key) override {
    Level& object = open_.back();
    object.key.clear();
    if (!object.keys.insert(key).second) refuse(key + ": duplicate key");
    object.key = key;
    return true;
  }

  bool parse_error(std::size_t position, const std::string& token, const nlohmann::detail::exception& error) override {
    const std::size_t at = std::clamp<std::size_t>(position, 1, text_.size() + 1) - 1;
    const auto line =
        static_cast<int>(std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at), '\n')) + 1;
    if (error.id == kNumberOverflow) throw input_error(file_, line, token + ": number out of range");
    if (at >= text_.size()) throw input_error(file_, line, "is not JSON: ends too early");
    const std::size_t line_start = at == 0 ? 0 : text_.rfind('\n', at - 1) + 1;  // npos + 1 is 0
    throw input_error(file_, line, fmt::format("is not JSON at column {}", at - line_start + 1));
  }

 private:
  /// List or object that has not ended yet.
  struct Level {
    bool is_list = false;
    std::size_t num_entries = 0;   ///< entries of a list
    std::set<std::string> keys{};  ///< keys of an object
    std::string key{};             ///< most recent key
  };

  bool count() {
    if (open_.empty() || !open_.back().is_list) return true;
    if (++open_.back().num_entries <= max_entries_) return true;
    open_.pop_back();
    refuse(fmt::format("more than {} entries", max_entries_));
  }
  bool open(Level level) {
    count();
    if (open_.size() >= kMaxJsonDepth) refuse(fmt::format("more than {} nested levels", kMaxJsonDepth));
    open_.push_back(std::move(level));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }
  [[noreturn]] void refuse(const std::string& what) const {
    std::string place;  // e.g. "waypoints[3]"; empty at the top level
    for (const Level& level : open_) {
      if (level.is_list) place += fmt::format("[{}]", level.num_entries - 1);
      else if (!level.key.empty()) place += (place.empty() ? "" : ".") + level.key;
    }
    throw InputError(file_ + ": " + (place.empty() ? "" : place + ": ") + what);
  }

  const std::string& file_;
  const std::string& text_;
  std::size_t max_entries_;
  std::vector<Level> open_;
};

}  // namespace

void check_json(const std::string& file, const std::string& text, std::size_t max_entries) {
  Checker checker(file, text, max_entries);
  Json::sax_parse(text, &checker);
}

}  // namespace patrol::io
