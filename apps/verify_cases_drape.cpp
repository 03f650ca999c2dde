// Drapes of a disc of 30 cm on a support of 18 cm (Cusick; BS 5058, ISO 9073-9) on any mesh.
#include <cstddef>
#include <string>
#include <vector>

#include "verify_fabric.hpp"

#include "muslin/fit/drape.hpp"

namespace muslin::app {
namespace {

/// Drape coefficients against the mean of those of the finest meshes, whose cells are 7.5 mm long. The cells of
/// a FabricMesh are those from the support to the edge of the cloth.
std::vector<Comparison> drapes_alike() {
  constexpr int finest = 8;
  constexpr double points = 3;
  const std::vector<FabricMesh> meshes = fabric_meshes({4, 6, finest});
  std::vector<Comparison> numbers;
  numbers.reserve(2 * meshes.size());
  for (const std::string material : {"silk", "denim"}) {
    const std::size_t first = numbers.size();
    double sum = 0, count = 0;
    for (const FabricMesh& of : meshes) {
      DrapeOptions options;
      options.rings = of.cells;
      options.mesh = of.kind;
      const double coefficient = 100 * drape_coefficient(find_material(material), {}, options);
      numbers.push_back({of.label(material + " [%]"), 0, coefficient, points, false});
      if (of.cells < finest) continue;
      sum += coefficient;
      ++count;
    }
    for (std::size_t i = first; i < numbers.size(); ++i) numbers[i].reference = sum / count;
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> drape_cases() {
  return {{"drape", "a disc drapes by the same coefficient on any mesh with edges of 15, 10 and 7.5 mm",
           "the mean of the finest", true, drapes_alike}};
}

}  // namespace muslin::app
