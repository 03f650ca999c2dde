// Paths as arguments.
#pragma once

#include <filesystem>
#include <utility>

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>

namespace muslin::python {

/// A path given as a text or as an os.PathLike.
struct FilePath {
  std::filesystem::path path;
  operator const std::filesystem::path&() const { return path; }
};

}  // namespace muslin::python

namespace nanobind::detail {

template <>
struct type_caster<muslin::python::FilePath> {
  NB_TYPE_CASTER(muslin::python::FilePath, const_name("str | os.PathLike[str]"))

  bool from_python(handle source, std::uint32_t flags, cleanup_list* cleanup) noexcept {
    make_caster<std::filesystem::path> caster;
    if (!caster.from_python(source, flags, cleanup)) return false;
    value.path = std::move(caster.value);
    return true;
  }
  static handle from_cpp(const muslin::python::FilePath& path, rv_policy policy,
                         cleanup_list* cleanup) noexcept {
    return make_caster<std::filesystem::path>::from_cpp(path.path, policy, cleanup);
  }
};

}  // namespace nanobind::detail
