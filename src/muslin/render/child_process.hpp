// ChildProcess runs another program, without a shell, and sends it bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <sys/types.h>

namespace muslin {

class ChildProcess {
 public:
  /// arguments[0] is the program, looked up in PATH. It runs in a process group of its own, so that Ctrl-C
  /// reaches only the parent. Throws Error(file) with `remedy` if it cannot be started.
  ChildProcess(const std::vector<std::string>& arguments, const std::string& remedy);
  /// Kills the program if it still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Sends all bytes to its standard input; false if it no longer reads (no signal is raised).
  bool send(std::span<const std::uint8_t> bytes);
  /// Ends its input and waits for it; true if it exited with 0.
  bool wait();
  /// Kills the program if it still runs.
  void kill();
  /// Returns its standard error so far, without trailing line breaks.
  std::string errors() const;

 private:
  pid_t pid_ = -1;
  int input_ = -1;
  int errors_ = -1;
};

}  // namespace muslin
