#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/monitor/outbox.h"
#include "monitor/url.h"

namespace patrol::app {

/// Where results go, and who sends them.
struct Platform {
  monitor::Url url;
  std::string token;
};

/// From the address, and the token's file or, without one, PATROL_TOKEN. Throws InputError when either is missing or wrong.
Platform platform_from(const std::string& address, const std::optional<std::filesystem::path>& token_file);

struct DeliverySettings {
  std::size_t batch_results = 200;   ///< in one request, at most
  std::size_t batch_bytes = 4'000'000;
  double gather_s = 0.1;             ///< from the first result that waits to its request: others come with it
  double request_limit_s = 10.0;
  double first_pause_s = 0.25;       ///< after a request that failed; each further one doubles it
  double longest_pause_s = 5.0;
};

/// Empties an outbox into a platform, one batch at a time.
class Sender {
 public:
  enum class Outcome { kEmpty, kSent, kRefusedToken, kUnreachable };

  Sender(Outbox& outbox, Platform platform, const DeliverySettings& settings = {});

  /// Sends the next batch. One that the platform refuses for good is halved until the result is alone, which is set aside.
  Outcome send_next();
  /// Why the last batch was not taken.
  const std::string& why() const { return why_; }

 private:
  void set_aside_conflicts(const Outbox::Batch& batch, const std::string& answer);

  Outbox& outbox_;
  Platform platform_;
  DeliverySettings settings_;
  std::size_t limit_;  ///< results in the next batch
  std::string why_;
};

/// Sends in the background while results are added, and again and again while the platform is away.
class Delivery {
 public:
  Delivery(Outbox& outbox, Platform platform, const DeliverySettings& settings = {});
  /// Stops; what is left stays in the outbox.
  ~Delivery();
  Delivery(const Delivery&) = delete;
  Delivery& operator=(const Delivery&) = delete;

  /// There is something new.
  void wake();
  /// Waits until the outbox is empty. False: it was not within the limit.
  bool wait_until_empty(double limit_s);
  std::string why_not() const;

 private:
  void run();

  DeliverySettings settings_;
  Sender sender_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool is_stopping_ = false, has_news_ = true, is_empty_ = false;
  std::string why_;
  std::thread thread_;
};

}  // namespace patrol::app
