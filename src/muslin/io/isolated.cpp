#include "muslin/io/isolated.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool limits_memory = false;  // sanitizers reserve terabytes of addresses
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
constexpr bool limits_memory = false;
#else
constexpr bool limits_memory = true;
#endif
#else
constexpr bool limits_memory = true;
#endif

/// The first byte of what the child sends.
enum class Message : char { result = 'r', error = 'e' };
constexpr char separator = '\0';  // between the parts of an error

/// Returns the addresses that this process uses [bytes]; 0: unknown.
double used_addresses() {
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  unsigned long pages = 0;
  const bool known = std::fscanf(file, "%lu", &pages) == 1;
  std::fclose(file);
  return known ? static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) : 0;
}

void limit(int resource, double most) {
  const auto bound = static_cast<rlim_t>(most);
  const rlimit both = {bound, bound};
  setrlimit(static_cast<decltype(RLIMIT_AS)>(resource), &both);
}

void obey(const IsolationLimits& limits) {
  for (const int signal :
       {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM, SIGALRM, SIGXCPU, SIGPIPE})
    std::signal(signal, SIG_DFL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.seconds);
  alarm(2 * limits.seconds);
  const double used = used_addresses();
  if (limits_memory && used > 0) limit(RLIMIT_AS, used + limits.memory);
}

bool send(int pipe, const std::string& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t count = write(pipe, bytes.data() + sent, bytes.size() - sent);
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) sent += static_cast<std::size_t>(count);
  }
  return true;
}

std::string message_of(const Error& error) {
  std::string text(1, static_cast<char>(Message::error));
  text += std::to_string(static_cast<int>(error.kind()));
  for (const std::string& part : {error.place().file, error.problem(), error.remedy()})
    text += separator + part;
  return text;
}

[[noreturn]] void work_in_child(int pipe, const std::function<std::string()>& work,
                                const IsolationLimits& limits) {
  obey(limits);
  std::string message;
  try {
    message = static_cast<char>(Message::result) + work();
  } catch (const Error& error) {
    message = message_of(error);
  } catch (const std::bad_alloc&) {
    message = message_of(Error(ErrorKind::input, "it asks for more memory than it may have",
                               "the file is damaged or too large: export it again"));
  } catch (const std::exception& exception) {
    message = message_of(Error(ErrorKind::input, exception.what(), "the file is damaged: export it again"));
  }
  _exit(send(pipe, message) ? 0 : 1);
}

std::string receive(int pipe) {
  std::string all;
  std::array<char, 1 << 16> buffer;
  for (;;) {
    const ssize_t count = read(pipe, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return all;
    all.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

std::string reason(int status) {
  if (!WIFSIGNALED(status)) return fmt::format("it ended with {}", WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  if (signal == SIGXCPU || signal == SIGALRM || signal == SIGKILL) return "it took too long";
  return fmt::format("it crashed ({})", strsignal(signal));
}

[[noreturn]] void throw_again(const std::string& message) {
  std::array<std::string, 4> parts;  // kind, file, problem, remedy
  std::size_t part = 0;
  for (std::size_t i = 1; i < message.size(); ++i) {
    if (message[i] == separator && part + 1 < parts.size()) {
      ++part;
    } else {
      parts[part] += message[i];
    }
  }
  throw Error(static_cast<ErrorKind>(std::stoi(parts[0])), Place{parts[1]}, parts[2], parts[3]);
}

}  // namespace

std::string run_isolated(const std::function<std::string()>& work, const IsolationLimits& limits) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0)
    throw Error(ErrorKind::file, fmt::format("no pipe can be opened: {}", std::strerror(errno)),
                "close other programs");
  for (const int end : ends) fcntl(end, F_SETFD, FD_CLOEXEC);  // programs started meanwhile must not hold it
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    work_in_child(ends[1], work, limits);
  }
  close(ends[1]);
  const std::string message = child > 0 ? receive(ends[0]) : std::string();
  close(ends[0]);
  if (child < 0)
    throw Error(ErrorKind::file, fmt::format("no process can be started: {}", std::strerror(errno)),
                "close other programs");
  const int status = wait_for(child);
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGINT)
    throw Error(ErrorKind::interrupted, "stopped while a mesh was read", "start again");
  if (status != 0 || message.empty()) throw IsolatedFailure(reason(status));
  if (message[0] == static_cast<char>(Message::error)) throw_again(message);
  return message.substr(1);
}

}  // namespace muslin
