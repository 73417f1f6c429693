#include "services/program/announcer.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>
#include <vector>

#include "services/base/contained.h"
#include "services/program/summary_text.h"

namespace spindrift {
namespace {

constexpr std::chrono::seconds kBetweenEstimatesInLog{10};

std::vector<Product> news(const std::vector<Product>& products, const StoredResults& announced) {
  std::vector<Product> news;
  std::copy_if(products.begin(), products.end(), std::back_inserter(news),
               [&](const Product& product) { return !announced.hold(product); });
  return news;
}

bool is_estimate(const Product& product) {
  return std::holds_alternative<SpinEstimate>(product) ||
         std::holds_alternative<AttitudeEstimate>(product);
}

}  // namespace

Announcer::Announcer(const ResultPublisher& publisher, ConsoleFeed* feed, ServiceTerminal& terminal,
                     Bell& new_answers, ThreadFailures& failures)
    : publisher_{publisher},
      feed_{feed},
      terminal_{terminal},
      new_answers_{new_answers},
      thread_{[this, &failures] { failures.report(contained("announcing", [this] { run(); })); }} {}

Announcer::~Announcer() {
  waiting_.close();
  thread_.join();
}

void Announcer::go_on(const std::string& run_id, const std::string& spacecraft,
                      StoredResults stored) {
  waiting_.enqueue(spacecraft, run_id, stored.in_force());
  announced_before_.insert_or_assign(run_id, std::move(stored));
}

void Announcer::announce(const ArchiveBatch& batch) {
  waiting_.enqueue(batch.spacecraft_id, batch.run_id, batch.products);
}

void Announcer::committed(std::span<const ArchiveBatch> batches) {
  for (const ArchiveBatch& batch : batches) {
    if (batch.start && batch.start->mode == RunMode::Process) {
      unannounced_.insert(batch.run_id);
    }
    if (unannounced_.contains(batch.run_id)) {
      continue;
    }
    terminal_.count(batch);
    if (feed_ != nullptr) {
      feed_->put_details(batch);
    }
    if (const auto before = announced_before_.find(batch.run_id);
        before == announced_before_.end()) {
      waiting_.enqueue(batch.spacecraft_id, batch.run_id, batch.products, batch.came);
    } else {
      waiting_.enqueue(batch.spacecraft_id, batch.run_id, news(batch.products, before->second),
                       batch.came);
    }
  }
}

void Announcer::run() {
  for (auto results = waiting_.take_all(); !results.empty(); results = waiting_.take_all()) {
    std::map<std::string, const Product*> latest;
    for (const Announcement& result : results) {
      if (!is_news(result)) {
        continue;
      }
      hand_out(result);
      if (is_estimate(result.product) && !terminal_.has_status_line()) {
        latest.insert_or_assign(result.spacecraft, &result.product);
      }
    }
    for (const auto& [spacecraft, estimate] : latest) {
      say(spacecraft, *estimate);
    }
    new_answers_.ring();
  }
}

void Announcer::hand_out(const Announcement& result) {
  if (feed_ != nullptr) {
    feed_->put(result.spacecraft, result.run_id, result.product);
  }
  const auto published = publisher_.publish(result.spacecraft, result.run_id, result.product);
  if (!published) {
    spdlog::error("not published: {}", published.error().message);
  }
  if (const auto* const alert = std::get_if<Alert>(&result.product)) {
    terminal_.tell(result.spacecraft, result.run_id, *alert);
  }
  if (feed_ != nullptr && result.came) {
    feed_->note_latency(std::chrono::steady_clock::now() - *result.came);
  }
  if (const auto* const one = std::get_if<ReconstructionProduct>(&result.product)) {
    spdlog::info("{}: separation reconstructed: {}", result.spacecraft, to_text(*one));
  }
}

/// Returns false also for a revision of an alert that arrives after a later one.
bool Announcer::is_news(const Announcement& result) {
  const auto* const alert = std::get_if<Alert>(&result.product);
  if (alert == nullptr) {
    return true;
  }
  const std::int64_t number = ProductKind<Alert>::number(*alert);
  const auto [last, is_first] = alerts_.try_emplace({result.spacecraft, alert->key}, number);
  const bool is_later = number > last->second;
  last->second = std::max(last->second, number);
  return is_first || is_later;
}

void Announcer::say(const std::string& spacecraft, const Product& estimate) {
  const auto now = std::chrono::steady_clock::now();
  const auto said = said_.find(spacecraft);
  if (said != said_.end() && now - said->second < kBetweenEstimatesInLog) {
    return;
  }
  said_.insert_or_assign(spacecraft, now);
  std::visit(
      [&](const auto& is) {
        if constexpr (requires { to_text(is); }) {
          spdlog::info("{}: {}", spacecraft, to_text(is));
        }
      },
      estimate);
}

}  // namespace spindrift
