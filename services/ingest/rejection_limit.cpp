#include "services/ingest/rejection_limit.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "pipelines/time/utc.h"
#include "services/ingest/sequence_tracker.h"

namespace spindrift {
namespace {

constexpr std::chrono::minutes kMinute{1};

}  // namespace

std::optional<RejectedInput> RejectionLimit::pass(RejectedInput rejected, TaiTime now) {
  if (sources_.empty()) {
    began_ = now;
  }
  Minute& minute = minute_of(rejected.source);
  if (minute.kept < kKept) {
    ++minute.kept;
    return rejected;
  }
  ++minute.counted;
  minute.last = std::move(rejected);
  return std::nullopt;
}

std::vector<RejectedInput> RejectionLimit::take_rest(TaiTime now) {
  std::vector<RejectedInput> rest;
  // The minute also ends when the clock is set back.
  if (now >= began_ && now - began_ < kMinute) {
    return rest;
  }
  for (auto& [source, minute] : std::exchange(sources_, {})) {
    if (minute.counted > 0) {
      rest.push_back(
          {.source = source,
           .line = minute.last.line,
           .reason = fmt::format("{} more in the minute since {} are only counted, the "
                                 "last: {}",
                                 minute.counted, format_utc(began_, 0), minute.last.reason),
           .session = minute.last.session,
           .samples = minute.counted});
    }
  }
  return rest;
}

RejectionLimit::Minute& RejectionLimit::minute_of(const std::string& source) {
  const bool room = sources_.size() < kMaxSources || sources_.contains(source);
  return sources_[room ? source : SequenceTracker::kOtherSources];
}

}  // namespace spindrift
