#include "monitor/service.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "io/json/json_check.h"
#include "io/json/json_object.h"
#include "monitor/assets.h"
#include "monitor/queries.h"
#include "monitor/token.h"

namespace patrol::monitor {
namespace {

using io::Json;

constexpr std::string_view kAlarms = "/api/alarms/", kAcknowledge = "/acknowledge", kMaps = "/api/maps/",
                           kResults = "/api/results";
constexpr std::size_t kMaxWhoBytes = 80, kMaxNoteBytes = 500, kMaxShownHost = 100;
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

struct Asset {
  std::string_view path, type, content;
};

const Asset* asset_at(std::string_view path) {
  static const Asset kAssets[] = {{"/", "text/html; charset=utf-8", kPage},
                                  {"/page.css", "text/css; charset=utf-8", kPageStyle},
                                  {"/page.js", "text/javascript; charset=utf-8", kPageScript},
                                  {"/site.js", "text/javascript; charset=utf-8", kSiteScript},
                                  {"/format.js", "text/javascript; charset=utf-8", kFormatScript},
                                  {"/map.js", "text/javascript; charset=utf-8", kMapScript},
                                  {"/plots.js", "text/javascript; charset=utf-8", kPlotsScript},
                                  {"/uplot.js", "text/javascript; charset=utf-8", kPlotLibrary},
                                  {"/uplot.css", "text/css; charset=utf-8", kPlotStyle},
                                  {"/schema", "application/schema+json", kSchema}};
  for (const Asset& asset : kAssets) {
    if (asset.path == path) return &asset;
  }
  return nullptr;
}

std::optional<std::int64_t> whole(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0) return std::nullopt;
  return value;
}

/// Number between prefix and suffix of a path, none if the path has another form.
std::optional<std::int64_t> number_between(std::string_view path, std::string_view head, std::string_view tail) {
  if (!path.starts_with(head) || !path.ends_with(tail) || path.size() <= head.size() + tail.size()) return std::nullopt;
  return whole(path.substr(head.size(), path.size() - head.size() - tail.size()));
}

std::string parameter(const HttpRequest& request, const char* name) {
  const auto there = request.parameters.find(name);
  return there == request.parameters.end() ? "" : there->second;
}

/// Integer parameter of a request, `otherwise` if absent. Throws InputError when it is not a whole number.
std::int64_t count(const HttpRequest& request, const char* name, std::int64_t otherwise) {
  const std::string text = parameter(request, name);
  if (text.empty()) return otherwise;
  const auto value = whole(text);
  if (!value || *value > 1'000'000'000'000) throw InputError(fmt::format("{} must be an integer", name));
  return *value;
}

int limit_of(const HttpRequest& request, int otherwise) {
  return static_cast<int>(std::min<std::int64_t>(count(request, "limit", otherwise), 1000));
}

HttpResponse fresh(std::string json) { return {.body = std::move(json), .headers = {{"Cache-Control", "no-store"}}}; }

/// Token of an Authorization header, empty for another scheme. Schemes are case-insensitive (RFC 9110, 11.1).
std::string_view bearer_token(std::string_view header) {
  constexpr std::string_view kScheme = "bearer ";
  const auto is_same_letter = [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); };
  if (header.size() < kScheme.size() || !std::equal(kScheme.begin(), kScheme.end(), header.begin(), is_same_letter))
    return {};
  header.remove_prefix(kScheme.size());
  header.remove_prefix(std::min(header.find_first_not_of(' '), header.size()));
  return header;
}

bool is_post_path(std::string_view path) {
  return path == kResults || number_between(path, kAlarms, kAcknowledge).has_value();
}

bool is_get_path(std::string_view path) {
  for (const char* known : {"/api/changes", "/api/robots", "/api/alarms", "/api/run", "/api/lining", "/api/water",
                            "/api/gas", "/api/history"}) {
    if (path == known) return true;
  }
  return asset_at(path) != nullptr || number_between(path, kMaps, "").has_value();
}

