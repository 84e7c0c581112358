// One picture file open for reading: format found, header checked, rows delivered top first.
#pragma once

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/openimageio/codec.h"
#include "image/openimageio/png_faults.h"

namespace delray::image::openimageio {

// Errors are files::FileError (input) with the file's name.
class InputFile {
 public:
  // REQUIRES: the bytes of `from` outlive the object.
  explicit InputFile(const Encoded& from);

  const OIIO::ImageSpec& spec() const { return spec_; }
  const std::string& format() const { return format_; }
  [[noreturn]] void fail(const std::string& what) const;
  // Throws FileError (memory) unless there is room for a result of `bytes` for each of `pixels`,
  // and for what reading takes besides.
  void require_memory(std::uint64_t pixels, std::size_t bytes) const;

  // Calls visit(y, rows, values) for blocks of rows from the top, y counted from 0 in the data
  // window; `values` are rows * width * channels, interleaved, of OpenImageIO's type `type`, which
  // is T's.
  template <class T, class Visit>
  void read(OIIO::TypeDesc type, Visit&& visit) {
    check_png(png_pixels_fault);
    const int step = rows_per_block();
    std::vector<T> block(static_cast<std::size_t>(std::min(step, spec_.height)) *
                         static_cast<std::size_t>(spec_.width) *
                         static_cast<std::size_t>(spec_.nchannels));
    for (int y = 0; y < spec_.height; y += step) {
      const int rows = std::min(step, spec_.height - y);
      read_rows(y, rows, type, block.data());
      visit(y, rows, block.data());
    }
  }

 private:
  void open(const std::string& name, const OIIO::ImageSpec& hints);
  [[noreturn]] void fail_as_damaged() const;  // with the reader's reason
  void check_png(std::string (*fault)(OIIO::Filesystem::IOProxy&)) const;  // of others nothing
  void check_canvas(std::string_view start) const;
  void check_size(std::uint64_t width, std::uint64_t height, std::uint64_t pixel_bytes) const;
  void check_header() const;
  int rows_per_block() const;
  void read_rows(int y, int rows, OIIO::TypeDesc type, void* values);

  std::string name_, format_;
  files::MemoryBudget budget_;
  std::unique_ptr<OIIO::Filesystem::IOMemReader> bytes_;  // outlives input_
  std::unique_ptr<OIIO::ImageInput> input_;
  OIIO::ImageSpec spec_;
};

}  // namespace delray::image::openimageio
