// Axis-aligned boxes over GLM vectors.
#pragma once

#include <glm/glm.hpp>
#include <limits>

namespace delray::geometry {

// The closed box [low, high]. A default box is empty and is the identity of `include`.
template <class Vector>
struct Box {
  using Scalar = typename Vector::value_type;
  Vector low = Vector(std::numeric_limits<Scalar>::max());
  Vector high = Vector(std::numeric_limits<Scalar>::lowest());

  void include(const Vector& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  void include(const Box& b) {
    low = glm::min(low, b.low);
    high = glm::max(high, b.high);
  }
  bool empty() const { return glm::any(glm::greaterThan(low, high)); }
  // Half of each side is added before the sum, so that boxes near the largest float do not
  // overflow.
  Vector centre() const { return low * Scalar(0.5) + high * Scalar(0.5); }
  Vector size() const { return empty() ? Vector(0) : high - low; }
  bool operator==(const Box&) const = default;
};

using Box2 = Box<glm::vec2>;
using Box3 = Box<glm::vec3>;
using Box3d = Box<glm::dvec3>;

}  // namespace delray::geometry
