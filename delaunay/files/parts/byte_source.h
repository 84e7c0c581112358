// The bytes of an input of points of which only ranges are wanted at a time.
#pragma once

#include <string>
#include <string_view>

#include "delaunay/files/input.h"
#include "files/file_bytes.h"

namespace delray::delaunay {

class ByteSource : public files::FileBytes {
 public:
  using FileBytes::FileBytes;
  // REQUIRES: the content outlives the source.
  explicit ByteSource(const Input& input) : FileBytes(input.name, input.content, input.memory) {}

  // For messages, and for memory that is asked for.
  Input input(std::string_view content = {}) const { return {name(), content, memory()}; }
};

}  // namespace delray::delaunay
