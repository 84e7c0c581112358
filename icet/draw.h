// Drawing a frame: what icetDrawFrame and icetCompositeImage have in common, for others that draw.
#pragma once

#include <functional>

#include "icet/context.h"
#include "icet/interface.h"

namespace delray::icet {

// Matrices and colour of a frame, as the interface has them: columns first; null matrices tell
// nothing of where something is drawn.
struct View {
  const IceTDouble* projection = nullptr;
  const IceTDouble* modelview = nullptr;
  const IceTFloat* background = nullptr;  // 0 to 1
};

// Draws an image as a callback of the interface does.
using DrawFunction =
    std::function<void(const IceTDouble* projection, const IceTDouble* modelview,
                       const IceTFloat* background, const IceTInt* readback, IceTImage result)>;

// One frame, by a function that draws. The result is null on ranks without valid pixels; it is the
// context's, until the next frame. Collective: what one rank throws, Error or anything else that
// the function throws, ends the frame on all. REQUIRES: no frame is being drawn.
IceTImage draw_frame(Context& context, const View& view, const DrawFunction& draw);

}  // namespace delray::icet
