#include "app/monitor/reporter.h"

#include <chrono>
#include <cmath>
#include <random>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/overloaded.h"
#include "inspect/route_frame.h"
#include "io/files/base64.h"
#include "io/files/one_line.h"
#include "io/json/inspection_json.h"
#include "io/maps/map_png.h"

namespace patrol::app {
namespace {

using Json = nlohmann::json;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json point(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }

Json event_json(const Event& event) {
  return {{"kind", kind_text(event)},
          {"subject", io::on_one_line(event.subject)},
          {"text", io::on_one_line(event.text)},
          {"value", std::isfinite(event.value) ? Json(event.value) : Json(nullptr)},
          {"pose", io::to_json(event.T_map_body)},
          {"position_m", point(event.p_map_target)}};
}

Json map_json(const OccupancyGrid& map) {
  const GridGeometry& geometry = map.geometry();
  return {{"width", geometry.width},
          {"height", geometry.height},
          {"resolution_m", geometry.resolution_m},
          {"origin_m", point(geometry.origin_m)},
          {"png_base64", io::to_base64(io::map_png(map))}};
}

bool is_same(const OccupancyGrid& a, const OccupancyGrid& b) {
  const GridGeometry &one = a.geometry(), &other = b.geometry();
  return one.width == other.width && one.height == other.height && one.origin_m == other.origin_m &&
         a.values() == b.values();
}

/// Stations and goals of the mission as JSON.
Json stations_of(const ScenarioFiles& files) {
  Json list = Json::array();
  const auto add = [&](const std::string& name, std::string_view type, const Pose2& T_map_body) {
    list.push_back({{"name", io::on_one_line(name)}, {"type", type}, {"position_m", point(T_map_body.position())}});
  };
  const Route route = inspect::to_map(files.route, files.T_site_start);
  for (const Station& station : route.stations) add(station.name, name_of(station.type), station.T_route_body);
  for (const SavedGoal& goal : files.goals) add(goal.name(), name_of(goal.type), goal.T_map_body);
  if (route.dock) add("dock", "dock", route.dock->T_route_docked);
  return list;
}

}  // namespace

std::string new_run_name(const std::string& scenario, std::uint64_t seed) {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{}-seed{}-{:%Y%m%dT%H%M%SZ}-{:04x}", scenario, seed,
                     fmt::gmtime(std::chrono::system_clock::to_time_t(now)), std::random_device()() & 0xffffU);
}

Reporter::Reporter(std::filesystem::path root, ReportedRun run, MonitorServer server, const ReporterSettings& settings)
    : root_(std::move(root)), run_(std::move(run)), server_(std::move(server)), settings_(settings) {}

void Reporter::begin(const ScenarioFiles& files) {
  outbox_ = std::make_unique<Outbox>(root_);
  delivery_ = std::make_unique<Delivery>(*outbox_, server_);
  report_status("started", "", text_of(stations_of(files)));
  if (files.map) report_map({.stamp = {}, .map = *files.map});
}

void Reporter::on_message(const stack::StackMessage& message) {
  std::visit(Overloaded{
                 [&](const PoseEstimate& estimate) {
                   newest_ = std::max(newest_, estimate.stamp);
                   if (estimate.stamp < next_pose_) return;
                   next_pose_ = estimate.stamp + from_seconds(settings_.pose_period_s);
                   report(estimate.stamp, "pose", text_of(io::to_json(estimate.T_map_body)));
                 },
                 [&](const MapUpdate& update) {
                   pending_map_ = update;
                   if (update.stamp >= next_map_) report_map(update);
                 },
                 [&](const Event& event) { report(event.stamp, "event", text_of(event_json(event))); },
                 [&](const LiningResult& result) { report(result.stamp, "lining", text_of(io::to_json(result))); },
                 [&](const WaterResult& result) { report(result.stamp, "water", text_of(io::to_json(result))); },
                 [](const auto&) {},
             },
             message);
}

void Reporter::finish(const std::string& state, const std::string& message) {
  if (!outbox_) return;  // never begun
  if (pending_map_) report_map(*std::exchange(pending_map_, std::nullopt));
  report_status(state.c_str(), io::on_one_line(message), "[]");
  delivery_->wait_until_empty(settings_.drain_timeout_s);
}

void Reporter::report(Time stamp, const char* kind, std::string data) {
  newest_ = std::max(newest_, stamp);
  outbox_->add({.id = fmt::format("{}/{}/{}", run_.robot, run_.run, sequence_),
                .robot = run_.robot,
                .run = run_.run,
                .world = run_.world,
                .sequence = sequence_,
                .time_s = std::max(0.0, to_seconds(stamp)),
                .created_ms = monitor::now_ms(),
                .kind = kind,
                .data = std::move(data)});
  ++sequence_;
  delivery_->wake();
}

void Reporter::report_map(const MapUpdate& update) {
  const bool is_empty = update.map.values().empty();
  pending_map_.reset();
  if (is_empty || is_same(update.map, last_sent_map_)) return;
  next_map_ = update.stamp + from_seconds(settings_.map_period_s);
  report(update.stamp, "map", text_of(map_json(update.map)));
  last_sent_map_ = update.map;
}

void Reporter::report_status(const char* state, const std::string& message, const std::string& stations) {
  const Json json = {
      {"state", state}, {"scenario", run_.scenario}, {"message", message}, {"stations", Json::parse(stations)}};
  report(newest_, "status", text_of(json));
}

}  // namespace patrol::app
