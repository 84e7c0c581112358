// A picture with areas of it coloured by an amount.
#pragma once

#include <string>
#include <vector>

#include "apps/report/html.h"
#include "geometry/rect.h"
#include "image/image.h"

namespace delray::apps::report {

struct Area {
  geometry::Rect rect;  // in pixels of the frame
  int group = 0;        // borders are drawn between groups
  double value = 1;
  std::string note;  // on hover
};

// around_one: values above 1 are orange, those below 1 blue, the more so the farther they are from
// it; at 1 the picture shows as it is. amount: the darker the nearer to 1, from 0. group: each has
// a colour of its own.
enum class Shading { around_one, amount, group };

struct Overlay {
  std::string title;
  Source source = Source::measured;
  int width = 0, height = 0;  // of the frame, in pixels
  std::vector<Area> areas;    // disjoint
  Shading shading = Shading::around_one;
};

// A figure. `picture_id` names an element that backdrop() made of the picture, so that many figures
// share one.
Html overlay(const Overlay& overlay, const std::string& picture_id);

// The picture, not shown itself. REQUIRES: an id that is unique on the page and needs no escapes.
Html backdrop(const image::Image8& picture, const std::string& id);

// The meaning of colours around one.
Html overlay_key(const std::string& low, const std::string& even, const std::string& high);

}  // namespace delray::apps::report
