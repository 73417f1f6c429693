#include "services/mission/key_check.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string_view>
#include <vector>

#include "pipelines/core/shown.h"
#include "pipelines/frames/inertia.h"
#include "pipelines/time/utc.h"
#include "services/mission/toml_scalar.h"
#include "services/telemetry/spacecraft_id.h"

namespace spindrift {
namespace {

constexpr double kTypedUnitTolerance = 1e-4;  // A typed 0.7071 is rounded by less.

std::string range_of(const KeyRule& rule) {
  return fmt::format("{}{}, {}{}{}{}", rule.lower->inclusive ? '[' : '(',
                     text_of(rule.lower->value), text_of(rule.upper->value),
                     rule.upper->inclusive ? ']' : ')', rule.unit.empty() ? "" : " ", rule.unit);
}

/// Returns false for NaN, which is on no side of a bound.
bool in_range(const KeyRule& rule, const Scalar& value) {
  if (!rule.lower) {
    return true;
  }
  const auto& [lower, with_lower] = *rule.lower;
  const auto& [upper, with_upper] = *rule.upper;
  return (with_lower ? at_most(lower, value) : below(lower, value)) &&
         (with_upper ? at_most(value, upper) : below(value, upper));
}

bool is_allowed_text(const KeyRule& rule, const std::string& text) {
  if (rule.form == ValueForm::SpacecraftId) {
    return is_spacecraft_id(text);
  }
  if (rule.form == ValueForm::Utc) {
    return text.ends_with('Z') && parse_utc(text).has_value();
  }
  return rule.one_of.empty() ||
         std::find(rule.one_of.begin(), rule.one_of.end(), text) != rule.one_of.end();
}

/// Returns the value, without regard to a shape; empty if it breaks the rule.
std::optional<Scalar> single(const KeyRule& rule, const toml::node& node) {
  auto value = typed(rule.type, node);
  const auto* const text = value ? std::get_if<std::string>(&*value) : nullptr;
  const bool good =
      value && (text != nullptr ? is_allowed_text(rule, *text) : in_range(rule, *value));
  return good ? std::move(value) : std::nullopt;
}

/// Returns the elements row by row if the shape fits and all are valid; empty otherwise.
/// @param any What a size of 0 in the shape stands for.
std::vector<Scalar> elements(const KeyRule& rule, const toml::node& node, std::size_t any,
                             std::size_t depth) {
  if (depth == rule.shape.size()) {
    const auto value = single(rule, node);
    return value ? std::vector{*value} : std::vector<Scalar>{};
  }
  const toml::array* const array = node.as_array();
  const std::size_t size = rule.shape[depth] == 0 ? any : rule.shape[depth];
  if (array == nullptr || array->size() != size) {
    return {};
  }
  std::vector<Scalar> all;
  for (const toml::node& element : *array) {
    const auto inner = elements(rule, element, any, depth + 1);
    if (inner.empty()) {
      return {};
    }
    all.insert(all.end(), inner.begin(), inner.end());
  }
  return all;
}

/// Returns the elements of a whole array.
std::vector<Scalar> elements(const KeyRule& rule, const toml::node& node) {
  const toml::array* const array = node.as_array();
  return array == nullptr ? std::vector<Scalar>{} : elements(rule, node, array->size(), 0);
}

std::vector<double> as_numbers(const std::vector<Scalar>& values) {
  std::vector<double> numbers(values.size());
  std::ranges::transform(values, numbers.begin(), as_number);
  return numbers;
}

std::vector<std::string> as_texts(const std::vector<Scalar>& values) {
  std::vector<std::string> texts(values.size());
  std::ranges::transform(values, texts.begin(),
                         [](const Scalar& value) { return std::get<std::string>(value); });
  return texts;
}

bool is_unit_quaternion(const std::vector<double>& q) {
  return std::abs(std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3])) - 1.0) <=
         kTypedUnitTolerance;
}

std::string form_text(const KeyRule& rule) {
  if (!rule.form) {
    return "";
  }
  switch (*rule.form) {
    case ValueForm::Utc:
      return ", UTC as 2026-11-20T03:00:00Z";
    case ValueForm::SpacecraftId:
      return fmt::format(", {}", kSpacecraftIdAllowed);
    case ValueForm::UnitQuaternion:
      return ", a quaternion of unit length";
    case ValueForm::Inertia:
      return ", symmetric, with positive principal moments, none above the sum of the others";
  }
  return "";
}

