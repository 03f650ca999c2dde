// Includes the public interface: scenes, models, simulations, runs. These headers and those they include are
// installed; no others are.
#pragma once

#include "muslin/cache/export.hpp"
#include "muslin/cache/run.hpp"
#include "muslin/cache/run_reader.hpp"
#include "muslin/cache/run_writer.hpp"
#include "muslin/component/component.hpp"
#include "muslin/component/lattice/lattice_body_settings.hpp"
#include "muslin/component/shell/shell_body_settings.hpp"
#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/scene/field_force_settings.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/scene/validate.hpp"
#include "muslin/scene/wind_force_settings.hpp"
#include "muslin/simulation/simulation.hpp"
#include "muslin/version.hpp"
