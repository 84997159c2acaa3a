#include "io/yaml/yaml_document.h"

#include <map>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include "core/error.h"
#include "io/files/bounded_read.h"

namespace patrol::io {
namespace {

/// Checks a stream of parser events against the limits, before any node is built.
class LimitChecker final : public YAML::EventHandler {
 public:
  LimitChecker(const std::string& source, bool has_lines) : source_(source), has_lines_(has_lines) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++num_documents_ > 1) fail(mark, "more than one YAML document: only one is allowed");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add_leaf(mark, anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, const std::string&) override {
    add_leaf(mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto anchored = nodes_by_anchor_.find(anchor);
    if (anchored == nodes_by_anchor_.end()) fail(mark, "an alias refers to a node that contains it");
    add(mark, anchored->second);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  /// List or map that has not ended yet.
  struct Open {
    YAML::anchor_t anchor = 0;
    std::size_t num_nodes_before = 0;
  };

  void add_leaf(const YAML::Mark& mark, YAML::anchor_t anchor) {
    add(mark, 1);
    nodes_by_anchor_[anchor] = 1;
  }

  void add(const YAML::Mark& mark, std::size_t num_nodes) {
    num_nodes_ += num_nodes;
    if (num_nodes_ > kMaxYamlNodes) fail(mark, fmt::format("too many values: at most {} are allowed", kMaxYamlNodes));
  }

  void open(const YAML::Mark& mark, YAML::anchor_t anchor) {
    open_.push_back({.anchor = anchor, .num_nodes_before = num_nodes_});
    add(mark, 1);
  }

  void close() {
    nodes_by_anchor_[open_.back().anchor] = num_nodes_ - open_.back().num_nodes_before;
    open_.pop_back();
  }

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& what) const {
    throw input_error(source_, has_lines_ ? mark.line + 1 : 0, what);
  }

  const std::string& source_;
  bool has_lines_;
  int num_documents_ = 0;
  std::size_t num_nodes_ = 0;  ///< number of nodes with aliases expanded
  std::map<YAML::anchor_t, std::size_t> nodes_by_anchor_;
  std::vector<Open> open_;
};

}  // namespace

YAML::Node parse_yaml(const std::string& source, const std::string& text, bool has_lines) {
  try {
    LimitChecker checker(source, has_lines);
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(checker)) {}
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    const bool has_line = has_lines && !error.mark.is_null();
    throw input_error(source, has_line ? error.mark.line + 1 : 0, "is not YAML: " + error.msg);
  }
}

YAML::Node load_yaml(const std::filesystem::path& file) {
  return parse_yaml(file.string(), load_text(file, kMaxYamlBytes), true);
}

}  // namespace patrol::io
