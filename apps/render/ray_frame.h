// One frame by rays, pass by pass, with all that the sampling options ask for.
#pragma once

#include <functional>
#include <vector>

#include "apps/render/render_frames.h"
#include "image/io.h"

namespace delray::apps {

// Shows a picture that is not yet done, on rank 0.
using Preview = std::function<void(Picture&& picture)>;

// What looks at a picture while it is made; both may be left out.
struct Onlookers {
  Preview preview;           // as often as the options want it
  Growth* growth = nullptr;  // after every pass
};

// On rank 0; elsewhere all but the statistics and the displays is empty.
struct RayFrame {
  image::ImageF picture;             // of the window; of size 0 where there are displays
  std::vector<image::ImageF> shown;  // on any rank, of its displays
  raytrace::Statistics statistics;
  Extras extras;
};

// Collective. `frame` is what renderings with rays have in common.
RayFrame render_rays(comm::Communicator& communicator, raytrace::Renderer& renderer,
                     const Prepared& prepared, const RenderRequest& request,
                     const scenes::Camera& camera, const raytrace::RenderOptions& frame,
                     const Onlookers& onlookers);

}  // namespace delray::apps
