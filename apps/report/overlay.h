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
  double value = 1;     // beside 1
  std::string note;     // on hover
};

struct Overlay {
  std::string title;
  Source source = Source::measured;
  int width = 0, height = 0;  // of the frame, in pixels
  std::vector<Area> areas;    // disjoint
};

// A figure: areas above 1 are orange, those below 1 blue, the more so the farther they are from it;
// at 1 the picture shows as it is. `picture_id` names an element that backdrop() made of it, so
// that many figures share one picture.
Html overlay(const Overlay& overlay, const std::string& picture_id);

// The picture, not shown itself. REQUIRES: an id that is unique on the page and needs no escapes.
Html backdrop(const image::Image8& picture, const std::string& id);

// What colours of overlays mean.
Html overlay_key(const std::string& low, const std::string& even, const std::string& high);

}  // namespace delray::apps::report
