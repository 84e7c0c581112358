// PCD in parts: ranges of lines of ASCII, runs of records of binary files; compressed ones, which
// hold one field after the other, are a single part.
#pragma once

#include <array>
#include <optional>

#include "delaunay/files/parts/byte_source.h"
#include "delaunay/files/parts/file_parts.h"
#include "delaunay/files/parts/pcd_header.h"
#include "delaunay/files/parts/text_parts.h"

namespace delray::delaunay {

// Points without coordinates (not a number), of which organised clouds are full, are left out.
class PcdParts : public FileParts {
 public:
  // Throws FileError.
  explicit PcdParts(ByteSource source);

  std::size_t parts() const override;
  std::uint64_t most_rows(std::size_t part) const override;
  std::uint64_t row_bound(std::size_t part) const override;
  void read(std::size_t part, PartPoints& points) const override;

 private:
  // Points under construction.
  struct Rows;
  void check_size() const;
  void check_lines() const;
  void read_lines(std::size_t range, Rows& rows) const;
  void read_records(std::size_t part, Rows& rows) const;
  void read_compressed(Rows& rows) const;

  ByteSource source_;
  PcdHeader header_;
  std::optional<LineRanges> lines_;  // of ASCII
};

}  // namespace delray::delaunay
