// Subject is the object of a check: a table of a file, or settings that a program has made.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/core/toml_table.hpp"

namespace muslin::schema {

class Subject {
 public:
  /// `table` must outlive the subject.
  explicit Subject(const TomlTable& table) : table_(&table) {}
  /// Settings of a program; `title` names them in messages, such as: [[pin]] `top`.
  Subject(std::string title, Place place) : title_(std::move(title)), place_(std::move(place)) {}

  /// Null for settings of a program.
  const TomlTable* table() const { return table_; }

  /// Returns an error about the key: at its place in the file, or else with the title.
  Error error(std::string_view key, const std::string& problem, std::string remedy) const {
    if (table_ != nullptr) return table_->error(key, problem, std::move(remedy));
    return {ErrorKind::input, place_, title_ + ": " + problem, std::move(remedy)};
  }

 private:
  const TomlTable* table_ = nullptr;
  std::string title_;
  Place place_;
};

}  // namespace muslin::schema
