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
    if (use.said) {
      summary.ledger.add({&*use.said, 1});
    }
  }
  void operator()(const RevolutionProduct& /*revolution*/) const { ++summary.revolutions; }
  void operator()(const SpinMeasurement& measurement) const {
    if (measurement.said) {
      summary.ledger.add({&*measurement.said, 1});
    }
  }
  void operator()(const SampleContradiction& /*contradiction*/) const {}
  void operator()(const AxisChoice& /*choice*/) const {}
  void operator()(const SensorsCompared& /*sensors*/) const {}
  void operator()(const SpinFix& fix) const {
    forget_ambiguous(fix.revolution);
    if (fix.resolution == Resolution::Ambiguous) {
      summary.ambiguous.emplace(fix.revolution, fix.geometry_case);
    }
    ++summary.fixes;
    summary.fixes_accepted += fix.accepted ? 1 : 0;
    ++summary.fixes_by_case[fix.geometry_case];
    ++summary.fixes_by_resolution[name_of(said_resolution(fix))];
  }
  void operator()(const SpinEstimate& estimate) const {
    summary.estimates.insert_or_assign(estimate.estimator, estimate);
  }

  void forget_ambiguous(std::int64_t revolution) const {
    const auto before = summary.ambiguous.find(revolution);
    if (before != summary.ambiguous.end()) {
      --summary.fixes;
      take_one(summary.fixes_by_case, before->second);
      take_one(summary.fixes_by_resolution, name_of(Resolution::Ambiguous));
      summary.ambiguous.erase(before);
    }
  }

  template <class Key>
  static void take_one(std::map<Key, std::int64_t>& counts, const Key& key) {
    if (--counts.at(key) == 0) {
      counts.erase(key);
    }
  }
};

}  // namespace

void RunSummary::count(const SpinProduct& product) { std::visit(Count{*this}, product); }

void RunSummary::count(const ThreeAxisProduct& product) {
  if (const auto* const rejected = std::get_if<RejectedSample>(&product)) {
    ++samples_rejected.at(index_of(rejected->kind))[name_of(rejected->rejected_by)];
  } else if (const auto* const estimate = std::get_if<AttitudeEstimate>(&product)) {
    attitude = *estimate;
  } else if (const auto* const sample = std::get_if<SampleObservation>(&product)) {
    ledger.add({&sample->said, 1});
  } else if (const auto* const advised = std::get_if<Advisory>(&product)) {
    advisory = *advised;
  } else if (const auto* const gate = std::get_if<GateTransition>(&product);
             gate != nullptr && gate->gate == Gate::Lost && !gate->open) {
    advisory.reset();
  }
}

void RunSummary::count_solution(const std::vector<Product>& products) {
  for (const Product& product : products) {
    if (const auto* const solution = std::get_if<BatchProduct>(&product)) {
      count((*solution)->estimate);
      batch = **solution;
    } else if (const auto* const reconstruction = std::get_if<ReconstructionProduct>(&product)) {
      reconstructions.push_back(*reconstruction);
    }
  }
}

}  // namespace spindrift
