// One file of points in parts: what the readers of parts give, and what is made of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "delaunay/point_filter.h"
#include "delaunay/points.h"
#include "delaunay/read_points.h"
#include "delaunay/summarize_points.h"

namespace delray::delaunay {

// The points of a part as they stand in the file. Attributes whose range only all of a file tells
// are not scaled yet.
struct PartPoints {
  PointCloud cloud;                   // intensity of any range
  std::vector<glm::u16vec3> colours;  // of 16 bits, or of 8 in 16; else cloud.colours
  bool whole_colours = true;          // unnamed columns of text: else they are no colours
  std::size_t left_out = 0;           // rows without coordinates, where the format has such

  std::size_t size() const { return cloud.size(); }
};

// What all points of a file tell about the attributes of each, or the first part's, where points
// are read part by part.
struct AttributeRanges {
  std::uint16_t colour = 0;    // greatest value of a 16-bit channel
  float intensity = 1;         // greatest, or 1
  bool whole_colours = true;   // see PartPoints
  bool within_degrees = true;  // x and y can be longitude and latitude

  void include(const PartPoints& points);
  void include(const AttributeRanges& other);
};

// What a file says besides its points.
struct FileFacts {
  PointFileFacts told;  // for the user
  bool has_z = false;
  bool has_classes = false, has_returns = false, has_nodes = false;  // what a filter can ask for
  bool geographic = false;
  bool degrees_if_within = false;  // geographic if AttributeRanges says that they can be
  bool has_ranges = false;         // AttributeRanges decide about something
  std::vector<std::string> warnings;
};

// A file that is open for reading. Everything from any thread.
class FileParts {
 public:
  virtual ~FileParts() = default;
  const FileFacts& facts() const { return facts_; }
  void tell_format(std::string_view name) { facts_.told.format = name; }
  virtual std::size_t parts() const = 0;
  // At least as many rows as read() gives. REQUIRES: part < parts().
  virtual std::uint64_t most_rows(std::size_t part) const = 0;
  // The same without reading anything; for text far too many.
  virtual std::uint64_t row_bound(std::size_t part) const { return most_rows(part); }
  // Replaces `points` by those of the part. Throws FileError. REQUIRES: part < parts().
  virtual void read(std::size_t part, PartPoints& points) const = 0;

 protected:
  FileFacts facts_;
};

// Keeps the points that the filter wants. O(points).
void apply_filter(const PointFilter& filter, PartPoints& points);

// Scales attributes, and says whether the points are in degrees.
void finish_points(const FileFacts& facts, const AttributeRanges& ranges, PartPoints& points);

// A warning of PointCloud.
std::string points_left_out(std::size_t points);

// Throws FileError (input), as there are no points in `files` that the filter keeps.
[[noreturn]] void refuse_no_points(std::span<const PointFileFacts> files,
                                   const PointFilter& filter);

// All points of a file, its parts read in parallel. Of several errors that of the first part is
// thrown, FileError (memory) where there is no room.
PointCloud read_all(const FileParts& file, const PointFilter& filter,
                    const files::MemoryBudget& memory);

// Opens a file or stream by its format, which the options or the file tell. The table of formats is
// in open_file_parts.cpp; what none of its readers can cut becomes one part that is held in memory.
// Throws FileError, and std::invalid_argument where the filter asks for what the file does not
// have.
std::unique_ptr<FileParts> open_file_parts(const std::filesystem::path& path,
                                           const PointFilter& filter, const ReadOptions& options);

}  // namespace delray::delaunay
