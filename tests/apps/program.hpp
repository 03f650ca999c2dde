// The program as its users meet it: started, fed, stopped, and asked for its exit code.
#pragma once

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "cache/scratch.hpp"
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace muslin::test {

inline const std::filesystem::path source = MUSLIN_SOURCE_DIR;
inline const std::filesystem::path scenes = source / "scenes";
inline const std::string two_corners = (scenes / "thesis" / "2_two_corners.toml").string();

struct Outcome {
  int code = -1;  ///< exit code, or 128 + the signal that ended it
  std::string out, err;
};

/// A process of the program whose output goes to files in a scratch folder.
class Process {
 public:
  struct Streams {
    std::string out;               ///< a path to write standard output to, instead of a file of its own
    std::function<void()> before;  ///< called in the new process, before the program starts
  };
  Process(const Scratch& scratch, const std::vector<std::string>& arguments, const Streams& streams = {})
      : out_(streams.out.empty() ? (scratch / "stdout").string() : streams.out),
        err_((scratch / "stderr").string()) {
    id_ = ::fork();
    if (id_ == 0) {
      redirect(out_, STDOUT_FILENO);
      redirect(err_, STDERR_FILENO);
      if (streams.before) streams.before();
      std::vector<char*> argv;
      std::vector<std::string> words = arguments;
      words.insert(words.begin(), MUSLIN_PROGRAM);
      for (std::string& word : words) argv.push_back(word.data());
      argv.push_back(nullptr);
      ::execv(argv[0], argv.data());
      ::_exit(99);
    }
  }
  ~Process() {
    if (id_ > 0) {
      send(SIGKILL);
      wait();
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const { ::kill(id_, signal); }
  bool running() const {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == 0;
  }
  Outcome wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = 0;
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return {code, std::filesystem::is_regular_file(out_) ? bytes_of(out_) : "", bytes_of(err_)};
  }

 private:
  static void redirect(const std::string& path, int stream) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    ::dup2(file, stream);
    ::close(file);
  }
  pid_t id_ = 0;
  std::string out_, err_;
};

inline Outcome run(const Scratch& scratch, const std::vector<std::string>& arguments,
                   const Process::Streams& streams = {}) {
  return Process(scratch, arguments, streams).wait();
}

inline void write_scene(const std::filesystem::path& path, const std::string& mesh,
                        const std::string& body = "voxel_width = 1.0\nmaterial = \"thesis_flag\"\n",
                        const std::string& rest = "") {
  write_bytes(path,
              "[time]\nduration = 0.25\n[[body]]\nname = \"b\"\nmesh = \"" + mesh + "\"\n" + body + rest);
}

}  // namespace muslin::test
