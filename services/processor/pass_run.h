/// @file
/// The computing side of one spacecraft's run: samples in, products for the archive out.

#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pipelines/spin/spin_pass.h"
#include "services/archive/records.h"
#include "services/archive/stored_pass.h"
#include "services/mission/mission.h"
#include "services/processor/run_summary.h"

namespace spindrift {

/// What a pass is to work on next, in order of arrival: the pulses, then the frames.
struct PassInput {
  std::size_t spacecraft = 0;  ///< Index of its mission.
  std::string run_id;          ///< Another one than before: a new pass begins.
  std::vector<Pulse> pulses = {};
  std::vector<CodedFrame> frames = {};
};

/// Takes a batch over. @return an error when no more is wanted.
using Submit = std::function<Expected<void>(ArchiveBatch)>;

class PassRun {
 public:
  /// @param mission Of a spinner.
  PassRun(const Mission& mission, const std::string& run_id);

  /// Works itself through `inputs`, the samples of `stored`, to where its run stood. Stores again
  /// what was made from `again_from` on, which the run may not have got to, and the latest results,
  /// so that they are announced again.
  Expected<void> go_on(const StoredPass& stored, std::span<const PassInput> inputs,
                       TaiTime again_from, const Submit& submit);

  std::vector<ArchiveBatch> compute(const PassInput& input);

  /// The pass has ended: what was still held, and the end of the run.
  ArchiveBatch finish();

  /// Of all runs so far, but for what was received, which this side does not see.
  std::vector<RunSummary> summaries() const;

 private:
  void begin(const std::string& run_id);
  ArchiveBatch batch() const;
  /// @param products Where they go; none: they are counted only.
  void keep(SpinOutput output, std::vector<SpinProduct>* products);

  std::string spacecraft_id_;
  SpinConfig config_;
  Orbit orbit_;
  std::vector<RunSummary> finished_;
  RunSummary summary_;
  SpinPass pass_;
};

}  // namespace spindrift
