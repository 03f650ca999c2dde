// Progress lets long work report its progress and be cancelled.
#pragma once

#include <functional>
#include <string_view>

#include "muslin/api.hpp"

namespace muslin {

/// Both callbacks may be empty. Long work calls `report` with the finished fraction (0…1) and its stage, and
/// polls `cancelled`; when that returns true it throws Error(ErrorKind::interrupted).
struct MUSLIN_API Progress {
  std::function<void(double fraction, std::string_view stage)> report;
  std::function<bool()> cancelled;

  /// Reports, then throws if cancelled.
  void at(double fraction, std::string_view stage) const;
};

}  // namespace muslin
