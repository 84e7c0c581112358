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

  // Whether what was made of a group may be drawn instead of it, wherever it is seen. Whatever may
  // be drawn for a group may be for those that it was made of, since its error is larger and its
  // sphere around theirs.
  bool allows(const packs::Group& group) const {
    return group.error * factor_ <= distance(group.centre, group.radius * length_);
  }
  // Whether that holds for all groups of such errors whose spheres are in the box.
  bool allows_all(float error, const geometry::Box3& spheres) const {
    constexpr float kRounding = 1e-3F;  // that no rounding makes a group of them one that is not
    return error * factor_ * (1 + kRounding) <=
           distance(spheres.centre(), glm::dot(along_, spheres.size() * 0.5F));
  }

 private:
  // Along the view axis, of what reaches so far along it around a place of the mesh; 1 without
  // perspective.
  float distance(const glm::vec3& centre, float reach) const;

  const Screen& screen_;
  const PreparedDraw& draw_;
  // How far along the view axis a unit of the mesh goes at most, and one along each of its axes.
  float length_ = 1;
  glm::vec3 along_{1};
  float factor_ = 0;  // a group is allowed whose error times this is no more than its distance
};

}  // namespace delray::raster
