// Everything that the tables and options allow together: tests, benchmarks and reports run it.
#pragma once

#include <string>
#include <vector>

#include "raster/render.h"

namespace delray::raster {

// All ways to share out the work among ranks, in the order of the tables: strategies with their
// partitions, schemes, codecs, schedules, and whatever else decides who does what. The rest, such
// as size and lighting, is that of `base`. None of them changes the picture.
std::vector<RenderOptions> combinations(const RenderOptions& base);

// "sort-first/mahd/numbers/stealing". REQUIRES: a strategy of the table.
std::string name_of(const RenderOptions& options);

}  // namespace delray::raster
