/// @file
/// The kinds of products.
///
/// A new kind needs its traits file, its line here and its table in schemas/; if it has a topic,
/// also its `to_idl` in services/publisher. What is missing does not compile.

#pragma once

#include <cstddef>
#include <utility>
#include <variant>

#include "services/products/advisory.h"
#include "services/products/alert.h"
#include "services/products/attitude.h"
#include "services/products/batch_solution.h"
#include "services/products/gate_transition.h"
#include "services/products/model_comparison.h"
#include "services/products/normal_equations.h"
#include "services/products/product_kind.h"
#include "services/products/pulse_use.h"
#include "services/products/reconstruction.h"
#include "services/products/rejected_sample.h"
#include "services/products/revolution.h"
#include "services/products/run_fault.h"
#include "services/products/run_notice.h"
#include "services/products/sample_contradiction.h"
#include "services/products/sample_residual.h"
#include "services/products/sensors_compared.h"
#include "services/products/spin_answer.h"
#include "services/products/spin_estimate.h"
#include "services/products/spin_fix.h"
#include "services/products/spin_measurement.h"

namespace spindrift {

using Product = std::variant<PulseUse, RevolutionProduct, SpinMeasurement, SpinFix, SpinEstimate,
                             BatchProduct, RunFault, RejectedSample, AttitudeEstimate,
                             SampleObservation, ReconstructionProduct, ChannelComparison,
                             SampleContradiction, Alert, RunNotice, AxisChoice, NormalEquations,
                             SpinAnswer, SensorsCompared, GateTransition, Advisory>;

/// Index of a kind in Product.
template <class Kind>
inline const std::size_t kProductKind = Product{Kind{}}.index();

/// Calls `see.template operator()<Kind>()` for each kind, in order.
template <class See>
constexpr void for_each_product_kind(const See& see) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (see.template operator()<std::variant_alternative_t<I, Product>>(), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Product>>{});
}

/// Converts a product of one pipeline to Product.
template <class... Kinds>
Product product_of(std::variant<Kinds...> product) {
  return std::visit([](auto& value) { return Product{std::move(value)}; }, product);
}

inline bool is_detail(const Product& product) {
  return std::visit(
      []<class Kind>(const Kind& /*value*/) {
        return ProductKind<Kind>::kWeight == ProductWeight::Detail;
      },
      product);
}

}  // namespace spindrift
