#include "services/publisher/announcements.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

namespace spindrift {
namespace {

std::optional<Announcement> announcement_of(const std::string& spacecraft,
                                            const std::string& run_id, const SpinProduct& product) {
  if (const auto* estimate = std::get_if<SpinEstimate>(&product)) {
    return Announcement{.spacecraft = spacecraft, .run_id = run_id, .product = *estimate};
  }
  if (const auto* fix = std::get_if<SpinFix>(&product);
      fix != nullptr && (fix->accepted || fix->resolution == Resolution::Ambiguous)) {
    return Announcement{.spacecraft = spacecraft, .run_id = run_id, .product = *fix};
  }
  return std::nullopt;
}

/// Of the instance on the bus, which only the latest of is seen.
std::pair<std::string, std::string_view> key_of(const Announcement& announcement) {
  const auto* estimate = std::get_if<SpinEstimate>(&announcement.product);
  return {announcement.spacecraft, estimate == nullptr ? "fix" : name_of(estimate->estimator)};
}

void keep_latest_of_each(std::vector<Announcement>& announcements) {
  std::map<std::pair<std::string, std::string_view>, Announcement> latest;
  for (const Announcement& announcement : announcements) {
    latest.insert_or_assign(key_of(announcement), announcement);
  }
  announcements.clear();
  for (const auto& [key, announcement] : latest) {
    announcements.push_back(announcement);
  }
}

}  // namespace

void Announcements::add(const std::string& spacecraft, const std::string& run_id,
                        std::span<const SpinProduct> products) {
  std::vector<Announcement> more;
  for (const SpinProduct& product : products) {
    if (auto announcement = announcement_of(spacecraft, run_id, product)) {
      more.push_back(std::move(*announcement));
    }
  }
  if (more.empty()) {
    return;  // Most of what is stored is not announced: nobody is woken for it.
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
