/// @file
/// What the doctor says of one thing: a value, so that finding and printing are apart.

#pragma once

#include <string>
#include <utility>

namespace spindrift::doctor {

enum class Verdict {
  Ok,
  Warning,  ///< A pass can be taken, but something may go wrong or be wrong with it.
  Failure,  ///< A pass cannot be taken, or what is stored cannot be trusted.
};

struct Check {
  std::string name;
  Verdict verdict;
  std::string found;   ///< With numbers; several lines where several things were found.
  std::string advice;  ///< What to do; empty where there is nothing to do.

  friend bool operator==(const Check&, const Check&) = default;
};

inline Check ok(std::string name, std::string found, std::string advice = "") {
  return {std::move(name), Verdict::Ok, std::move(found), std::move(advice)};
}
inline Check warning(std::string name, std::string found, std::string advice) {
  return {std::move(name), Verdict::Warning, std::move(found), std::move(advice)};
}
inline Check failure(std::string name, std::string found, std::string advice) {
  return {std::move(name), Verdict::Failure, std::move(found), std::move(advice)};
}

}  // namespace spindrift::doctor
