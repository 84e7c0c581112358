// The points of an input in parts, of which memory need not hold all.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "apps/input/point_input.h"
#include "delaunay/point_parts.h"

namespace delray::apps {

// The files that an input stands for, in order, and which are pictures.
struct InputFiles {
  std::vector<std::filesystem::path> paths;
  std::vector<bool> pictures;
  bool any_picture = false;
};

// Throws FileError, and UsageError where options have no effect on the files.
InputFiles find_input_files(const PointInput& input);

// Parts of files as the readers cut them; a picture is one part, whose read() takes the memory of
// all of it. Throws FileError and UsageError, also for options that have no effect on the input.
// `whole_ranges` as of delaunay::ReadOptions.
std::unique_ptr<delaunay::PointParts> open_parts(const PointInput& input,
                                                 bool whole_ranges = false);

}  // namespace delray::apps
