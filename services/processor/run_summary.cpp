#include "services/processor/run_summary.h"

#include <variant>

namespace spindrift {
namespace {

struct Count {
  RunSummary& summary;

  void operator()(const PulseUse& use) const {
    if (use.rejected_by) {
      ++summary.edges_rejected[name_of(*use.rejected_by)];
    } else {
      ++summary.edges_accepted;
    }
  }
  void operator()(const RevolutionProduct& /*revolution*/) const { ++summary.revolutions; }
  void operator()(const SpinMeasurement& /*measurement*/) const {}
  void operator()(const SpinFix& fix) const {
    ++summary.fixes;
    summary.fixes_accepted += fix.accepted ? 1 : 0;
  }
  void operator()(const SpinEstimate& estimate) const { summary.mean = estimate; }
};

}  // namespace

void RunSummary::count(const SpinProduct& product) { std::visit(Count{*this}, product); }

}  // namespace spindrift
