/// @file
/// Commands of spindrift that run to their end.

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/matchers.h"
#include "tests/support/program.h"

namespace spindrift {

using Words = std::vector<std::string>;

inline Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// How a command ended and what it said.
struct Ran {
  int status;  ///< Exit status; -1 if it was killed.
  std::string out;
  std::string log;

  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

inline Ran ended(const Words& words) {
  Program program{words};
  const int status = program.exit_status();
  return {.status = status, .out = program.out(), .log = program.log()};
}

/// Runs a command that is expected to succeed.
inline Ran succeeded(const Words& words) {
  Ran ran = ended(words);
  EXPECT_EQ(ran.status, 0) << ran.log;
  return ran;
}

/// Runs a command that is expected to fail and to say each of `says` on standard error.
inline Ran refused(const Words& words, const Words& says, int status = 2) {
  Ran ran = ended(words);
  EXPECT_EQ(ran.status, status);
  for (const std::string& said : says) {
    EXPECT_THAT(ran.log, HasSubstr(said));
  }
  return ran;
}

inline void expect_said_once(const std::string& log, const std::string& words) {
  EXPECT_THAT(log, HasSubstr(words));
  EXPECT_EQ(log.find(words), log.rfind(words)) << words;
}

}  // namespace spindrift
