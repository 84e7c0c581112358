// The identity of a finished picture.
#pragma once

#include <memory>
#include <string>

#include "image/image.h"

namespace delray::image {

// XXH3-128 of the RGBA bytes, top row first, as 32 lower-case hex digits, high half first. Depth
// and size do not enter. O(pixels) at memory speed.
std::string hash(const Image8& image);

// The same of a picture that comes in parts, from top to bottom.
class PictureHash {
 public:
  PictureHash();
  ~PictureHash();
  PictureHash(const PictureHash&) = delete;
  PictureHash& operator=(const PictureHash&) = delete;

  void append(const Image8& rows);
  std::string text() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace delray::image
