// The parts of a model and what steps are chosen by: their sizes, edges and longest steps.
#include "muslin/simulation/model_parts.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "muslin/scene/model.hpp"
#include "muslin/scene/scene.hpp"

namespace muslin {
namespace {

TEST(ModelParts, RigidBodiesHaveTheSizeOfTheLargestMovingBody) {
  const std::string ball =
                        "[[collider]]\nshape = 'sphere'\nradius = 0.1\ncenter = [0, 3, 0]\ndensity = 500\n",
                    box = "[[collider]]\nshape = 'box'\nsize = [2, 2, 2]\ndensity = 500\n",
                    table = "[[collider]]\nshape = 'box'\nsize = [20, 1, 20]\ncenter = [0, -3, 0]\n";
  const auto sizes_of = [](const std::string& text) {
    const Model model = build_model(parse_scene(text, "scene.toml"));
    const ModelParts parts = find_parts(model);
    std::vector<double> sizes;
    for (std::size_t i = 0; i < model.bodies.size(); ++i)
      sizes.push_back(parts.sizes[static_cast<std::size_t>(
          parts.of_vertex[static_cast<std::size_t>(model.bodies[i].first_vertex)])]);
    return sizes;
  };
  const double alone = sizes_of(ball + table)[0], large = sizes_of(box + table)[0];
  EXPECT_LT(10 * alone, large);
  EXPECT_LT(large, 4);
  const std::vector<double> both = sizes_of(ball + box + table);
  EXPECT_EQ(both[0], large);
  EXPECT_EQ(both[1], large);
  EXPECT_GT(both[2], 20) << "what does not move keeps its own";
}

}  // namespace
}  // namespace muslin
