// Damage in PNG files, found before libpng finds it: libpng writes to standard error itself.
#pragma once

#include <OpenImageIO/filesystem.h>

#include <string>

namespace delray::image::openimageio {

// The fault of the file up to its pixels, in words that follow its name; empty: nothing.
// O(bytes before the pixels).
std::string png_header_fault(OIIO::Filesystem::IOProxy& file);

// The fault of the file up to the end of its pixels, which are unpacked row by row and
// forgotten. O(bytes of pixels); memory for a row.
std::string png_pixels_fault(OIIO::Filesystem::IOProxy& file);

}  // namespace delray::image::openimageio
