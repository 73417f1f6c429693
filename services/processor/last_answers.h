/// @file
/// The last answer of each estimator, valid for those who follow a run until the next one.

#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <type_traits>
#include <variant>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Keeps the last answers. When no next answer can be had, the last one must not stay valid as it
/// is: it is given once more, as DOUBTFUL.
/// @tparam PassProduct Variant of the products of a pass. Answers are those with an assessment.
template <class PassProduct>
class LastAnswers {
 public:
  void remember(const PassProduct& product) {
    if (!is_answer(product)) {
      return;
    }
    for (PassProduct& last : last_) {
      if (are_of_one_estimator(last, product)) {
        last = product;
        return;
      }
    }
    last_.push_back(product);
  }

  /// Returns the answer before `product`, DOUBTFUL and at the time of `product`; empty when
  /// `product` is no answer or the first one.
  std::optional<PassProduct> instead_of(const PassProduct& product, const Reason& reason) const {
    const auto before = std::find_if(last_.begin(), last_.end(), [&](const PassProduct& last) {
      return are_of_one_estimator(last, product);
    });
    return before == last_.end() ? std::nullopt
                                 : std::optional{doubtful(*before, time_of(product), reason)};
  }

  /// Returns all last answers as DOUBTFUL, each at `t` or 1 ns after its own time if that is later.
  std::vector<PassProduct> doubtful_from(TaiTime t, const Reason& reason) const {
    std::vector<PassProduct> all;
    for (const PassProduct& last : last_) {
      all.push_back(
          doubtful(last, std::max(t, time_of(last) + std::chrono::nanoseconds{1}), reason));
    }
    return all;
  }

 private:
  template <class Value>
  static constexpr bool kIsAnswer = requires(Value value) {
    value.assessment;
  };

  static bool is_answer(const PassProduct& product) {
    return std::visit(
        [](const auto& value) { return kIsAnswer<std::remove_cvref_t<decltype(value)>>; }, product);
  }

  static bool are_of_one_estimator(const PassProduct& one, const PassProduct& other) {
    return one.index() == other.index() &&
           std::visit(
               [&]<class Value>(const Value& value) {
                 if constexpr (requires { value.estimator; }) {
                   return value.estimator == std::get<Value>(other).estimator;
                 }
                 return true;
               },
               one);
  }

  static TaiTime time_of(const PassProduct& answer) {
    return std::visit(
        []<class Value>(const Value& value) {
          if constexpr (kIsAnswer<Value>) {
            return value.t;
          }
          return TaiTime{};
        },
        answer);
  }

  static PassProduct doubtful(PassProduct answer, TaiTime t, const Reason& reason) {
    std::visit(
        [&]<class Value>(Value& value) {
          if constexpr (kIsAnswer<Value>) {
            value.t = t;
            value.assessment.quality = std::max(value.assessment.quality, Quality::Doubtful);
            value.assessment.reasons.push_back(reason);
          }
        },
        answer);
    return answer;
  }

  std::vector<PassProduct> last_;
};

}  // namespace spindrift
