// Points as a pack, in bounded memory.
#pragma once

#include "apps/input/scene_input.h"
#include "packs/pack_writer.h"

namespace delray::apps {

// Whether the input is files of points that options show as points: memory need not hold them.
// Where the points themselves decide (no --show-as) all of them have to be looked at together.
// Throws UsageError and FileError.
bool is_cloud(const SceneInput& input);

// Writes the pack that load_scene() and write_pack() would make of the points, byte for byte, from
// parts of them as the readers cut their files. Memory: a part for each thread, then a bucket of
// points along the curve that orders them (scenes/point_order.h), which is the smaller the less
// there is; on disk, beside the output, 20 bytes a point. The files are read three times, four
// where there are outliers, and once more where all of a file tells how an attribute is to be read.
//
// Throws FileError (input), (memory), (device); UsageError for colours of attributes that the
// points do not have. REQUIRES: is_cloud.
void pack_points(const SceneInput& input, const std::string& output,
                 const packs::WriteOptions& options, parallel::Progress* progress);

}  // namespace delray::apps
