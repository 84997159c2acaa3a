#include "io/trajectories/relations.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/line_reader.h"
#include "io/files/line_tokenizer.h"

namespace patrol::io {
namespace {

PoseRelation parse_relation(LineTokenizer fields) {
  PoseRelation relation;
  relation.from = fields.stamp("t1");
  relation.to = fields.stamp("t2");
  relation.T_from_to.x = fields.distance("x");
  relation.T_from_to.y = fields.distance("y");
  for (const char* const what : {"z", "roll", "pitch"}) fields.number(what);
  relation.T_from_to.yaw = wrap_angle(fields.number("yaw"));
  if (!fields.is_empty()) throw ParseError("more than eight numbers");
  return relation;
}

}  // namespace

std::vector<PoseRelation> load_relations(const std::filesystem::path& file) {
  LineReader lines(file);
  std::vector<PoseRelation> relations;
  while (const auto line = lines.next()) {
    const LineTokenizer fields(line->text);
    if (fields.is_empty() || line->text.front() == '#') continue;
    try {
      if (line->is_cut) throw ParseError("is too long");
      relations.push_back(parse_relation(fields));
    } catch (const ParseError& error) {
      throw input_error(file.string(), line->number,
                        fmt::format("{}: a relation is t1 t2 x y z roll pitch yaw", error.what()));
    }
  }
  if (lines.read_error()) throw InputError(fmt::format("{}: {}", file.string(), *lines.read_error()));
  if (relations.empty()) throw InputError(file.string() + ": contains no relations");
  return relations;
}

}  // namespace patrol::io
