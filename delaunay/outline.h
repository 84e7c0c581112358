// Outlines: points and the segments between them that bound a part of the plane.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "delaunay/points.h"
#include "files/memory_budget.h"

namespace delray::delaunay {

// A planar straight line graph (Ruppert 1995). Its domain is what segments separate from the
// outside of the convex hull, without the holes.
struct Outline {
  PointCloud points;  // over x and y; z is a height
  // The rows that each segment joins.
  std::vector<std::array<std::uint32_t, 2>> segments;
  // A place in each hole, which reaches from there to the segments around it.
  std::vector<glm::dvec2> holes;
};

// Reads a .poly file of Triangle (Shewchuk 1996): points as in .node, or "0 2 0 0" where they are
// in the .node file beside it; "segments markers", rows "number point point [marker]"; "holes",
// rows "number x y". Numbers begin with 0 or 1. Markers and regional attributes are left out. O(n).
//
// Throws FileError (input) that names the line, FileError (memory).
Outline read_outline(const std::filesystem::path& path, const files::MemoryBudget& memory = {});

// Writes a .poly file, numbered from 0; coordinates read back equal, a height is an attribute.
// "-" is standard output. The file appears whole or not at all. Throws FileError (device).
// REQUIRES: segments join rows.
void write_outline(const std::filesystem::path& path, const Outline& outline);

// An entry of the table of outlines.
struct OutlineGenerator {
  std::string_view name;         // "lake"
  std::string_view description;  // one line
  Outline (*generate)(std::size_t n, std::uint64_t seed);
};

std::span<const OutlineGenerator> outline_generators();

inline constexpr std::size_t kFewestOutlinePoints = 8, kMostOutlinePoints = 10'000'000;

// An outline of the named kind with about n points (from 50 on more than half and less than twice
// as many), within the unit square. The same bytes everywhere, as of generate_points(). O(n^1.6),
// parallel.
//
// Throws std::invalid_argument, naming the kinds, for any other name, and for other numbers of
// points.
Outline generate_outline(std::string_view kind, std::size_t n, std::uint64_t seed);

}  // namespace delray::delaunay
