// Pictures too large for the memory, rendered and written band by band.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/render/render_frames.h"
#include "apps/session.h"

namespace delray::apps {

// Rows of the lowest band, but for the last: those of a row of tiles in the file.
inline constexpr int kLeastBand = 128;

// Bytes that the libraries take that write a picture of that suffix, once they are loaded; a PNG is
// written without them.
std::uint64_t writer_bytes(const std::string& output);

// Whether the picture may be made in bands: a single one, of a format that is written so, of which
// pixels do not depend on those of other bands.
bool comes_in_bands(const RenderRequest& request);

// The bands that the picture is made in, from the top; all of it where that fits the memory that is
// left. Of a wall in one file at most a row of displays, and in any format that wants it at once.
// As rank 0 finds it. Collective.
std::vector<geometry::Rect> choose_bands(comm::Communicator& communicator,
                                         const RenderRequest& request);

// The picture in its file, and what it took.
struct BandedPicture {
  Frames frames;          // without a picture; times are of all bands
  std::string hash;       // as of one that is made at once
  bool is_empty = false;  // nothing of the scene is in view
  double write_seconds = 0;
};

// Collective; the file is rank 0's, whole or not at all.
BandedPicture render_bands(comm::Communicator& communicator, const Prepared& prepared,
                           const RenderRequest& request, const Session& session,
                           parallel::Progress* progress, const std::vector<geometry::Rect>& bands);

}  // namespace delray::apps
