// Checks of files before Assimp reads them. Assimp trusts counts, indices and even comments of a
// file more than it should; what these functions let pass it reads without going astray. All throw
// files::FileError that names line, byte or element, for a file without triangles too. O(file).
#pragma once

#include <string>

#include "scenes/internal/source.h"
#include "scenes/internal/text_lines.h"

namespace delray::scenes::internal {

// Coordinates larger than this are refused: products of two would overflow single precision.
inline constexpr double kLargestCoordinate = 1e18;

inline constexpr const char* kNoTriangles =
    "there are no triangles in the file (if it holds points, triangulate them)";

// The file with its checked vertices, its faces of 3 or more corners that exist, and the names of
// objects and materials, and nothing else. Points and lines are left out with a warning.
std::string clean_obj(const Source& source);

// The file with its vertices and faces as in clean_obj, without comments and colours.
std::string clean_off(const Source& source);

// The header's claims against the size of the file, every list's length, every index and
// coordinate.
void check_ply(const Source& source);

// Binary: the count against the size of the file. Text: whole facets up to the end.
void check_stl(const Source& source);

// Appends the next `count` words to `text`, each after a blank; fails unless they are finite
// numbers of at most kLargestCoordinate.
void copy_coordinates(const Source& source, const Lines& lines, Words& words, int count,
                      std::string& text);

}  // namespace delray::scenes::internal
