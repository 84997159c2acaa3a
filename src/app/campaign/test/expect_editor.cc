#include "app/campaign/test/expect_editor.h"

#include <algorithm>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include "app/campaign/test/limit_rules.h"
#include "core/error.h"

namespace patrol::app {
namespace {

constexpr const char* kForm = R"(write it as "  metric: value" on one line)";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

bool is_blank_or_comment(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string::npos || line[first] == '#';
}

/// Comment behind a value: the new range in source of an old one, any other comment as it is.
std::string trailing_comment(const std::string& old, const std::string& measured) {
  if (!old.empty() && !std::regex_match(old, std::regex(R"(#\s*measured .*)"))) return "  " + old;
  return measured.empty() ? "" : "  # " + measured;
}

class Editor {
 public:
  Editor(const std::string& source, const std::string& text, const std::map<std::string, std::string>& measured)
      : source_(source), lines_(lines_of(text)), measured_(measured) {}

  std::string edit(const io::Expectations& expectations) {
    const std::size_t begin = find_section();
    std::size_t end = begin;  // line after the last metric
    std::set<std::string> present;
    for (std::size_t i = begin; i < lines_.size(); ++i) {
      if (is_blank_or_comment(lines_[i])) continue;
      if (lines_[i].front() != ' ') break;
      present.insert(edit_line(i, expectations));
      end = i + 1;
    }
    std::vector<std::string> added;
    for (const auto& [metric, expectation] : expectations) {
      if (!present.contains(metric)) added.push_back(metric);
    }
    std::stable_sort(added.begin(), added.end(),
                     [](const std::string& a, const std::string& b) { return rule_index(a) < rule_index(b); });
    for (std::string& metric : added) {
      metric = fmt::format("{}{}: {}{}", indent_, metric, to_yaml(expectations.at(metric)),
                           trailing_comment("", measured(metric)));
    }
    lines_.insert(lines_.begin() + static_cast<std::ptrdiff_t>(end), added.begin(), added.end());
    std::string text;
    for (const std::string& line : lines_) text += line + "\n";
    return text;
  }

 private:
  /// First line below the key `expect`, which is added if there is none.
  std::size_t find_section() {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (!lines_[i].starts_with("expect:")) continue;
      if (!is_blank_or_comment(lines_[i].substr(7))) throw not_editable(i, "expect");
      return i + 1;
    }
    lines_.emplace_back("expect:");
    return lines_.size();
  }

  /// Replaces the value of a line and returns its metric.
  std::string edit_line(std::size_t i, const io::Expectations& expectations) {
    static const std::regex form(R"(( +)([^\s:#'"]+): +([^\s#{][^#]*?|\{[^{}#]*\})\s*(#.*)?)");
    std::smatch parts;
    if (!std::regex_match(lines_[i], parts, form)) throw not_editable(i, "expect");
    indent_ = parts[1];
    const std::string metric = parts[2];
    const auto found = expectations.find(metric);
    if (found != expectations.end()) {
      lines_[i] = fmt::format("{}{}: {}{}", indent_, metric, to_yaml(found->second),
                              trailing_comment(parts[4], measured(metric)));
    }
    return metric;
  }

  std::string measured(const std::string& metric) const {
    const auto found = measured_.find(metric);
    return found == measured_.end() ? "" : found->second;
  }

  InputError not_editable(std::size_t line, const std::string& key) const {
    return input_error(source_, static_cast<int>(line) + 1, fmt::format("{}: cannot be edited: {}", key, kForm));
  }

  std::string source_;
  std::vector<std::string> lines_;
  const std::map<std::string, std::string>& measured_;
  std::string indent_ = "  ";
};

}  // namespace

std::string edit_expect_section(const std::string& source, const std::string& text,
                                const io::Expectations& expectations,
                                const std::map<std::string, std::string>& measured) {
  return Editor(source, text, measured).edit(expectations);
}

}  // namespace patrol::app
