// Drapes of a disc of 30 cm on a support of 18 cm (Cusick; BS 5058, ISO 9073-9): on any mesh, and against
// what is measured of a class of fabrics.
#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "verify_fabric.hpp"

#include "muslin/fit/drape.hpp"

namespace muslin::app {
namespace {

/// Drape coefficients against the mean of those of the finest meshes. The cells of a FabricMesh are those
/// from the support to the edge of the cloth, 60 mm.
std::vector<Comparison> drapes_alike(const std::string& material, std::initializer_list<int> cells) {
  constexpr double points = 3;
  const int finest = *(cells.end() - 1);
  std::vector<Comparison> numbers;
  double sum = 0, count = 0;
  for (const FabricMesh& of : fabric_meshes(cells)) {
    DrapeOptions options;
    options.rings = of.cells;
    options.drops = 1;
    options.mesh = of.kind;
    const double coefficient = 100 * drape_coefficient(find_material(material), {}, options);
    numbers.push_back({of.label(material + " [%]"), 0, coefficient, points, false});
    if (of.cells < finest) continue;
    sum += coefficient;
    ++count;
  }
  for (Comparison& number : numbers) number.reference = sum / count;
  return numbers;
}

/// Measured coefficients of a class of fabrics [%].
struct DrapeBand {
  const char* material;
  double least, most;
};

/// Several drops, whose starts differ, with cells of 5 mm.
std::vector<Comparison> drapes_of_classes() {
  constexpr int drops = 3;
  constexpr double fewest = 3, most = 8;  // folds
  std::vector<Comparison> numbers;
  for (const DrapeBand& band : {DrapeBand{"silk", 20, 40}, DrapeBand{"cotton", 60, 76},
                                DrapeBand{"wool", 40, 70}, DrapeBand{"denim", 70, 90}}) {
    DrapeOptions options;
    options.rings = 12;
    options.drops = drops;
    const std::vector<Drape> drapes = simulate_drapes(find_material(band.material), {}, options);
    const std::string name = band.material;
    double sum = 0;
    for (const Drape& drape : drapes) sum += drape.coefficient;
    numbers.push_back({name + ": mean of 3 drops [%]", (band.least + band.most) / 2, 100 * sum / drops,
                       (band.most - band.least) / 2, false});
    const auto [coefficient, largest] =
        std::minmax_element(drapes.begin(), drapes.end(),
                            [](const Drape& a, const Drape& b) { return a.coefficient < b.coefficient; });
    numbers.push_back({name + ": range of the drops [points]", 0,
                       100 * (largest->coefficient - coefficient->coefficient), 3, false});
    const auto [few, many] = std::minmax_element(
        drapes.begin(), drapes.end(), [](const Drape& a, const Drape& b) { return a.folds < b.folds; });
    for (const auto& [quantity, folds] :
         {std::pair{": fewest folds", few->folds}, std::pair{": most folds", many->folds}})
      numbers.push_back(
          {name + quantity, (fewest + most) / 2, static_cast<double>(folds), (most - fewest) / 2, false});
  }
  return numbers;
}

}  // namespace

std::vector<VerifyCase> drape_cases() {
  const std::string finest = "the mean of the finest";
  return {{"drape-cotton", "a disc drapes by the same coefficient on any mesh with edges of 6, 5 and 4 mm",
           finest, true, [] { return drapes_alike("cotton", {10, 12, 15}); }},
          {"drape-denim", "a disc drapes by the same coefficient on any mesh with edges of 7.5, 6 and 5 mm",
           finest, true, [] { return drapes_alike("denim", {8, 10, 12}); }},
          {"drape-classes", "fabrics drape within what is measured of their class, in 3 to 8 folds",
           "measured ranges", true, drapes_of_classes}};
}

}  // namespace muslin::app
