// AttachmentSettings describes an [[attachment]]: vertices of a body held to points of another one.
// docs/theory/attachments.md.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "muslin/api.hpp"
#include "muslin/component/selection.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/schema/variation.hpp"

namespace muslin {

struct Model;
class TomlTable;
struct Scene;
namespace schema {
struct Table;
}

struct MUSLIN_API AttachmentSettings {
  std::string name;
  std::string body;                   ///< the first body, whose points are attached
  Selection where;                    ///< among its vertices; of a rigid body among those of its mesh
  std::string to;                     ///< the other body or collider
  std::optional<Selection> where_to;  ///< points of `to`, the nearest of which is taken; none: of its surface
  std::optional<Vec3> at;             ///< the one point of `to` that all are attached to, at the start [m]
  std::optional<double> stiffness;    ///< of all springs together [N/m]; none: stiff
  double damping = 0;                 ///< of all dashpots together [N·s/m]
  std::optional<double> break_force;  ///< of all joints together [N]; none: it never breaks
  double weight = 1;                  ///< of every joint, a factor of its numbers, 0 to 1
  schema::Variations variations;      ///< by keyframes, of `weight` by a map
  enum class Rest { joined, distance, cord } rest = Rest::joined;
  double from = 0, until = std::numeric_limits<double>::infinity();  ///< [s]
  Place place;
};

/// [[attachment]] of a scene file.
const schema::Table& attachment_table();
void finish_attachment(const TomlTable& table, std::size_t index, AttachmentSettings& attachment,
                       const Scene& scene);

/// Adds the attachments of the scene to the model, whose components are complete and whose pins exist.
/// Errors: input, for a body that does not exist, an empty selection, or points of which none can move.
void build_attachments(Model& model);

}  // namespace muslin
