#include "muslin/scene/model.hpp"

#include <algorithm>

#include "muslin/core/error.hpp"
#include "muslin/core/nearest_name.hpp"

namespace muslin {
namespace {

template <class List>
const auto& find_by_name(const List& all, std::string_view name, const std::string& kind) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.name == name; });
  if (found != all.end()) return *found;
  std::vector<std::string> names;
  for (const auto& each : all) names.push_back(each.name);
  throw Error(ErrorKind::usage, "the model has no " + kind + " `" + std::string(name) + "`",
              names.empty() ? "it has none at all" : name_advice(name, names));
}

}  // namespace

const Component& Model::body(std::string_view name) const { return find_by_name(bodies, name, "body"); }

const Pin& Model::pin(std::string_view name) const { return find_by_name(pins, name, "pin"); }

const Attached& Model::attachment(std::string_view name) const {
  return find_by_name(attachments, name, "attachment");
}

const Probe& Model::probe(std::string_view name) const { return find_by_name(probes, name, "probe"); }

const Component& Model::body_of(std::size_t vertex) const {
  for (const Component& body : bodies) {
    const auto first = static_cast<std::size_t>(body.first_vertex);
    if (vertex >= first && vertex - first < static_cast<std::size_t>(body.vertex_count)) return body;
  }
  throw Error(ErrorKind::usage, "the model has no vertex " + std::to_string(vertex),
              "it has " + std::to_string(vertex_count()));
}

}  // namespace muslin
