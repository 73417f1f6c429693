#include "services/mission/toml_scalar.h"

namespace spindrift {

std::optional<Scalar> scalar_from(const toml::node& node) {
  if (const auto* const flag = node.as_boolean()) {
    return Scalar{flag->get()};
  }
  if (const auto* const integer = node.as_integer()) {
    return Scalar{integer->get()};
  }
  if (const auto* const number = node.as_floating_point()) {
    return Scalar{number->get()};
  }
  if (const auto* const text = node.as_string()) {
    return Scalar{text->get()};
  }
  return std::nullopt;
}

}  // namespace spindrift
