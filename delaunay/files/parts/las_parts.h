// LAS, LAZ and COPC in parts: runs of records, or of chunks.
#pragma once

#include <optional>

#include "delaunay/files/las_header.h"
#include "delaunay/files/laz/laz_file.h"
#include "delaunay/files/parts/file_parts.h"

namespace delray::delaunay {

class LasParts : public FileParts {
 public:
  // Reads the header and the table of chunks; of an octree only nodes that `filter` needs are
  // parts. Throws FileError.
  LasParts(ByteSource source, const PointFilter& filter);

  std::size_t parts() const override { return runs_.size(); }
  std::uint64_t most_rows(std::size_t part) const override;
  void read(std::size_t part, PartPoints& points) const override;

 private:
  struct Run {
    std::size_t first, last;  // chunks of LAZ, else records
  };
  void cut_chunks();
  void cut_records();
  void tell(const std::optional<struct CopcOctree>& octree);
  // Reads records of the points from number `first` on to the end of `points`.
  void append(std::string_view records, std::size_t first, std::size_t count,
              PartPoints& points) const;

  ByteSource source_;
  LasHeader header_;
  std::optional<laz::LazFile> laz_;
  std::vector<Run> runs_;
};

}  // namespace delray::delaunay
