#include "monitor/store.h"

#include "monitor/views.h"

namespace patrol::monitor {
namespace {

constexpr const char* kTables = R"sql(
CREATE TABLE IF NOT EXISTS results (
  seq INTEGER PRIMARY KEY AUTOINCREMENT, id TEXT NOT NULL UNIQUE, robot TEXT NOT NULL, run TEXT NOT NULL, world TEXT NOT NULL, sequence INTEGER NOT NULL,
  time_s REAL NOT NULL, made_ms INTEGER NOT NULL, received_ms INTEGER NOT NULL, kind TEXT NOT NULL, summary TEXT NOT NULL, data TEXT NOT NULL) STRICT;
CREATE INDEX IF NOT EXISTS results_by_kind ON results (kind, seq);
CREATE INDEX IF NOT EXISTS results_by_robot ON results (robot, kind, seq);
CREATE INDEX IF NOT EXISTS noted ON results (seq) WHERE kind NOT IN ('pose', 'map');
CREATE INDEX IF NOT EXISTS noted_by_robot ON results (robot, seq) WHERE kind NOT IN ('pose', 'map');
CREATE TABLE IF NOT EXISTS revision (number INTEGER NOT NULL) STRICT;
INSERT INTO revision SELECT 0 WHERE NOT EXISTS (SELECT 1 FROM revision);
)sql";

}  // namespace

Store::Store(const std::filesystem::path& folder) : lock_(folder), database_(folder / "results.sqlite") {
  Transaction transaction(database_);
  database_.execute(kTables);
  database_.execute(kViews);
  transaction.commit();
}

std::int64_t Store::next_revision() {
  database_.prepared("UPDATE revision SET number = number + 1").bind().run();
  return database_.find_integer("SELECT number FROM revision").value();
}

std::vector<StoreStatus> Store::add(const std::vector<Result>& results, std::int64_t received_ms) {
  Transaction transaction(database_);
  const std::int64_t revision = next_revision();
  std::vector<StoreStatus> stored;
  for (const Result& result : results) stored.push_back(add_one(result, received_ms, revision));
  transaction.commit();
  return stored;
}

StoreStatus Store::add_one(const Result& result, std::int64_t received_ms, std::int64_t revision) {
  Statement& insert = database_.prepared(
      "INSERT INTO results (id, robot, run, world, sequence, time_s, made_ms, received_ms, kind, summary, data) "
      "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11) "
      "ON CONFLICT (id) DO NOTHING");
  insert
      .bind(result.id, result.robot, result.run, result.world, result.sequence, result.time_s, result.created_ms,
            received_ms, result.kind, to_summary(result), result.data)
      .run();
  if (database_.changes() > 0) {
    update_views(database_, result, {.seq = database_.last_row(), .received_ms = received_ms, .revision = revision});
    return StoreStatus::kNew;
  }
  Statement there =
      database_.prepare("SELECT robot, run, world, sequence, time_s, made_ms, kind, data FROM results WHERE id = ?1");
  there.bind(result.id).step();
  const Result known{.id = result.id,
                     .robot = there.text(0),
                     .run = there.text(1),
                     .world = there.text(2),
                     .sequence = there.integer(3),
                     .time_s = there.number(4),
                     .created_ms = there.integer(5),
                     .kind = there.text(6),
                     .data = there.text(7)};
  return to_content(known) == to_content(result) ? StoreStatus::kExisting : StoreStatus::kConflict;
}

AcknowledgeStatus Store::acknowledge(std::int64_t finding, const std::string& who, const std::string& note,
                                     std::int64_t now_ms) {
  Transaction transaction(database_);
  const auto is_done =
      database_.find_integer("SELECT acknowledged_ms IS NOT NULL FROM findings WHERE number = ?1", finding);
  if (!is_done) return AcknowledgeStatus::kUnknown;
  if (*is_done != 0) return AcknowledgeStatus::kAlready;
  database_.prepare("UPDATE findings SET acknowledged_ms = ?2, who = ?3, note = ?4, revision = ?5 WHERE number = ?1")
      .bind(finding, now_ms, who, note, next_revision())
      .run();
  transaction.commit();
  return AcknowledgeStatus::kDone;
}

}  // namespace patrol::monitor
