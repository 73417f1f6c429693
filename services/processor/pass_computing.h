/// @file
/// The parts of the computing side that all kinds of spacecraft share.

#pragma once

#include <array>
#include <chrono>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/core/notice.h"
#include "services/archive/records.h"
#include "services/archive/stored_pass.h"
#include "services/processor/action_effects.h"
#include "services/processor/last_answers.h"
#include "services/processor/pass_input.h"
#include "services/processor/what_is_thrown.h"
#include "services/processor/withheld.h"

namespace spindrift {

/// Describes what the archive holds of a run that is continued after a restart.
struct MadeBefore {
  /// Products from this time on may be incomplete in the archive and are stored again.
  TaiTime again_from;
  std::vector<TaiTime> batches;  ///< Times of the stored `batch` solutions, in order.
  Reconstructed reconstructed = {};
};

using AllMadeBefore = std::map<std::string, MadeBefore>;

/// Logs the failure and returns it as a product.
RunFault fault_of(const std::string& spacecraft_id, const std::string& run_id, TaiTime t,
                  std::string what);
/// Reports the notices of a pass in the log (told.h) and returns them as products.
std::vector<RunNotice> told(const std::string& spacecraft_id, const std::vector<Notice>& notices);
RunNotice told(const std::string& spacecraft_id, const SampleContradiction& contradiction);

/// Replaces the numbers of the senders by their names, because the numbers depend on the order in
/// which senders were first heard.
void fill_in_names(SampleContradiction& contradiction, const std::vector<std::string>& names);

struct FellSilent {};

/// Shortest telemetry time between two slow solutions that silences make due: a stream may come in
/// bursts, with a silence after each.
inline constexpr std::chrono::seconds kBetweenSilences{10};

/// Feeds samples into the pass of a run and puts its products into batches for the archive. An
/// exception becomes a RunFault, and nothing more is computed for the run.
/// @tparam Pass Has `push` for the values that it uses, `fall_silent` and `finish`, each returning
/// an output with `products` and `notices`, and `act` for the actions of its kind.
template <class Pass>
class PassComputing {
 public:
  using Output = decltype(std::declval<Pass&>().finish());
  using PassProduct = typename decltype(Output::products)::value_type;

  /// @param stores_residuals Whether residuals of measurements are stored.
  PassComputing(std::string spacecraft_id, std::string run_id, Pass pass,
                bool stores_residuals = true)
      : spacecraft_id_{std::move(spacecraft_id)},
        run_id_{std::move(run_id)},
        pass_{std::move(pass)},
        stores_residuals_{stores_residuals} {}

  /// Prepares for runs that are stored already and whose samples will be fed in again.
  void go_on(AllMadeBefore made) { made_before_ = std::move(made); }

  void begin(const std::string& run_id, Pass pass) {
    run_id_ = run_id;
    pass_ = std::move(pass);
    const MadeBefore* const made = made_before();
    again_from_ = made == nullptr ? std::nullopt : std::optional{made->again_from};
    answers_ = {};
    reached_ = {};
    failed_ = false;
    told_kinds_.clear();
  }

  const std::string& spacecraft_id() const { return spacecraft_id_; }
  const std::string& run_id() const { return run_id_; }
  const Pass& pass() const { return pass_; }
  bool failed() const { return failed_; }
  /// Returns what is stored of the current run, or null when nothing is.
  const MadeBefore* made_before() const {
    const auto made = made_before_.find(run_id_);
    return made == made_before_.end() ? nullptr : &made->second;
  }

  /// Returns a batch with the identity of the run and no content.
  ArchiveBatch batch() const {
    ArchiveBatch batch;
    batch.run_id = run_id_;
    batch.spacecraft_id = spacecraft_id_;
    batch.stores_residuals = stores_residuals_;
    return batch;
  }

  /// @param note Called with every output, and if it accepts them with actions and silences.
  template <class Note>
  std::vector<ArchiveBatch> compute(const PassInput& input, const Note& note) {
    Computed computed;
    for (ArchiveBatch& one : computed) {
      one = batch();
    }
    senders_ = input.senders ? input.senders : senders_;
    // When a sample fails, the products of the samples before it in the same input are kept.
    compute_or_fail(computed.front().products, note, [&] { compute(input, note, computed); });
    std::vector<ArchiveBatch> batches;
    for (ArchiveBatch& batch : computed) {
      if (!batch.products.empty() || batch.continuation) {
        batches.push_back(std::move(batch));
      }
    }
    return batches;
  }

  /// Ends the pass and appends the products that it still held back.
  template <class Note>
  void finish(std::vector<Product>& products, const Note& note) {
    compute_or_fail(products, note, [&] {
      Output output = pass_.finish();
      std::vector<RunNotice> notices = notices_of(output, note);
      append(std::move(output), products);
      std::move(notices.begin(), notices.end(), std::back_inserter(products));
    });
  }

 private:
  /// The batch of results, then one per kind of detail, which may be stored later (detail_lane.h).
  using Computed = std::array<ArchiveBatch, 1 + std::variant_size_v<Product>>;

