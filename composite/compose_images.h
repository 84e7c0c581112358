// Images in memory on every rank become one: all that most callers need.
#pragma once

#include <memory>
#include <string_view>

#include "comm/communicator.h"
#include "composite/image_layer.h"
#include "composite/scheme.h"
#include "image/image.h"

namespace delray::composite {

// Options of compositing images: how they travel, and to which rank.
struct ImageOptions {
  Operator how = Operator::nearest;
  std::string_view scheme = "radix-k";  // with radices, if any: see choose_scheme
  std::string_view codec = "active";
  bool interlace = false;
  int root = 0;
};

// The images of all ranks merged, whole on rank `root`; elsewhere an image of no pixels. Where the
// operator is `over`, depths of the result are those of root's own image.
//
// Collective over `communicator`: of delray's own, or one made over the caller's MPI communicator
// (comm::make_mpi_communicator). All ranks throw std::invalid_argument for schemes, codecs and
// roots that do not exist, sizes that differ and buffers that are not there. REQUIRES: no
// depth is NaN, a pixel that nothing covers has kEmptyDepth and, like one that is not there for
// `over`, the colour {}.
template <class Colour>
image::BasicImage<Colour> compose_images(comm::Communicator& communicator,
                                         image::BasicImage<Colour>&& image,
                                         const ImageOptions& options = {});

extern template image::Image8 compose_images(comm::Communicator&, image::Image8&&,
                                             const ImageOptions&);
extern template image::ImageF compose_images(comm::Communicator&, image::ImageF&&,
                                             const ImageOptions&);

// Pixels in somebody else's memory: row-major planes without gaps, of width * height elements.
template <class Colour>
struct ImageBuffers {
  int width = 0, height = 0;
  const Colour* colour = nullptr;
  const float* depth = nullptr;  // null: none, for `over`
};

// Composites a copy, for which the renderer's own value of empty depth, such as 1, becomes
// kEmptyDepth, and the colours there {}.
template <class Colour>
image::BasicImage<Colour> compose_images(comm::Communicator& communicator,
                                         const ImageBuffers<Colour>& buffers, float empty_depth,
                                         const ImageOptions& options = {});

extern template image::Image8 compose_images(comm::Communicator&, const ImageBuffers<image::Rgba8>&,
                                             float, const ImageOptions&);
extern template image::ImageF compose_images(comm::Communicator&, const ImageBuffers<image::RgbaF>&,
                                             float, const ImageOptions&);

}  // namespace delray::composite
