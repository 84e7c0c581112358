// Which points of an input are read: by class, return, place and, of octrees, density.
#pragma once

#include <array>
#include <bitset>
#include <optional>
#include <span>
#include <string_view>

#include "geometry/box.h"

namespace delray::delaunay {

// Pulses of LiDAR come back several times: from leaves first, from the ground last.
struct ReturnChoice {
  std::string_view name;         // "last"
  std::string_view description;  // one line
  // Whether return `number`, counted from 1, of `count` is wanted. Files without numbers have 0.
  bool (*wants)(int number, int count);
};
std::span<const ReturnChoice> return_choices();

// Points are kept if they are all that is asked for. A default filter keeps everything.
struct PointFilter {
  std::optional<std::bitset<256>> classes;  // classifications of LAS
  const ReturnChoice* returns = nullptr;    // of return_choices()
  std::optional<geometry::Box3d> bounds;    // closed
  bool bounds_z = false;                    // the bounds say something about z
  // Of clouds with an octree (COPC): no finer than this distance between points. 0: all points.
  double resolution = 0;

  bool keeps_all() const { return !classes && !returns && !bounds && resolution == 0; }
};

}  // namespace delray::delaunay
