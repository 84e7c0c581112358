// Pictures of an animation made of those before (Walter et al. 1999; Larson and Simmons 1999).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "image/image.h"
#include "scenes/camera.h"

namespace delray::raytrace {

// The samples of the last frame, a sample a pixel, at the points where they met the scene. Carried
// over into another view they make most of its picture, and say which pixels have to be traced:
// where there are none, where one shows through between nearer ones or stands at a silhouette, and
// of the rest a share, the oldest first. A sample keeps the point that it was traced at, so that
// errors of its place do not add up: it is never more than about a pixel off. Pixels that would
// have to be traced beyond the share get the colour of those around, and what lies far from all
// surfaces is taken for background until its turn comes: pictures are approximations.
//
// Reflections, refractions and highlights move against the surface that shows them. Where new
// samples differ from those that were carried over to the same pixels the neighbourhood is traced
// anew in every frame, beyond the share, until they agree again. So it is where surfaces come into
// sight: pixels that nothing is known of, beside such that had to be traced for a surface in the
// frame before.
//
// Deterministic. For scenes in which nothing moves but the camera, with a sample in the centre of
// each pixel, no lens and a transparent background.
class RenderCache {
 public:
  // `share`: of the pixels of a frame that may be traced, but for the first frame and for what has
  // to be, above 0 up to 1. At least half of that share of the others may be.
  RenderCache(int width, int height, double share);

  // Which pixels of the view are to be traced, row by row: 1; all of them the first time.
  // O(pixels).
  const std::vector<std::uint8_t>& plan(const scenes::View& view);
  // Sets the pixels of the same view that were not traced, and keeps the picture for the next one.
  // O(pixels).
  void complete(const scenes::View& view, image::ImageF& picture);

  std::uint64_t traced() const { return traced_; }  // pixels of the last plan

 private:
  struct Sample {
    glm::vec3 place{0.0F};
    image::RgbaF colour{};
    std::uint32_t frame = 0;   // that traced it; 0: there is none
    bool is_doubtful = false;  // new samples around it differ from what was carried over
  };

  std::size_t tile_of(int x, int y) const;  // of judged and revealing ones
  void carry_over(const scenes::View& view);
  std::uint8_t urgency(int x, int y) const;
  void choose();
  void fill(image::ImageF& picture) const;
  std::vector<std::int8_t> judge_tiles(const image::ImageF& picture) const;
  void find_revealing_tiles(const image::ImageF& picture);

  int width_, height_;
  double share_;
  std::uint32_t frame_ = 0;
  std::vector<Sample> last_, now_;    // by pixel
  std::vector<float> depth_;          // of now_; infinity where there is none
  std::vector<std::uint8_t> trace_;   // by pixel
  std::vector<std::uint8_t> urgent_;  // by pixel: a class, the most urgent last
  // By tile of the screen: 1 where what came into sight in the last frame was a surface, or beside.
  std::vector<std::uint8_t> revealing_;
  std::uint64_t traced_ = 0;
};

}  // namespace delray::raytrace
