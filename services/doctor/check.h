/// @file
/// The result of one check, a value independent of how it is printed.
///
/// Each subject has a file X_facts.cpp, which looks at the world, and a file X_checks.cpp, which
/// judges the facts and is pure. The doctor changes nothing and disturbs nobody: it has no reader
/// or writer on a topic in a partition of others, and takes no lock on an archive.

#pragma once

#include <string>
#include <utility>

namespace spindrift::doctor {

enum class Verdict {
  Ok,
  Warning,  ///< A pass can be taken but may be impaired.
  Failure,  ///< A pass cannot be taken, or stored data is unreliable.
};

struct Check {
  std::string name;
  Verdict verdict;
  std::string found;   ///< With numbers; one line per finding.
  std::string advice;  ///< What to do; empty when nothing is needed.

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
