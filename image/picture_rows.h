// A picture that is too large to be held, written from top to bottom.
#pragma once

#include <filesystem>
#include <memory>

#include "image/image.h"
#include "image/io.h"

namespace delray::image {

// Whether PictureRows writes files of this suffix: EXR and TIFF.
bool is_written_in_rows(const std::filesystem::path& path);

// What write_image writes, in tiles of 128 x 128 pixels; a TIFF of more than 3 GiB of pixels is a
// BigTIFF. Holds up to 127 rows beside those that it is given. The file appears whole, on commit,
// or not at all. Everything throws FileError (device).
class PictureRows {
 public:
  // REQUIRES: is_written_in_rows(path); width, height >= 1; the options name no channels.
  PictureRows(const std::filesystem::path& path, int width, int height,
              const WriteOptions& options = {});
  ~PictureRows();
  PictureRows(const PictureRows&) = delete;
  PictureRows& operator=(const PictureRows&) = delete;

  // The next rows, as many as the picture has. An EXR keeps the light of an ImageF, a TIFF has the
  // 8-bit codes of either. REQUIRES: picture.width == width, and no more rows than are missing.
  void append(const Image8& rows);
  void append(const ImageF& rows);
  // REQUIRES: no row is missing.
  void commit();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace delray::image
