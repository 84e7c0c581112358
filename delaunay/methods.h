// The table of triangulation methods: command line, tests, benchmarks and messages read it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {

// A name and description of a location, split, order, deadlock strategy, kind of locks or time of
// unlocking.
struct Choice {
  std::string_view name;
  std::string_view description;
};

template <int D>
struct BuiltMesh;  // mesh/built_mesh.h

// An entry of the table of methods, with what goes with it.
struct Method {
  std::string_view name;
  std::string_view description;
  std::string_view group;  // of methods that work alike; reports show these in one colour
  std::vector<int> dims;
  // The choices that go with the method, the default first; empty if it leaves none.
  std::vector<std::string_view> locations = {}, splits = {}, orders = {};
  std::vector<std::string_view> deadlocks = {}, locks = {}, unlocks = {};
  bool alone = false;   // works with one thread, whatever the options say
  bool seeded = true;   // `seed` decides about something
  bool queued = false;  // `queue` and `searching` do
  // Takes seconds for some thousands of points in space, or quadratic time where many points lie
  // near a common circle or sphere, or two lines.
  bool slow = false;
  // Leaves `created_by` empty where one thread made everything.
  // REQUIRES: options that resolve() returned.
  Result (*triangulate)(PointView<double> points, const Options& options);
  // The same before it is copied out, of methods that can tell; null where they cannot.
  BuiltMesh<2> (*mesh_2d)(PointView<double> points, const Options& options) = nullptr;
  BuiltMesh<3> (*mesh_3d)(PointView<double> points, const Options& options) = nullptr;
};

std::span<const Method> methods();
std::span<const Choice> locations();
std::span<const Choice> splits();
std::span<const Choice> orders();
std::span<const Choice> deadlock_strategies();
std::span<const Choice> lock_kinds();
std::span<const Choice> unlock_times();

// The locations of a method in one of its dimensions, the default first.
std::vector<std::string_view> locations_for(const Method& method, int dim);

// The orders of a method that go with one of its locations, the default first.
std::vector<std::string_view> orders_for(const Method& method, std::string_view location);

// The options with every "auto" replaced by what will be used; "none" where the method leaves no
// choice.
//
// Errors: std::invalid_argument that names the legal values.
Options resolve(const Options& options);

// The method of resolved options.
const Method& method_of(const Options& resolved);

}  // namespace delray::delaunay
