#include "services/serving/verdict_watch.h"

#include <chrono>
#include <condition_variable>
#include <utility>

#include "services/archive/verdict.h"
#include "services/queue/contained.h"
#include "services/serving/background_solving.h"

namespace spindrift {
namespace {

constexpr std::chrono::seconds kBetweenVerdicts{1};

}  // namespace

VerdictWatch::VerdictWatch(const std::filesystem::path& db, std::vector<std::string> spacecraft,
                           const AlertDesk& desk, OnVerdict on_verdict, ThreadFailures& failures)
    : spacecraft_{std::move(spacecraft)},
      desk_{desk},
      on_verdict_{std::move(on_verdict)},
      archive_{db},
      thread_{[this, &failures](const std::stop_token& stop) {
        failures.note(contained("reading verdicts", [&] { run(stop); }));
      }} {}

PassVerdict VerdictWatch::of(const std::string& spacecraft) const {
  const std::lock_guard lock{mutex_};
  const auto found = verdicts_.find(spacecraft);
  return found == verdicts_.end() ? PassVerdict{} : found->second;
}

void VerdictWatch::run(const std::stop_token& stop) {
  let_samples_come_first();
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock{mutex};
  while (!stop.stop_requested()) {
    look();
    stopped.wait_for(lock, stop, kBetweenVerdicts, [] { return false; });
  }
}

void VerdictWatch::look() {
  for (const std::string& spacecraft : spacecraft_) {
    const std::string run_id = desk_.run_of(spacecraft);
    const auto read = [&](SQLite::Database& archive) { return verdict_in(archive, run_id); };
    const PassVerdict verdict = archive_.read(read).value_or(PassVerdict{});
    {
      const std::lock_guard lock{mutex_};
      verdicts_.insert_or_assign(spacecraft, verdict);
    }
    on_verdict_(spacecraft, run_id, verdict);
  }
}

}  // namespace spindrift