  template <class Note>
  void compute(const PassInput& input, const Note& note, Computed& computed) {
    in_order_of_arrival(
        input.values, input.silences, input.actions,
        [&](const auto& placed) { process(placed, note, computed); },
        [&](BatchPlace /*place*/) {
          Output output = pass_.fall_silent();
          std::vector<RunNotice> notices = notices_of(output, note);
          keep(std::move(output), std::move(notices), std::nullopt, computed);
          if constexpr (requires { note(FellSilent{}); }) {
            note(FellSilent{});
          }
        });
  }

  template <class Value, class Note>
  void process(const Placed<Value>& placed, const Note& note, Computed& computed) {
    // A pass ignores the kinds of telemetry that it has no `push` for.
    if constexpr (requires { pass_.push(placed.value); }) {
      reached_ = placed.value.t;
      Output output = pass_.push(placed.value);
      std::vector<RunNotice> notices = notices_of(output, note);
      keep(std::move(output), std::move(notices), placed.value.t, computed);
    }
  }

  /// An action gives no products itself, but for notices of its effect; else it affects the samples
  /// after it.
  template <class Note>
  void process(const Placed<OperatorAction>& placed, const Note& note, Computed& computed) {
    const OperatorAction& action = placed.value;
    const bool was_left_out = names_what_is_left_out(action);
    std::visit(
        [&](const auto& does) {
          if constexpr (requires { pass_.act(action.t.value(), does); }) {
            pass_.act(action.t.value(), does);
          }
        },
        action.does);
    keep({}, told(spacecraft_id_, effects_of(action, was_left_out)), std::nullopt, computed);
    if constexpr (requires { note(action); }) {
      keep({}, told(spacecraft_id_, note(action)), std::nullopt, computed);
    }
  }

  bool names_what_is_left_out(const OperatorAction& action) const {
    const auto is_left_out = [&](const auto& what) {
      if constexpr (requires { pass_.leaves_out(*action.t, what.channel); }) {
        return pass_.leaves_out(action.t.value(), what.channel);
      } else {
        return false;
      }
    };
    return std::visit(
        [&](const auto& does) {
          if constexpr (requires { std::visit(is_left_out, does); }) {
            return std::visit(is_left_out, does);
          } else {
            return false;
          }
        },
        action.does);
  }

  template <class Note>
  std::vector<RunNotice> notices_of(Output& output, const Note& note) {
    withheld_.take_from(output, answers_);
    std::vector<RunNotice> notices;
    for (PassProduct& product : output.products) {
      if (auto* const contradiction = std::get_if<SampleContradiction>(&product)) {
        name_senders(*contradiction, notices);
      }
    }
    std::vector<RunNotice> of_pass = told(spacecraft_id_, output.notices);
    std::move(of_pass.begin(), of_pass.end(), std::back_inserter(notices));
    note(std::as_const(output));
    return notices;
  }

  /// Names the senders and reports the first contradiction of each kind of sample.
  void name_senders(SampleContradiction& contradiction, std::vector<RunNotice>& notices) {
    fill_in_names(contradiction, senders_ ? *senders_ : std::vector<std::string>{});
    if (told_kinds_.insert(contradiction.kind).second) {
      notices.push_back(told(spacecraft_id_, contradiction));
    }
  }

  /// @param t Time of the sample that gave the output; empty when a silence did.
  void keep(Output output, std::vector<RunNotice> notices, std::optional<TaiTime> t,
            Computed& computed) {
    if (again_from_ && t && *t >= *again_from_) {
      computed.front().continuation = Continuation{.t = *std::exchange(again_from_, {})};
    }
    if (again_from_) {
      return;
    }
    for (auto& made : output.products) {
      Product product = product_of(std::move(made));
      const std::size_t place = is_detail(product) ? 1 + product.index() : 0;
      computed.at(place).products.push_back(std::move(product));
    }
    std::move(notices.begin(), notices.end(), std::back_inserter(computed.front().products));
  }

  static void append(Output output, std::vector<Product>& products) {
    for (PassProduct& product : output.products) {
      products.push_back(product_of(std::move(product)));
    }
  }

  template <class Note, class Compute>
  void compute_or_fail(std::vector<Product>& products, const Note& note, const Compute& compute) {
    if (failed_) {
      return;
    }
    if (auto what = what_is_thrown(compute)) {
      failed_ = true;
      Output doubted{.products = answers_.doubtful_from(
                         reached_, {ReasonCode::ComputingFailed, {{"what", *what}}}),
                     .notices = {}};
      note(std::as_const(doubted));
      append(std::move(doubted), products);
      products.emplace_back(fault_of(spacecraft_id_, run_id_, reached_, *std::move(what)));
    }
  }

  std::string spacecraft_id_;
  std::string run_id_;
  Pass pass_;
  bool stores_residuals_;
  AllMadeBefore made_before_;
  std::optional<TaiTime> again_from_;  ///< Nothing is stored before the pass reaches this.
  TaiTime reached_ = {};               ///< Time of the sample computed last.
  bool failed_ = false;
  NamesOfSenders senders_;
  std::set<std::string_view> told_kinds_;  ///< Kinds with a contradiction that was reported.
  Withheld withheld_;
  LastAnswers<PassProduct> answers_;
};

}  // namespace spindrift
