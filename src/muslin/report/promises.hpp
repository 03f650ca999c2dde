// Promises are what muslin promises of every run; each gets a verdict from the evidence.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "muslin/cache/run_reader.hpp"
#include "muslin/report/run_evidence.hpp"

namespace muslin {

enum class Verdict { kept, broken, not_measured };
/// Returns "kept", "broken" or "not measured".
const char* name_of(Verdict verdict);

struct Promise {
  std::string key;    ///< for programs, such as "nothing_crosses"
  std::string title;  ///< such as "Nothing crosses"
  Verdict verdict = Verdict::not_measured;
  std::string finding;                      ///< one sentence: what was found, or why it could not be measured
  std::string limit;                        ///< in words
  std::optional<double> measured, allowed;  ///< the number and its limit, in `unit`
  std::string unit;
  std::vector<int> frames;  ///< those that break it
};

/// Returns all promises, always the same ones in the same order.
std::vector<Promise> judge(const RunReader& run, const RunEvidence& evidence);

}  // namespace muslin
