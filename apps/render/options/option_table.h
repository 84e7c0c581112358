// The options of `delray render` as rows, in the order of the help page; a new one is a row here.
#pragma once

#include <vector>

#include "apps/options/option_row.h"
#include "apps/render/options/render_options.h"

namespace delray::apps {

using RenderOption = OptionRow<RenderRequest>;

std::vector<RenderOption> picture_options();
std::vector<RenderOption> layout_options();  // see frame_layout.h
std::vector<RenderOption> animation_options();
std::vector<RenderOption> rasterizer_options();
std::vector<RenderOption> pack_options();
std::vector<RenderOption> raytracer_options();  // see raytracer_options.cpp
std::vector<RenderOption> sampling_options();   // see sampling_options.h
std::vector<RenderOption> output_options();

}  // namespace delray::apps
