/// @file
/// The keys of a JSON object from outside, each looked at.

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

/// What is wrong is noted, in place of which a value of no meaning is given.
class SaidValues {
 public:
  /// @param object Outlives it.
  explicit SaidValues(const nlohmann::json& object) : object_{object} {}

  /// At most 200 characters, none of them a control character.
  std::string text(const char* key);
  std::string text_or_empty(const char* key);
  /// One of `names`. @return Its place among them.
  std::size_t name(const char* key, std::span<const std::string_view> names);
  double number(const char* key, double at_least, double at_most);
  TaiTime time(const char* key);
  std::optional<TaiTime> time_if(const char* key);
  bool has(const char* key);

  void wrong(std::string problem) { problems_.push_back(std::move(problem)); }
  /// A key that nothing has asked for is wrong, too. Empty: all is well.
  std::string problems() const;

 private:
  const nlohmann::json* find(const char* key);

  const nlohmann::json& object_;
  std::vector<std::string> asked_;
  std::vector<std::string> problems_;
};

}  // namespace spindrift