std::optional<std::string> array_objection(const KeyRule& rule, const toml::node& value) {
  const auto all = elements(rule, value);
  const bool good =
      !all.empty() &&
      (rule.form != ValueForm::UnitQuaternion || is_unit_quaternion(as_numbers(all))) &&
      (rule.form != ValueForm::Inertia ||
       is_inertia(Eigen::Map<const Eigen::Matrix3d>{as_numbers(all).data()}));
  return good ? std::nullopt : std::optional{"must be " + allowed_by(rule)};
}

}  // namespace

double as_number(const Scalar& value) {
  const auto* const integer = std::get_if<std::int64_t>(&value);
  return integer != nullptr ? static_cast<double>(*integer) : std::get<double>(value);
}

std::string text_of(const Scalar& number) {
  const auto* const integer = std::get_if<std::int64_t>(&number);
  return integer != nullptr ? fmt::format("{}", *integer)
                            : fmt::format("{}", std::get<double>(number));
}

bool at_most(const Scalar& a, const Scalar& b) {
  const auto* const a_integer = std::get_if<std::int64_t>(&a);
  const auto* const b_integer = std::get_if<std::int64_t>(&b);
  return a_integer != nullptr && b_integer != nullptr ? *a_integer <= *b_integer
                                                      : as_number(a) <= as_number(b);
}

bool below(const Scalar& a, const Scalar& b) { return at_most(a, b) && !at_most(b, a); }

std::optional<Scalar> typed(ValueType type, const toml::node& value) {
  const auto scalar = scalar_from(value);
  if (!scalar) {
    return std::nullopt;
  }
  switch (type) {
    case ValueType::Text:
      return value.is_string() ? scalar : std::nullopt;
    case ValueType::Boolean:
      return value.is_boolean() ? scalar : std::nullopt;
    case ValueType::Integer:
      return value.is_integer() ? scalar : std::nullopt;
    case ValueType::Number:
      return value.is_number() ? std::optional{Scalar{as_number(*scalar)}} : std::nullopt;
  }
  return std::nullopt;
}

Scalar value_by(const KeyRule& rule, const toml::node& value) {
  if (rule.shape.empty()) {
    return *typed(rule.type, value);
  }
  const auto all = elements(rule, value);
  return rule.type == ValueType::Text ? Scalar{as_texts(all)} : Scalar{as_numbers(all)};
}

std::string allowed_by(const KeyRule& rule) {
  if (!rule.one_of.empty()) {
    return fmt::format("one of \"{}\"", fmt::join(rule.one_of, "\", \""));
  }
  static constexpr std::array<std::string_view, 4> kOne = {"text", "true or false", "an integer",
                                                           "a number"};
  static constexpr std::array<std::string_view, 4> kMany = {"texts", "booleans", "integers",
                                                            "numbers"};
  const auto type = static_cast<std::size_t>(rule.type);
  const std::string range = rule.lower ? " in " + range_of(rule) : "";
  if (rule.shape.empty()) {
    return fmt::format("{}{}{}", kOne.at(type), range, form_text(rule));
  }
  std::vector<std::string> sizes;
  for (const std::size_t size : rule.shape) {
    sizes.push_back(size == 0 ? "n" : fmt::format("{}", size));
  }
  return fmt::format("an array of {} {}{}{}", fmt::join(sizes, " x "), kMany.at(type), range,
                     form_text(rule));
}

std::string shown(const toml::node& value) {
  if (value.is_table()) {
    return "a table";
  }
  std::ostringstream out;
  value.visit([&](const auto& node) { out << node; });
  std::string text = out.str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return shown(text);
}

std::optional<std::string> objection(const KeyRule& rule, const toml::node& value) {
  if (!rule.shape.empty()) {
    return array_objection(rule, value);
  }
  if (single(rule, value)) {
    return std::nullopt;
  }
  const bool out_of_range = rule.lower && typed(rule.type, value);
  return out_of_range ? "must lie in " + range_of(rule) : "must be " + allowed_by(rule);
}

}  // namespace spindrift
