// In which order things happen when a horizontal line sweeps up over points, exactly.
#pragma once

#include <array>
#include <glm/glm.hpp>

namespace delray::delaunay::internal {

// A closed interval that holds a number.
template <class Float>
struct Interval {
  Float low = 0, high = 0;
};

// Whether the parabolas of `left` and `right`, the points as far from them as from the line through
// s, meet to the left of s, where that of `left` ends and that of `right` begins.
// REQUIRES: neither is above s.
bool meet_left_of(const glm::dvec2& left, const glm::dvec2& right, const glm::dvec2& s);

// The circle through three points that turn left, whose top the line reaches.
class TopOfCircle {
 public:
  TopOfCircle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);

  // The sign of the top's y minus that of the other's; minus a number. Exact.
  int compare(const TopOfCircle& other) const;
  int compare(double y) const;

 private:
  template <class Float>
  Interval<Float> bounds() const;  // of y

  std::array<glm::dvec2, 3> points_;
  Interval<double> y_;
};

}  // namespace delray::delaunay::internal
