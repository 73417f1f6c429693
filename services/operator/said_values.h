/// @file
/// Reads and checks the keys of a JSON object from outside.

#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Collects the problems; an invalid value is replaced by a meaningless one.
class SaidValues {
 public:
  /// @param object Must outlive this.
  explicit SaidValues(const nlohmann::json& object) : object_{object} {}

  /// Returns a text of at most 200 characters without control characters.
  std::string text(const char* key);
  std::string text_or_empty(const char* key);
  /// @param names Allowed values. @return Index among them.
  std::size_t name(const char* key, std::span<const std::string_view> names);
  double number(const char* key, double at_least, double at_most);
  TaiTime time(const char* key);
  std::optional<TaiTime> time_if(const char* key);
  bool has(const char* key);

  void wrong(std::string problem) { problems_.push_back(std::move(problem)); }
  /// Returns the problems, including keys that were never asked for; empty when there are none.
  std::string problems() const;

 private:
  const nlohmann::json* find(const char* key);

  const nlohmann::json& object_;
  std::vector<std::string> asked_;
  std::vector<std::string> problems_;
};

}  // namespace spindrift
