// Checks of files before Assimp reads them. Assimp trusts counts and indices of a file more than it
// should; what these checks let pass, it reads without going astray. All throw files::FileError
// that names line, byte or element.
#pragma once

#include "scenes/internal/source.h"

namespace delray::scenes::internal {

// Coordinates larger than this are refused: products of two would overflow single precision.
inline constexpr double kLargestCoordinate = 1e18;

inline constexpr const char* kNoTriangles =
    "there are no triangles in the file (if it holds points, triangulate them)";

// Numbers of vertices (finite), and indices of faces that exist. O(file).
void check_obj(const Source& source);
void check_off(const Source& source);

// The header's claims against the size of the file, every list's length, every index and
// coordinate. O(file).
void check_ply(const Source& source);

// Binary: the count against the size of the file. Text: whole facets up to the end. O(file).
void check_stl(const Source& source);

}  // namespace delray::scenes::internal
