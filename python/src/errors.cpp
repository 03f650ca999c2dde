#include "errors.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>

#include <nanobind/nanobind.h>

#include "muslin/hosts.hpp"

namespace nb = nanobind;

namespace muslin::python {
namespace {

const char* class_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
      return "UsageError";
    case ErrorKind::input:
      return "InputError";
    case ErrorKind::solver:
      return "SolverError";
    case ErrorKind::file:
      return "FileError";
    case ErrorKind::interrupted:
      return "Interrupted";
  }
  return "Error";
}

void raise(const Error& error) {
  const nb::object type = nb::module_::import_("muslin.errors").attr(class_of(error.kind()));
  const Place& place = error.place();
  const nb::object value =
      type(error.problem().c_str(), error.remedy().c_str(), place.file.c_str(), place.line, place.column);
  PyErr_SetObject(type.ptr(), value.ptr());
}

void translate(const std::exception_ptr& exception, void*) {
  try {
    std::rethrow_exception(exception);
  } catch (const Error& error) {
    raise(error);
  } catch (const std::filesystem::filesystem_error& error) {
    raise(Error(ErrorKind::file, {error.path1().string()}, error.code().message(), "check the path"));
  }
}

}  // namespace

void translate_errors() { nb::register_exception_translator(translate); }

std::size_t choice(const std::string& word, const std::vector<std::string>& names, const std::string& what) {
  const auto at = std::find(names.begin(), names.end(), word);
  if (at == names.end())
    throw Error(ErrorKind::usage, "`" + word + "` is no " + what, name_advice(word, names));
  return static_cast<std::size_t>(at - names.begin());
}

}  // namespace muslin::python
