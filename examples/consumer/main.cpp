// A program of your own on top of muslin: runs a scene with a drag of its own on the first body, and prints
// where the first probe is and how far the body is stretched, frame by frame.
#include <cstdio>
#include <memory>

#include <muslin/muslin.hpp>

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: consumer SCENE.toml\n"), 2;
  const auto model = std::make_shared<const muslin::Model>(muslin::build_model(muslin::read_scene(argv[1])));
  muslin::Simulation simulation(model);
  muslin::SimulatedBody body = simulation.body(model->bodies.front().name);
  body.add_force("drag",
                 [](double, muslin::ConstVectors, muslin::ConstVectors velocities, muslin::Vectors forces) {
                   for (std::size_t v = 0; v < forces.size(); ++v) forces[v] = -1e-4 * velocities[v];
                 });
  for (int frame = 0; frame <= model->scene.time.frames(); ++frame) {
    if (frame > 0) simulation.advance();
    const muslin::Vec3 at = simulation.probe(model->probes.front().name);
    std::printf("%d %.6f %.6f %.6f %.4f\n", frame, at.x(), at.y(), at.z(), body.stretch());
  }
  return 0;
} catch (const muslin::Error& error) {
  std::fprintf(stderr, "consumer: %s\n", error.what());
  return static_cast<int>(error.kind());
}
