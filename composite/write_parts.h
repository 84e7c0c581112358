// A finished picture into one file, by all ranks at a time: nothing is gathered.
#pragma once

#include <filesystem>

#include "comm/communicator.h"
#include "composite/layer.h"

namespace delray::composite {

// Every rank writes the pixels that it owns, wherever they lie, into one OpenEXR file: scan lines
// that are not compressed, linear premultiplied colour and depth in floats (channels A, B, G, R and
// Z), so that the place of each pixel in the file is known beforehand. 20 bytes per pixel.
//
// The parts are those of a scheme, not gathered, of layers with a colour and depth (ImageLayer),
// and all have the size of the picture. Collective; all ranks have to see the same file system. The
// file appears whole or not at all. Errors: what comm::agree_on_failure throws, on all ranks, for a
// files::FileError (device) of any. REQUIRES: width, height >= 1.
void write_parts(comm::Communicator& communicator, const OwnedPixels& part,
                 const std::filesystem::path& path);

}  // namespace delray::composite
