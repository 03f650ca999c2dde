// Measurements are what a laboratory has measured of a fabric, as a file of measurements states it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/core/error.hpp"
#include "muslin/core/vectors.hpp"

namespace muslin {

namespace schema {
struct Table;
}

/// A measured number in SI units.
struct Measured {
  double value = 0;
  std::optional<double> plus_minus;  ///< its standard uncertainty; none: not known
};

enum class Thread { warp, weft, bias };

/// A strip test of one specimen: (strain, force per width [N/m]), the strains ascending.
struct TensileTest {
  std::string name;
  Thread direction = Thread::warp;
  std::vector<Vec2> points;
  std::optional<double> width;       ///< of the strip [m]
  std::optional<double> length;      ///< of the strip between its clamps [m]
  Measured factor{1, std::nullopt};  ///< of all forces
  double held = 0;                   ///< by the clamps across, a share (fit/strip_clamps.hpp)
  Place place;
};

/// A picture frame or KES-FB1: (angle [degrees], force per length [N/m]), or the slope at rest.
struct ShearTest {
  std::string name;
  std::vector<Vec2> points;
  std::optional<Measured> modulus;  ///< force per length and radian [N/m], in place of points
  Measured factor{1, std::nullopt};
  Place place;
};

enum class LoopShape { heart, ring, pear };

/// One of: a bending length, a hanging loop, a rigidity, points (curvature [1/m], moment per width [N]).
struct BendingTest {
  std::string name;
  Thread direction = Thread::warp;
  std::optional<Measured> bending_length;  ///< half the overhang at 41.5° below the horizontal [m]
  std::optional<Measured> loop_height;     ///< from the grip to the lowest point [m]
  LoopShape loop = LoopShape::heart;
  std::optional<double> loop_length;  ///< of the strip that makes the loop [m]
  std::optional<Measured> rigidity;   ///< moment per width and curvature [N·m]
  std::vector<Vec2> points;
  Measured factor{1, std::nullopt};
  Place place;
};

/// Cusick's test: a disc of cloth on a smaller disc.
struct DrapeTest {
  std::optional<Measured> coefficient;  ///< share of the overhanging ring that the shadow covers
  double specimen_diameter = 0.30;      ///< [m]
  double support_diameter = 0.18;       ///< [m]
  Place place;
};

/// A side of a sheet of the Kawabata Evaluation System, in SI units.
struct KesSide {
  std::optional<Measured> linearity;           ///< LT
  std::optional<Measured> tensile_energy;      ///< WT [N/m]
  std::optional<Measured> resilience;          ///< RT, a share
  std::optional<Measured> extension;           ///< EMT, the strain under 490 N/m
  std::optional<Measured> shear;               ///< G [N/m per radian]
  std::optional<Measured> shear_hysteresis;    ///< 2HG [N/m]
  std::optional<Measured> shear_hysteresis_5;  ///< 2HG5 [N/m]
  std::optional<Measured> bending;             ///< B [N·m]
  std::optional<Measured> bending_hysteresis;  ///< 2HB [N]
  double held = 0;                             ///< as of a strip test
  Place place;
};

struct KesSheet {
  std::optional<Measured> weight;     ///< W [kg/m²]
  std::optional<Measured> thickness;  ///< T [m]
  std::optional<KesSide> warp, weft;
  Place place;
};

struct Measurements {
  std::filesystem::path file;                ///< read from it
  std::vector<std::filesystem::path> files;  ///< all that were read, this one first
  std::string name, description, source;
  std::optional<Measured> areal_density;  ///< [kg/m²]
  std::optional<Measured> thickness;      ///< [m]
  std::optional<Measured> poisson;
  std::vector<TensileTest> tensile;
  std::vector<ShearTest> shear;
  std::vector<BendingTest> bending;
  std::optional<DrapeTest> drape;
  std::optional<KesSheet> kes;
};

/// The force per width at which KES-FB1 reads the extension: 500 gf/cm [N/m].
inline constexpr double kes_tension = 490.3325;

/// The keys of a file of measurements.
const schema::Table& measurements_table();

/// Reads a file of measurements (docs/guide/fitting.md). Files that it names are relative to it. Errors:
/// file; input with file, line and column.
Measurements read_measurements(const std::filesystem::path& file);
Measurements parse_measurements(std::string_view text, const std::filesystem::path& file);

/// Calls visit(measured) for every measured number and every factor of a curve, in a fixed order.
void for_each_measured(Measurements& m, const std::function<void(Measured&)>& visit);

}  // namespace muslin
