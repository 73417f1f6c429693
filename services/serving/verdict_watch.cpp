#include "services/serving/verdict_watch.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iterator>
#include <utility>

#include "services/archive/verdict.h"
#include "services/base/contained.h"
#include "services/base/every.h"
#include "services/serving/background_solving.h"

namespace spindrift {
namespace {

constexpr std::chrono::milliseconds kLongest{1000};
constexpr std::chrono::milliseconds kRest{100};

}  // namespace

VerdictWatch::VerdictWatch(const std::filesystem::path& db, std::vector<std::string> spacecraft,
                           const AlertDesk& desk, Bell& new_answers, OnVerdict on_verdict,
                           ThreadFailures& failures)
    : spacecraft_{std::move(spacecraft)},
      desk_{desk},
      new_answers_{new_answers},
      on_verdict_{std::move(on_verdict)},
      archive_{db},
      thread_{[this, &failures](const std::stop_token& stop) {
        failures.report(contained("reading verdicts", [&] { run(stop); }));
      }} {}

PassVerdict VerdictWatch::of(const std::string& spacecraft) const {
  const std::lock_guard lock{mutex_};
  const auto found = verdicts_.find(spacecraft);
  return found == verdicts_.end() ? PassVerdict{} : found->second;
}

void VerdictWatch::run(const std::stop_token& stop) {
  let_samples_come_first();
  look();
  every(kRest, stop, [&] {
    new_answers_.wait_for(kLongest, stop);
    look();
  });
}

void VerdictWatch::look() {
  std::vector<std::string> run_ids;
  std::transform(spacecraft_.begin(), spacecraft_.end(), std::back_inserter(run_ids),
                 [&](const std::string& spacecraft) { return desk_.run_of(spacecraft); });
  const auto read = [&](SQLite::Database& archive) { return verdicts_in(archive, run_ids); };
  auto verdicts = archive_.read(read);
  if (!verdicts) {
    const std::string& why = verdicts.error().message;
    verdicts = std::vector(run_ids.size(), PassVerdict{.why = why, .against = why});
  }
  for (std::size_t i = 0; i < spacecraft_.size(); ++i) {
    {
      const std::lock_guard lock{mutex_};
      verdicts_.insert_or_assign(spacecraft_[i], verdicts->at(i));
    }
    on_verdict_(spacecraft_[i], run_ids[i], verdicts->at(i));
  }
}

}  // namespace spindrift
