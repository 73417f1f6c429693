/// Each fault of a table raises an alert in time, which names the culprit, does not come again and
/// again and is cleared behind the fault's end. The table is printed.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/property/alerts/fault.h"
#include "tests/property/alerts/service_faults.h"
#include "tests/property/alerts/spin_faults.h"
#include "tests/property/alerts/three_axis_faults.h"

namespace spindrift::testing::found_faults_test {

constexpr std::size_t kMostOccurrences = 3;
// The end of the telemetry is no fault.
constexpr int kBeforeSilence_s = 3;

RaisedByKey served(const Fault& fault, const Flight& flight) {
  SupervisedPass supervised{flight.mission, RunMode::Live};
  if (fault.service) {
    supervised.on_state = [&](ServiceState& state, double t_s) {
      fault.service(state, t_s, fault.window);
    };
  }
  return supervised.serve(flight.sent, kBeforeSilence_s);
}

void expect_found(const Fault& fault) {
  SCOPED_TRACE(fault.name);
  const Flight flight = spoilt(fault);
  const TaiTime start = flight.sent.front().came;
  const TaiTime from = shifted(start, fault.window.from_s);
  const RaisedByKey raised = served(fault, flight);
  const Raised* found = nullptr;
  std::string key = "not found";
  std::string others;
  for (const auto& [is, alert] : raised) {
    const double after_s = seconds_between(from, alert.t);
    EXPECT_LE(alert.ids.size(), kMostOccurrences) << is;
    if (fault.keys.contains(is) && after_s >= 0.0 && (found == nullptr || alert.t < found->t)) {
      found = &alert;
      key = is;
    }
    others += fmt::format(" {} {:.1f} s{}{};", is, after_s,
                          alert.begun > 1 ? fmt::format(" x{}", alert.begun) : "",
                          alert.cleared ? "" : " open");
    const bool is_named =
        is.starts_with("sensor.contradicts:") && is != "sensor.contradicts:unknown";
    EXPECT_TRUE(!is_named || fault.keys.contains(is) || is == fault.culprit)
        << "a sensor that is right: " << is;
  }
  EXPECT_NE(found, nullptr) << others;
  if (found == nullptr) {
    fmt::print("| {} | NOT FOUND | | | |{}\n", fault.name, others);
    return;
  }
  const double delay_s = seconds_between(from, found->t);
  const double last_s = seconds_between(start, flight.sent.back().came);
  const bool is_over = fault.ends && fault.window.until_s < last_s;
  const TaiTime until = shifted(start, fault.window.until_s);
  EXPECT_LE(delay_s, fault.within_s);
  EXPECT_TRUE(!is_over || found->cleared) << key << " is open";
  fmt::print("| {} | {} | {:.1f} | {} | {}/{} |{}\n", fault.name, key, delay_s,
             !is_over         ? "does not end"
             : found->cleared ? fmt::format("{:.1f}", seconds_between(until, *found->cleared))
                              : "NOT CLEARED",
             found->ids.size(), found->begun, others);
}

void expect_found(const std::vector<Fault>& faults) {
  fmt::print(
      "| fault | alert | delay, s | cleared behind its end, s | occurrences | all alerts |\n");
  for (const Fault& fault : faults) {
    expect_found(fault);
  }
}

TEST(FoundFaults, OfAThreeAxisSpacecraft) { expect_found(three_axis_faults()); }

TEST(FoundFaults, OfAThreeAxisSpacecraftFromTheStart) { expect_found(early_three_axis_faults()); }

TEST(FoundFaults, OfASpinner) { expect_found(spin_faults()); }

TEST(FoundFaults, OfASpinnersSensorThatLies) { expect_found(lies_of_a_spinner()); }

TEST(FoundFaults, OfLinkAndService) { expect_found(service_faults()); }

TEST(FoundFaults, OfEveryAlert) {
  std::set<std::string_view> found;
  std::size_t faults = 0;
  for (const auto& table :
       {three_axis_faults(), spin_faults(), lies_of_a_spinner(), service_faults()}) {
    faults += table.size();
    for (const Fault& fault : table) {
      for (const std::string& key : fault.keys) {
        found.insert(name_of(code_of(key).value()));
      }
    }
  }
  EXPECT_GE(faults, 40U);
  for (int code = 0; code < kAlertCodes; ++code) {
    EXPECT_TRUE(found.contains(name_of(static_cast<AlertCode>(code))))
        << name_of(static_cast<AlertCode>(code));
  }
}

}  // namespace spindrift::testing::found_faults_test
