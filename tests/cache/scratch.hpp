// A directory for one test, removed afterwards; and bytes of files.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace muslin::test {

class Scratch {
 public:
  Scratch() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(info->test_suite_name()) + "." + info->name();
    for (char& c : name)
      if (c == '/') c = '_';
    path_ = std::filesystem::temp_directory_path() / ("muslin." + std::to_string(::getpid()) + "." + name);
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return std::move(out).str();
}

inline void write_bytes(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

/// The bytes of diagnostics.csv without its column `wall_ms`: what a resumed run must share with a straight
/// one.
inline std::string without_wall_times(const std::string& table) {
  constexpr int column = 15;
  std::string text;
  std::istringstream in(table);
  for (std::string line; std::getline(in, line);) {
    std::size_t begin = 0;
    for (int i = 0; i < column; ++i) begin = line.find(',', begin) + 1;
    text += line.erase(begin, line.find(',', begin) - begin) + "\n";
  }
  return text;
}

}  // namespace muslin::test
