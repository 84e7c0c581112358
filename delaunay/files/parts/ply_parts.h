// Binary PLY in parts: runs of vertices of fixed size.
#pragma once

#include <memory>

#include "delaunay/files/parts/byte_source.h"
#include "delaunay/files/parts/file_parts.h"

namespace delray::delaunay {

// Null for what has to be looked at whole: ASCII, vertices with lists or behind elements with such,
// and headers that are broken or announce more than the file holds.
std::unique_ptr<FileParts> open_ply_parts(const ByteSource& source);

}  // namespace delray::delaunay
