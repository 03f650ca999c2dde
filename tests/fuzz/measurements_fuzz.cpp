// libFuzzer target: any bytes as a file of measurements, inverted without simulations.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "muslin/core/error.hpp"
#include "muslin/fit/inversion.hpp"
#include "muslin/fit/material_file.hpp"
#include "muslin/fit/measurements.hpp"
#include "muslin/fit/specimens.hpp"
#include "muslin/material/material.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    muslin::Measurements m =
        muslin::parse_measurements({reinterpret_cast<const char*>(data), size}, "measurements.toml");
    muslin::estimate_scatter(m);
    const muslin::MaterialFile file{.name = "m",
                                    .description = "",
                                    .source = "",
                                    .values = muslin::invert(m).values,
                                    .reference = {},
                                    .warnings = {},
                                    .measurements = ""};
    muslin::parse_material(muslin::material_text(file), "m.toml");
  } catch (const muslin::Error&) {  // a right answer
  }
  return 0;
}
