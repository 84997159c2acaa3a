#include "sim/sensors/delivery_queue.h"

#include <algorithm>
#include <utility>

namespace patrol::sim {

void DeliveryQueue::push(Time due, QueuedMessage message) {
  const auto later = std::upper_bound(queue_.begin(), queue_.end(), due,
                                      [](Time time, const Delivery& delivery) { return time < delivery.due; });
  queue_.insert(later, Delivery{due, std::move(message)});
}

std::vector<QueuedMessage> DeliveryQueue::take_due(Time now) {
  const auto is_later = [&](const Delivery& delivery) { return delivery.due > now; };
  const auto first_later = std::find_if(queue_.begin(), queue_.end(), is_later);
  std::vector<QueuedMessage> due;
  for (auto delivery = queue_.begin(); delivery != first_later; ++delivery) due.push_back(std::move(delivery->queued));
  queue_.erase(queue_.begin(), first_later);
  return due;
}

}  // namespace patrol::sim
