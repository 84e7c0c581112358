// Reads one file, whole, by opening it in parts.
#include "delaunay/read_points.h"

#include "delaunay/files/parts/file_parts.h"
#include "delaunay/files/point_readers.h"

namespace delray::delaunay {

std::span<const PointReader> point_readers() { return kPointReaders; }

PointCloud read_points(const std::filesystem::path& path, const ReadOptions& options) {
  const std::unique_ptr<FileParts> file = open_file_parts(path, {}, options);
  PointCloud cloud = read_all(*file, {}, options.memory);
  if (cloud.size() == 0) refuse_no_points({&file->facts().told, 1}, {});
  return cloud;
}

}  // namespace delray::delaunay
