// JSON of the engine as Python objects.
#pragma once

#include <string>

#include <nanobind/nanobind.h>

namespace nb = nanobind;

namespace muslin::python {

class JsonObject : public nb::object {
  static bool is_dict(nb::handle h) { return nb::isinstance<nb::dict>(h); }
  NB_OBJECT_DEFAULT(JsonObject, nb::object, "dict[str, typing.Any]", is_dict)
  explicit JsonObject(nb::object object) : nb::object(std::move(object)) {}
};

/// The text must be a JSON object.
JsonObject from_json(const std::string& text);

}  // namespace muslin::python
