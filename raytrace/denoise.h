// Smoothing of noise that keeps edges: the edge-avoiding a-trous wavelet transform (Dammertz et al.
// 2010), led by what pixels show and by how noisy they are (Schied et al. 2017).
#pragma once

#include <span>

#include "image/image.h"
#include "raytrace/features.h"

namespace delray::raytrace {

// How far and how strongly a picture is smoothed.
struct DenoiseOptions {
  int levels = 4;         // each looks twice as far as the one before: 2 pixels, 4, 8 ...
  float strength = 2.1F;  // differences up to so many standard deviations are taken for noise
};

// Replaces colours by means over neighbours that show the same: that have similar normals, depths,
// albedos, and light that differs by no more than its noise would have it. Textures stay sharp, as
// the light alone is smoothed; alpha and depth stay as they are, and so do pixels that nothing
// covers. Channels stay within the range that they had within two pixels, and the picture keeps its
// energy. A picture without noise (variance 0) does not change but for roundings.
//
// `variance` is that of the mean of each pixel's luminance; empty: it is not known. Parallel;
// O(levels * 48 * pixels).
// REQUIRES: features and variance are of the picture's size; nothing is NaN.
void denoise(image::ImageF& picture, const Features& features, std::span<const float> variance,
             const DenoiseOptions& options = {});

}  // namespace delray::raytrace