HttpResponse get(Database& database, const HttpRequest& request) {
  const std::string& path = request.path;
  if (const Asset* asset = asset_at(path)) {
    return {.type = std::string(asset->type),
            .body = std::string(asset->content),
            .headers = {{"Cache-Control", "no-cache"},
                        {"Content-Security-Policy", kPolicy},
                        {"Referrer-Policy", "no-referrer"}}};
  }
  if (path == "/api/changes") return fresh(changes(database, count(request, "since", 0), now_ms()));
  if (path == "/api/robots")
    return fresh(robots(database, {.after = parameter(request, "after"), .limit = limit_of(request, 200)}));
  if (path == "/api/alarms") {
    return fresh(alarms(database, {.only_open = parameter(request, "open") == "1",
                                   .before = count(request, "before", 0),
                                   .limit = limit_of(request, 100)}));
  }
  if (path == "/api/run") {
    const auto details =
        run_details(database, parameter(request, "robot"), parameter(request, "run"), count(request, "station", 0));
    return details ? fresh(*details) : error_response(404, "unknown robot or run");
  }
  if (path == "/api/lining") {
    return fresh(lining(database, parameter(request, "world"), parse_lining_page(parameter(request, "after"))));
  }
  if (path == "/api/water") return fresh(water(database, parameter(request, "world")));
  if (path == "/api/gas") return fresh(gas(database, parameter(request, "world")));
  if (path == "/api/history") {
    return fresh(history(database, {.robot = parameter(request, "robot"),
                                    .kind = parameter(request, "kind"),
                                    .before = count(request, "before", 0),
                                    .limit = limit_of(request, 25)}));
  }
  const auto image = map_image(database, *number_between(path, kMaps, ""));
  if (!image) return error_response(404, "unknown map");
  return {.type = "image/png", .body = *image, .headers = {{"Cache-Control", "no-store"}}};
}

}  // namespace

Service::Service(Store& store, std::string token, HttpServer::Log log, HostNames hosts)
    : store_(store), token_(std::move(token)), log_(std::move(log)), hosts_(std::move(hosts)) {}

std::optional<HttpResponse> Service::refuse(const HttpRequest& head) {
  if (!hosts_.allow(head.host, head.local)) {
    const std::string host = head.host.substr(0, kMaxShownHost);
    return error_response(
        421,
        fmt::format("Host '{}': unknown: must be the server's address, localhost, or a name of --allow-host", host));
  }
  const bool posts = is_post_path(head.path), gets = is_get_path(head.path);
  if (!posts && !gets) return error_response(404, "not found");
  const std::string allowed = posts ? "POST" : "GET";
  if (head.method != allowed) {
    HttpResponse no = error_response(405, fmt::format("method not allowed: must be {}", allowed));
    no.headers.emplace_back("Allow", allowed);
    return no;
  }
  if (posts && !is_same_token(bearer_token(head.authorization), token_)) {
    HttpResponse no =
        error_response(401, head.authorization.empty() ? "token required: Authorization: Bearer ..." : "invalid token");
    no.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"patrol\"");
    return no;
  }
  return std::nullopt;
}

HttpResponse Service::answer(const HttpRequest& request) {
  try {
    if (request.path == kResults) return take_results(request);
    if (request.method == "POST") return acknowledge(request);
    return get(store_.database(), request);
  } catch (const InputError& error) {
    return error_response(400, error.what());
  }
}

HttpResponse Service::take_results(const HttpRequest& request) {
  const std::vector<Result> results = results_from_json(request.body);
  const std::vector<StoreStatus> stored = store_.add(results, now_ms());
  Json list = Json::array();
  bool has_conflict = false;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const bool is_conflict = stored[i] == StoreStatus::kConflict;
    has_conflict = has_conflict || is_conflict;
    list.push_back({{"id", results[i].id},
                    {"status", is_conflict                           ? "conflict"
                               : stored[i] == StoreStatus::kExisting ? "known"
                                                                     : "stored"}});
    if (is_conflict) log_(fmt::format("{} 409: duplicate id {} with a different result", request.peer, results[i].id));
  }
  Json answer = {{"results", list}};
  if (has_conflict) answer["error"] = "duplicate id with a different result; nothing was changed";
  return {.status = has_conflict ? 409 : 200, .body = answer.dump(), .headers = {}};
}

HttpResponse Service::acknowledge(const HttpRequest& request) {
  io::check_json("body", request.body, 10);
  const Json json = Json::parse(request.body);
  const io::JsonObject object("body", json, {"who", "note"});
  const std::string who = object.string("who"), note = object.string("note");
  if (who.empty() || who.size() > kMaxWhoBytes) object.fail(fmt::format("who must have 1 to {} bytes", kMaxWhoBytes));
  if (note.size() > kMaxNoteBytes) object.fail(fmt::format("note must have at most {} bytes", kMaxNoteBytes));
  const std::int64_t number = *number_between(request.path, kAlarms, kAcknowledge);
  switch (store_.acknowledge(number, who, note, now_ms())) {
    case AcknowledgeStatus::kUnknown:
      return error_response(404, "unknown alarm");
    case AcknowledgeStatus::kAlready:
      return error_response(409, "alarm already acknowledged");
    case AcknowledgeStatus::kDone:
      break;
  }
  log_(fmt::format("{} alarm {} acknowledged by {}", request.peer, number, who));
  return {.body = Json{{"number", number}}.dump(), .headers = {}};
}

}  // namespace patrol::monitor
