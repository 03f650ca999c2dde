// Runs a reader that may crash or never end on damaged input in a process of its own.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace muslin {

struct IsolationLimits {
  unsigned seconds = 120;  ///< of processor time, and twice of it of any time
  double memory = 4e9;     ///< beyond what this process has [bytes]; without effect under sanitizers
};

/// The child ended without a result; what() says why: it crashed (Segmentation fault).
class IsolatedFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Calls `work` in a child process and returns what it returns. In the child there is this thread alone:
/// `work` must not wait for others, so it may not use parallel loops. Errors: those that `work` throws;
/// IsolatedFailure if it crashed or went beyond the limits; interrupted, if the user stopped it; file, if no
/// process can be started.
std::string run_isolated(const std::function<std::string()>& work, const IsolationLimits& limits = {});

}  // namespace muslin
