#include "io/trajectories/g2o.h"

#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/linear_algebra.h"
#include "io/files/atomic_file.h"
#include "io/files/line_reader.h"
#include "io/files/line_tokenizer.h"

namespace patrol::io {
namespace {

using Id = std::int64_t;

Id read_id(LineTokenizer& fields) { return fields.integer("id", 0, std::numeric_limits<Id>::max()); }

Eigen::Matrix3d read_information(LineTokenizer& fields) {
  Eigen::Matrix3d information;
  for (int row = 0; row < 3; ++row) {
    for (int col = row; col < 3; ++col) information(row, col) = fields.number("information");
  }
  information.triangularView<Eigen::StrictlyLower>() = information.transpose();
  if (!is_positive_definite(information)) throw ParseError("information is not positive definite");
  return information;
}

/// Reader that keeps the ids of the file until all vertices are known.
class G2oReader {
 public:
  explicit G2oReader(const std::filesystem::path& file) : lines_(file) {}

  PoseGraph read() {
    while (const auto line = lines_.next()) {
      line_ = line->number;
      try {
        if (line->is_cut) throw ParseError("is too long");
        read_line(LineTokenizer(line->text));
      } catch (const ParseError& error) {
        fail(line_, error.what());
      }
    }
    if (lines_.read_error()) throw InputError(fmt::format("{}: {}", lines_.file().string(), *lines_.read_error()));
    if (graph_.T_map_node.empty()) throw InputError(lines_.file().string() + ": contains no VERTEX_SE2");
    resolve_ids();
    return std::move(graph_);
  }

 private:
  /// Reference of a line to an id.
  struct Naming {
    Id id;
    int line;
  };

  [[noreturn]] void fail(int line, const std::string& what) const {
    throw input_error(lines_.file().string(), line, what);
  }

  void read_line(LineTokenizer fields) {
    if (fields.is_empty()) return;
    const std::string_view tag = fields.word("a tag");
    if (tag.front() == '#') return;
    try {
      if (tag == "VERTEX_SE2") read_vertex(fields);
      else if (tag == "EDGE_SE2") read_edge(fields);
      else if (tag == "FIX") read_fixed(fields);
      else throw ParseError("unknown tag (known: VERTEX_SE2, EDGE_SE2, FIX)");
      if (!fields.is_empty()) throw ParseError("too many words");
    } catch (const ParseError& error) {
      constexpr std::size_t kMaxShown = 24;
      throw ParseError(fmt::format("{}: {}", tag.substr(0, kMaxShown), error.what()));
    }
  }

  void read_vertex(LineTokenizer& fields) {
    const Id id = read_id(fields);
    if (!node_of_.emplace(id, static_cast<int>(graph_.T_map_node.size())).second)
      throw ParseError(fmt::format("id {}: duplicate", id));
    graph_.T_map_node.push_back(fields.pose("pose"));
  }

  void read_edge(LineTokenizer& fields) {
    const Naming from{read_id(fields), line_}, to{read_id(fields), line_};
    if (from.id == to.id) throw ParseError(fmt::format("goes from {} to itself", from.id));
    PoseGraphEdge edge;
    edge.T_from_to = fields.pose("pose");
    edge.information = read_information(fields);
    ends_.emplace_back(from, to);
    graph_.edges.push_back(edge);
  }

  void read_fixed(LineTokenizer& fields) {
    do fixed_.push_back({read_id(fields), line_});
    while (!fields.is_empty());
  }

  int node(const Naming& naming) const {
    const auto found = node_of_.find(naming.id);
    if (found == node_of_.end()) fail(naming.line, fmt::format("unknown VERTEX_SE2 {}", naming.id));
    return found->second;
  }

  void resolve_ids() {
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      PoseGraphEdge& edge = graph_.edges[i];
      edge.from = node(ends_[i].first);
      edge.to = node(ends_[i].second);
      edge.kind = edge.to == edge.from + 1 ? PoseGraphEdge::Kind::kOdometry : PoseGraphEdge::Kind::kLoop;
    }
    for (const Naming& naming : fixed_) node(naming);
  }

  LineReader lines_;
  int line_ = 0;  ///< number of the current line
  PoseGraph graph_;
  std::unordered_map<Id, int> node_of_;
  std::vector<std::pair<Naming, Naming>> ends_;  ///< [edge]
  std::vector<Naming> fixed_;
};

std::string pose_text(const Pose2& pose) { return fmt::format("{} {} {}", pose.x, pose.y, pose.yaw); }

}  // namespace

PoseGraph load_g2o(const std::filesystem::path& file) { return G2oReader(file).read(); }

std::string to_g2o(const PoseGraph& graph) {
  std::string text;
  for (std::size_t i = 0; i < graph.T_map_node.size(); ++i)
    text += fmt::format("VERTEX_SE2 {} {}\n", i, pose_text(graph.T_map_node[i]));
  if (!graph.T_map_node.empty()) text += "FIX 0\n";
  for (const PoseGraphEdge& edge : graph.edges) {
    const Eigen::Matrix3d& I = edge.information;
    text += fmt::format("EDGE_SE2 {} {} {} {} {} {} {} {} {}\n", edge.from, edge.to, pose_text(edge.T_from_to), I(0, 0),
                        I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2));
  }
  return text;
}

void save_g2o(const std::filesystem::path& file, const PoseGraph& graph) { save_text(file, to_g2o(graph)); }

}  // namespace patrol::io
