// Quantities that rays find besides colour: as channels of a file, and as pictures to look at.
#pragma once

#include <string>
#include <vector>

#include "image/io.h"
#include "raytrace/progressive.h"

namespace delray::apps {

// The names that --show takes: "colour", which is the picture itself, "normal", "albedo", ...
std::vector<std::string> shown_names();

// Whether features are needed for it.
bool shows_features(const std::string& name);

// All channels of a rendered window, with the names that they have in a file: normal.X .Y .Z,
// albedo.R .G .B, id.instance, id.material (-1: nothing), variance, samples, cost.rays,
// cost.seconds (per pixel).
std::vector<image::Channel> channels_of(const raytrace::ProgressiveResult& result,
                                        const geometry::Rect& window);

// A picture of a channel: normals and albedo as colours, ids as colours of their own, numbers by a
// map from nothing to what 99 % of the positive ones stay below; of variances the roots. What
// nothing covers is transparent; depth is left. Returns that number, 0 where there is none.
double show(const std::string& name, const raytrace::ProgressiveResult& result,
            const geometry::Rect& window, image::ImageF& picture);

}  // namespace delray::apps
