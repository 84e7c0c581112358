// Pictures in which different things can go wrong, for tests of who shares the work how.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "raster/render.h"
#include "tests/raster/random_scene.h"

namespace delray::raster {

struct KindOfPicture {
  std::string name;
  scenes::Scene scene;
  RenderOptions options;
};

// With and without transparency, supersampling, gouraud, float pixels, shading at once; all have
// textures, holes, mirrored instances and ties of depth.
inline std::vector<KindOfPicture> kinds_of_picture(int width, int height) {
  std::vector<KindOfPicture> kinds;
  unsigned seed = 40;
  for (const bool transparent : {false, true}) {
    for (const int samples : {1, 2, 4}) {
      for (const Lighting lighting : {Lighting::phong, Lighting::gouraud}) {
        for (const bool immediate : {false, true}) {
          ++seed;
          RenderOptions options;
          options.width = width;
          options.height = height;
          options.supersampling = samples;
          options.lighting = lighting;
          options.shade = immediate ? Shade::immediate : Shade::deferred;
          options.float_pixels = seed % 3 == 0;
          options.block = 16;
          kinds.push_back(
              {std::string(transparent ? "transparent " : "opaque ") + std::to_string(samples) +
                   " samples" + (lighting == Lighting::phong ? " phong" : " gouraud") +
                   (immediate ? " immediate" : "") + (options.float_pixels ? " float" : ""),
               transparent ? transparent_scene(seed) : random_scene(seed), options});
        }
      }
    }
  }
  return kinds;
}

template <class Colour>
bool same_bytes(const image::BasicImage<Colour>& a, const image::BasicImage<Colour>& b) {
  return a.width == b.width && a.height == b.height &&
         std::memcmp(a.colour.data(), b.colour.data(), a.pixels() * sizeof(Colour)) == 0 &&
         std::memcmp(a.depth.data(), b.depth.data(), a.pixels() * sizeof(float)) == 0;
}
inline bool same_bytes(const Picture& a, const Picture& b) {
  return a.index() == b.index() &&
         std::visit(
             [&](const auto& image) {
               return same_bytes(image, std::get<std::decay_t<decltype(image)>>(b));
             },
             a);
}

}  // namespace delray::raster
