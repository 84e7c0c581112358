// --legend: what the colours of a picture tell.
#pragma once

#include "image/image.h"
#include "scenes/scene.h"

namespace delray::apps {

// Draws a box with the title and a bar with five values, or a square for each class, into the lower
// left corner; of classes as many as there is room for, and how many more there are; of a number
// that is everywhere the same that alone. Letters are 13 pixels high, or twice that and so on in
// pictures of more than 1000 rows. False, and nothing, where the picture is too small. Depths stay.
bool draw_legend(const scenes::ColourScale& scale, image::Image8& picture);
bool draw_legend(const scenes::ColourScale& scale, image::ImageF& picture);

}  // namespace delray::apps
