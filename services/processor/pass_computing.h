/// @file
/// What the computing sides of all kinds of spacecraft have in common.

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
#include "services/processor/last_answers.h"
#include "services/processor/pass_input.h"
#include "services/processor/what_is_thrown.h"
#include "services/processor/withheld.h"

namespace spindrift {

/// What is stored of a run that goes on.
struct MadeBefore {
  /// What was made from then on, which the run may not have got to, is stored again.
  TaiTime again_from;
  std::vector<TaiTime> batches;  ///< When solutions of `batch` are; in order.
  Reconstructed reconstructed = {};
};

/// Of the runs that go on, by run.
using AllMadeBefore = std::map<std::string, MadeBefore>;

/// Says it in the log.
RunFault fault_of(const std::string& spacecraft_id, const std::string& run_id, TaiTime t,
                  std::string what);
/// The notices of a pass, as told.h tells them.
std::vector<RunNotice> told(const std::string& spacecraft_id, const std::vector<Notice>& notices);
RunNotice told(const std::string& spacecraft_id, const SampleContradiction& contradiction);

/// Of its senders; by name from now on, for the numbers hang on who was heard first.
void fill_in_names(SampleContradiction& contradiction, const std::vector<std::string>& names);

/// The stream has fallen silent.
struct FellSilent {};

/// Of telemetry, between the slow solutions that are due in silences: a stream may come in bursts.
inline constexpr std::chrono::seconds kBetweenSilences{10};

/// Samples into the pass of a run, what it makes of them into batches for the archive. What throws
/// meanwhile becomes a RunFault, and nothing more is computed of the run.
/// @tparam Pass Has `push` for the values that it knows, `fall_silent` and `finish`, each with an
///              output of `products` and `notices`, and `act` for the actions of its kind.
template <class Pass>
class PassComputing {
 public:
  using Output = decltype(std::declval<Pass&>().finish());
  using PassProduct = typename decltype(Output::products)::value_type;

  /// @param stores_residuals What measurements say to the estimators is stored.
  PassComputing(std::string spacecraft_id, std::string run_id, Pass pass,
                bool stores_residuals = true)
      : spacecraft_id_{std::move(spacecraft_id)},
        run_id_{std::move(run_id)},
        pass_{std::move(pass)},
        stores_residuals_{stores_residuals} {}

  /// The runs of `made` are stored, and their samples come again.
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
  /// Of this run; null: nothing.
  const MadeBefore* made_before() const {
    const auto made = made_before_.find(run_id_);
    return made == made_before_.end() ? nullptr : &made->second;
  }

  /// Empty, for the archive.
  ArchiveBatch batch() const {
    ArchiveBatch batch;
    batch.run_id = run_id_;
    batch.spacecraft_id = spacecraft_id_;
    batch.stores_residuals = stores_residuals_;
    return batch;
  }

  /// @param note Is shown every output, stored or not; every action and silence, if it takes them.
  template <class Note>
  std::vector<ArchiveBatch> compute(const PassInput& input, const Note& note) {
    Computed computed;
    for (ArchiveBatch& one : computed) {
      one = batch();
    }
    senders_ = input.senders ? input.senders : senders_;
    // What was made of the samples before one that fails is kept, however many came with it.
    compute_or_fail(computed.front().products, note, [&] { compute(input, note, computed); });
    std::vector<ArchiveBatch> batches;
    for (ArchiveBatch& batch : computed) {
      if (!batch.products.empty() || batch.continuation) {
        batches.push_back(std::move(batch));
      }
    }
    return batches;
  }

  /// What was still held: the pass has ended.
  template <class Note>
  void finish(std::vector<Product>& products, const Note& note) {
    compute_or_fail(products, note, [&] {
      Output output = pass_.finish();
      std::vector<RunNotice> notices = see(output, note);
      append(std::move(output), products);
      std::move(notices.begin(), notices.end(), std::back_inserter(products));
    });
  }

 private:
  /// First the results, then what may be stored later (detail_lane.h), each kind by itself.
  using Computed = std::array<ArchiveBatch, 1 + std::variant_size_v<Product>>;

  template <class Note>
  void compute(const PassInput& input, const Note& note, Computed& computed) {
    in_order_of_arrival(
        input.values, input.silences, input.actions,
        [&](const auto& arrived) { take(arrived, note, computed); },
        [&](std::int64_t /*place*/) {
          Output output = pass_.fall_silent();
          std::vector<RunNotice> notices = see(output, note);
          keep(std::move(output), std::move(notices), std::nullopt, computed);
          if constexpr (requires { note(FellSilent{}); }) {
            note(FellSilent{});
          }
        });
  }

  template <class Value, class Note>
  void take(const Arrived<Value>& arrived, const Note& note, Computed& computed) {
    // Of the other kinds of telemetry it knows nothing.
    if constexpr (requires { pass_.push(arrived.value); }) {
      reached_ = arrived.value.t;
      Output output = pass_.push(arrived.value);
      std::vector<RunNotice> notices = see(output, note);
      keep(std::move(output), std::move(notices), arrived.value.t, computed);
    }
  }

  /// It makes something of samples to come only.
  template <class Note>
  void take(const OperatorAction& action, const Note& note, Computed& /*computed*/) {
    std::visit(
        [&](const auto& does) {
          if constexpr (requires { pass_.act(action.t.value(), does); }) {
            pass_.act(action.t.value(), does);
          }
        },
        action.does);
    if constexpr (requires { note(action); }) {
      note(action);
    }
  }

  template <class Note>
  std::vector<RunNotice> see(Output& output, const Note& note) {
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

  /// Of each kind the first is said.
  void name_senders(SampleContradiction& contradiction, std::vector<RunNotice>& notices) {
    fill_in_names(contradiction, senders_ ? *senders_ : std::vector<std::string>{});
    if (told_kinds_.insert(contradiction.kind).second) {
      notices.push_back(told(spacecraft_id_, contradiction));
    }
  }

  /// @param t Of the sample that made it; none: a silence did.
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
  std::optional<TaiTime> again_from_;  ///< Until the pass is there again: what it makes is stored.
  TaiTime reached_ = {};               ///< The sample that was computed last.
  bool failed_ = false;
  NamesOfSenders senders_;
  std::set<std::string_view> told_kinds_;  ///< Whose samples contradict each other.
  Withheld withheld_;
  LastAnswers<PassProduct> answers_;
};

}  // namespace spindrift
