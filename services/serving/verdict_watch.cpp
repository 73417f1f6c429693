#include "services/serving/verdict_watch.h"

#include <chrono>
#include <utility>

#include "services/archive/verdict.h"
#include "services/clock/every.h"
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
  every(kBetweenVerdicts, stop, [&] { look(stop); });
}

void VerdictWatch::look(const std::stop_token& stop) {
  for (const std::string& spacecraft : spacecraft_) {
    if (stop.stop_requested()) {
      return;
    }
    const std::string run_id = desk_.run_of(spacecraft);
    const auto read = [&](SQLite::Database& archive) { return verdict_in(archive, run_id); };
    const PassVerdict verdict =
        archive_.read(read)
            .or_else([](const Error& error) -> Expected<PassVerdict> {
              return PassVerdict{.why = error.message, .against = error.message};
            })
            .value();
    {
      const std::lock_guard lock{mutex_};
      verdicts_.insert_or_assign(spacecraft, verdict);
    }
    on_verdict_(spacecraft, run_id, verdict);
  }
}

}  // namespace spindrift
