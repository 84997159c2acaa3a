#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/record/outbox.h"
#include "monitor/url.h"

namespace patrol::app {

/// Address and credentials of a monitoring server.
struct MonitorServer {
  monitor::Url url;
  std::string token;
};

/// Creates the address from a URL and the token from its file, or without one from PATROL_TOKEN. Throws InputError if
/// either is missing or invalid.
MonitorServer make_monitor_server(const std::string& url, const std::optional<std::filesystem::path>& token_file);

struct DeliverySettings {
  std::size_t batch_results = 200;  ///< maximum number of results in one request
  std::size_t batch_bytes = 4'000'000;
  double gather_s = 0.1;  ///< delay from the first waiting result to its request, to collect others
  double request_timeout_s = 10.0;
  double first_pause_s = 0.25;  ///< pause after a failed request; doubled for each further one
  double max_pause_s = 5.0;
};

/// Uploads the results of an outbox to a monitoring server, one batch at a time.
class Sender {
 public:
  enum class Outcome { kEmpty, kSent, kInvalidToken, kUnreachable };

  Sender(Outbox& outbox, MonitorServer server, const DeliverySettings& settings = {});

  /// Sends the next batch. A batch that the server rejects is halved until a single result remains, which is set aside.
  Outcome send_next();
  /// Reason why the last batch was not accepted.
  const std::string& last_error() const { return last_error_; }

 private:
  void set_aside_conflicts(const Outbox::Batch& batch, const std::string& response);

  Outbox& outbox_;
  MonitorServer server_;
  DeliverySettings settings_;
  std::size_t batch_limit_;  ///< maximum number of results in the next batch
  std::string last_error_;
};

/// Uploads in the background while results are added; retries while the server is unreachable. Thread-safe: the public
/// functions may be called while the background thread runs.
class Delivery {
 public:
  /// The outbox must outlive the object.
  Delivery(Outbox& outbox, MonitorServer server, const DeliverySettings& settings = {});
  /// Stops the upload; pending results stay in the outbox.
  ~Delivery();
  Delivery(const Delivery&) = delete;
  Delivery& operator=(const Delivery&) = delete;

  /// Notifies the background thread of new results.
  void wake();
  /// Waits until the outbox is empty; false after the time limit.
  bool wait_until_empty(double timeout_s);
  std::string last_error() const;

 private:
  void run();

  DeliverySettings settings_;
  Sender sender_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool is_stopping_ = false, has_news_ = true, is_empty_ = false;
  std::string last_error_;
  std::thread thread_;
};

}  // namespace patrol::app
