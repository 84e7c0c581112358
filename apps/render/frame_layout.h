// What of a frame is written, and in how many files: all of it, a crop, or the displays of a wall.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/rect.h"
#include "loadbalance/wall.h"

namespace delray::apps {

struct RenderRequest;

// Pixels of a frame in either direction.
inline constexpr int kLargestSide = 32768;

struct FrameLayout {
  std::string crop;   // x,y,width,height
  std::string grid;   // COLUMNSxROWS
  std::string bezel;  // PIXELS, or PIXELSxPIXELS
  bool one_file = false, draw_at_home = false;

  // Set by complete_layout:
  std::optional<loadbalance::Wall> wall;

  // Whether every display is a file of the rank that shows it.
  bool has_displays() const { return wall && !one_file; }
};

// Sets the window by --crop, or the wall by --wall, of which --size is that of a display; the frame
// is then as large as the wall. Throws UsageError. REQUIRES: the size is parsed.
void complete_layout(RenderRequest& request);

// The file of a display: "wall.png" gives "wall-2-0.png" for that of column 2 in row 0.
std::string display_path(const std::string& output, int column, int row);

}  // namespace delray::apps
