// Small mesh files of every format, as bytes.
#pragma once

#include <string>

namespace muslin::fixtures {

std::string obj();        ///< two quads' worth: a quad, two triangles, seams, groups, vertex group
std::string ply_ascii();  ///< a quad and a triangle with vertex texture coordinates
std::string ply_binary(bool big_endian);  ///< the same
std::string stl_ascii();                  ///< a unit square as two triangles
std::string stl_binary();                 ///< the same
std::string gltf();                       ///< a square with a seam, twice, the second mirrored; buffer inside
std::string glb();                        ///< the same
std::string collada();                    ///< a square of 100 cm, z up
std::string fbx();                        ///< a rectangle of 1 × 2 m, written by assimp

}  // namespace muslin::fixtures
