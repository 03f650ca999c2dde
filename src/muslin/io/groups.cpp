#include "muslin/io/groups.hpp"

#include <algorithm>

namespace muslin {

void complete_group(const Mesh& mesh, MeshGroup& group) {
  const auto sort_unique = [](std::vector<int>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  sort_unique(group.faces);
  for (const int f : group.faces) {
    const auto face = mesh.face(static_cast<std::size_t>(f));
    group.vertices.insert(group.vertices.end(), face.begin(), face.end());
  }
  sort_unique(group.vertices);
}

std::string one_word(std::string_view name) {
  std::string word(name);
  for (char& c : word)
    if (static_cast<unsigned char>(c) <= 32 || c == 127) c = '_';
  return word;
}

}  // namespace muslin
