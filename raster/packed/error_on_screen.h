// How large the errors of simplified pages are on the screen.
#pragma once

#include "packs/page.h"
#include "raster/pipeline/prepared_draw.h"

namespace delray::raster {

// Of the pages of one instance.
class ErrorOnScreen {
 public:
  // `most` is in samples. Refers to the draw.
  ErrorOnScreen(const Screen& screen, const PreparedDraw& draw, double most);

  // Whether an error is no more than that, wherever in the box it is seen. What holds for an error
  // in a box holds for smaller ones in smaller boxes, to the last bit.
  bool allows(float error, const geometry::Box3& bounds) const;
  // Whether what was made of a group may be drawn instead of it. Whatever may be drawn for a group
  // may be for those that it was made of, since its error is larger and its bounds around theirs.
  bool allows(const packs::Group& group) const { return allows(group.error, group.bounds); }

 private:
  const Screen& screen_;
  const PreparedDraw& draw_;
  glm::vec2 frame_{0};  // what is seen, at most: sideways for each unit along the view axis
  float factor_ = 0;    // a unit of the mesh at distance 1, along the axis, in bounds of error
};

}  // namespace delray::raster
