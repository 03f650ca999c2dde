// The public façade: everything a program, a plug-in or a binding uses.
#pragma once

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/core/progress.hpp"
#include "muslin/field/signed_distance.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/geometry/thicken.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/lattice/embedding.hpp"
#include "muslin/lattice/lattice.hpp"
#include "muslin/lattice/springs.hpp"
#include "muslin/scene/model.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/simulation/simulation.hpp"
#include "muslin/surface/contour.hpp"
