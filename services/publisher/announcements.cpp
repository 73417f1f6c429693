#include "services/publisher/announcements.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>

namespace spindrift {
namespace {

bool is_announced(const Product& product) {
  return std::visit(
      []<class Kind>(const Kind& value) {
        if constexpr (AnnouncedProduct<Kind>) {
          return ProductKind<Kind>::is_announced(value);
        } else {
          return false;
        }
      },
      product);
}

/// Identifies an instance on the bus: spacecraft, kind of product and name within the kind.
/// Subscribers see only the latest of each instance.
using Instance = std::tuple<std::string, std::size_t, std::string_view>;

Instance instance_of(const Announcement& announcement) {
  const auto name = std::visit(
      []<class Kind>(const Kind& value) -> std::string_view {
        if constexpr (AnnouncedProduct<Kind>) {
          return ProductKind<Kind>::instance(value);
        } else {
          return {};
        }
      },
      announcement.product);
  return {announcement.spacecraft, announcement.product.index(), name};
}

void keep_latest_of_each(std::vector<Announcement>& announcements) {
  std::map<Instance, Announcement> latest;
  for (const Announcement& announcement : announcements) {
    latest.insert_or_assign(instance_of(announcement), announcement);
  }
  announcements.clear();
  for (const auto& [instance, announcement] : latest) {
    announcements.push_back(announcement);
  }
}

}  // namespace

void Announcements::enqueue(const std::string& spacecraft, const std::string& run_id,
                            std::span<const Product> products,
                            std::optional<std::chrono::steady_clock::time_point> came) {
  std::vector<Announcement> more;
  for (const Product& product : products) {
    if (is_announced(product)) {
      more.push_back(
          {.spacecraft = spacecraft, .run_id = run_id, .product = product, .came = came});
    }
  }
  if (more.empty()) {
    return;  // Most stored products are not announced.
  }
  {
    const std::lock_guard lock{mutex_};
    std::move(more.begin(), more.end(), std::back_inserter(waiting_));
    if (waiting_.size() > kMaxWaiting) {
      keep_latest_of_each(waiting_);
    }
  }
  changed_.notify_one();
}

std::vector<Announcement> Announcements::take_all() {
  std::unique_lock lock{mutex_};
  changed_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
  return std::exchange(waiting_, {});
}

void Announcements::close() {
  {
    const std::lock_guard lock{mutex_};
    closed_ = true;
  }
  changed_.notify_one();
}

}  // namespace spindrift
