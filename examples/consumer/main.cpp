// A program of your own on top of muslin: runs a scene and prints where its first probe is, frame by frame.
#include <cstdio>
#include <memory>

#include <muslin/muslin.hpp>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: consumer SCENE.toml\n");
    return 2;
  }
  try {
    const muslin::Scene scene = muslin::read_scene(argv[1]);
    const auto model = std::make_shared<const muslin::Model>(muslin::build_model(scene));
    muslin::Simulation simulation(model);
    for (int frame = 0; frame <= scene.time.frames(); ++frame) {
      if (frame > 0) simulation.advance();
      if (model->probes.empty()) continue;
      const muslin::Probe& probe = model->probes.front();
      muslin::Vec3 at;
      probe.point.apply(
          model->of(model->bodies[static_cast<std::size_t>(probe.body)], simulation.state().positions),
          {&at, 1});
      std::printf("%d %.6f %.6f %.6f\n", frame, at.x(), at.y(), at.z());
    }
  } catch (const muslin::Error& error) {
    std::fprintf(stderr, "consumer: %s\n", error.what());
    return static_cast<int>(error.kind());
  }
  return 0;
}
