#include "app/monitor/delivery.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text.h"
#include "monitor/http_client.h"
#include "monitor/token.h"

namespace patrol::app {
namespace {

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * seconds));
}

/// Error message of a response, one line.
std::string error_of(const monitor::HttpClientResponse& response) {
  const auto json = nlohmann::json::parse(response.body, nullptr, false);
  const bool explain = json.is_object() && json.contains("error") && json["error"].is_string();
  return fmt::format("{} {}", response.status, explain ? json["error"].get<std::string>() : "");
}

}  // namespace

MonitorServer make_monitor_server(const std::string& url, const std::optional<std::filesystem::path>& token_file) {
  MonitorServer server{.url = monitor::parse_url(url), .token = {}};
  if (token_file) {
    server.token = monitor::load_token(*token_file);
  } else if (const char* token = std::getenv("PATROL_TOKEN"); token != nullptr) {
    server.token = token;
    monitor::check_token("PATROL_TOKEN", server.token);
  } else {
    throw InputError(fmt::format(
        "{}: access token required: name its file (DIR/token of the monitoring server) or set PATROL_TOKEN", url));
  }
  return server;
}

Sender::Sender(Outbox& outbox, MonitorServer server, const DeliverySettings& settings)
    : outbox_(outbox), server_(std::move(server)), settings_(settings), batch_limit_(settings.batch_results) {}

Sender::Outcome Sender::send_next() {
  const Outbox::Batch batch = outbox_.next(batch_limit_, settings_.batch_bytes);
  if (batch.results.empty()) return Outcome::kEmpty;
  const std::string body = fmt::format("[{}]", join(batch.results, ","));
  const auto response =
      monitor::post_json(server_.url, "/api/results", server_.token, body, settings_.request_timeout_s, &last_error_);
  if (!response) return Outcome::kUnreachable;
  if (response->status == 200 || response->status == 409) {
    if (response->status == 409) set_aside_conflicts(batch, response->body);
    outbox_.mark_sent(batch);
    batch_limit_ = std::min(settings_.batch_results, 2 * batch_limit_);
    return Outcome::kSent;
  }
  last_error_ = error_of(*response);
  if (response->status == 401) return Outcome::kInvalidToken;
  if (response->status != 400 && response->status != 413) return Outcome::kUnreachable;
  if (batch.results.size() > 1) {
    batch_limit_ = batch.results.size() / 2;
  } else {
    outbox_.set_aside(batch.results.front());
    outbox_.mark_sent(batch);
    batch_limit_ = settings_.batch_results;
  }
  return Outcome::kSent;
}

void Sender::set_aside_conflicts(const Outbox::Batch& batch, const std::string& response) {
  const auto json = nlohmann::json::parse(response);
  const auto& results = json.at("results");  // in the order of the batch
  for (std::size_t i = 0; i < batch.results.size(); ++i) {
    if (results.at(i).at("status") == "conflict") outbox_.set_aside(batch.results[i]);
  }
}

Delivery::Delivery(Outbox& outbox, MonitorServer server, const DeliverySettings& settings)
    : settings_(settings), sender_(outbox, std::move(server), settings), thread_([this] { run(); }) {}

Delivery::~Delivery() {
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Delivery::wake() {
  {
    const std::lock_guard lock(mutex_);
    has_news_ = true;
    is_empty_ = false;
  }
  changed_.notify_all();
}

bool Delivery::wait_until_empty(double timeout_s) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, milliseconds(timeout_s), [this] { return is_empty_; });
}

std::string Delivery::last_error() const {
  const std::lock_guard lock(mutex_);
  return last_error_;
}

void Delivery::run() {
  double pause_s = settings_.first_pause_s;
  std::unique_lock lock(mutex_);
  while (!is_stopping_) {
    has_news_ = false;
    lock.unlock();
    Sender::Outcome outcome = Sender::Outcome::kUnreachable;
    std::string reason;
    try {
      outcome = sender_.send_next();
      reason = sender_.last_error();
    } catch (const std::exception& error) {  // the disk is full, or the response is not one of a monitoring server
      reason = error.what();
    }
    lock.lock();
    if (outcome == Sender::Outcome::kSent) {
      pause_s = settings_.first_pause_s;
    } else if (outcome == Sender::Outcome::kEmpty) {
      if (has_news_) continue;
      is_empty_ = true;
      changed_.notify_all();
      changed_.wait(lock, [this] { return is_stopping_ || has_news_; });
      changed_.wait_for(lock, milliseconds(settings_.gather_s), [this] { return is_stopping_; });
    } else {
      last_error_ = reason;
      changed_.wait_for(lock, milliseconds(pause_s), [this] { return is_stopping_; });
      pause_s = std::min(settings_.max_pause_s, 2.0 * pause_s);
    }
  }
}

}  // namespace patrol::app
