#include "services/spindrift/announcer.h"

#include <spdlog/spdlog.h>

namespace spindrift {
namespace {

constexpr std::size_t kQueued = 65536;

}  // namespace

Announcer::Announcer(const ResultPublisher& publisher)
    : publisher_{publisher}, queue_{kQueued}, thread_{[this] { run(); }} {}

Announcer::~Announcer() {
  queue_.close();
  thread_.join();
}

void Announcer::committed(std::span<const ArchiveBatch> batches) {
  for (const ArchiveBatch& batch : batches) {
    for (const SpinProduct& product : batch.products) {
      if (const auto* fix = std::get_if<SpinFix>(&product)) {
        queue_.push({.spacecraft = batch.spacecraft_id, .product = *fix});
      } else if (const auto* estimate = std::get_if<SpinEstimate>(&product)) {
        queue_.push({.spacecraft = batch.spacecraft_id, .product = *estimate});
      }
    }
  }
}

void Announcer::run() {
  for (auto results = queue_.take_all(); !results.empty(); results = queue_.take_all()) {
    for (const Result& result : results) {
      const auto published = std::visit(
          [&](const auto& product) { return publisher_.publish(result.spacecraft, product); },
          result.product);
      if (!published) {
        spdlog::error("not published: {}", published.error().message);
      }
    }
  }
}

}  // namespace spindrift
