// Compares text that is read in parts with text that is read whole.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "delaunay/files/parts/text_parts.h"
#include "delaunay/files/point_readers.h"

namespace delray::tests {

struct PartsComparison {
  bool cut = false;  // it was not read whole anyway
  bool same = true;  // points and complaint
};

// Whether ranges of so many bytes give the points, or the complaint, of all of the text.
inline PartsComparison compare_with_parts(std::string_view text, std::uint64_t range_bytes) {
  struct Outcome {
    delaunay::PointCloud cloud;
    std::string complaint;
  };
  const auto outcome_of = [](auto&& read) {
    Outcome outcome;
    try {
      outcome.cloud = read();
    } catch (const files::FileError& error) {
      outcome.complaint = error.what();
    }
    return outcome;
  };
  const delaunay::Input input{"text", text};
  bool whole_only = false;
  const Outcome parts = outcome_of([&] {
    const auto file = delaunay::open_text_parts(delaunay::ByteSource(input), range_bytes);
    whole_only = file == nullptr;
    return whole_only ? delaunay::PointCloud{} : read_all(*file, {}, input.memory);
  });
  if (whole_only) return {};
  const Outcome whole = outcome_of([&] { return delaunay::read_text_points(input); });
  const bool same =
      parts.complaint == whole.complaint && parts.cloud.positions == whole.cloud.positions &&
      parts.cloud.colours == whole.cloud.colours &&
      parts.cloud.intensity == whole.cloud.intensity &&
      parts.cloud.classification == whole.cloud.classification &&
      parts.cloud.warnings == whole.cloud.warnings && parts.cloud.has_z == whole.cloud.has_z;
  return {true, same};
}

}  // namespace delray::tests
