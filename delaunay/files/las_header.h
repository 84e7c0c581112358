// The header of a LAS or LAZ file and the records behind it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>

#include "delaunay/files/parts/byte_source.h"
#include "files/geo_keys.h"

namespace delray::delaunay {

// Where a point format keeps what is read, in bytes from the start of a record.
struct LasPointFormat {
  std::size_t size;            // smallest record
  std::size_t colour;          // three uint16; 0 if there is none
  std::size_t classification;  // one byte
  std::uint8_t class_mask;     // the formats before 6 keep flags in the upper bits
};
// All formats begin with x, y, z as int32, the intensity as uint16 and a byte with returns.
inline constexpr std::size_t kLasX = 0, kLasY = 4, kLasZ = 8, kLasIntensity = 12, kLasReturns = 14;

struct LasHeader {
  unsigned minor = 0;  // of version 1.minor
  unsigned format_number = 0;
  LasPointFormat format{};
  bool compressed = false;  // LAZ
  std::size_t size = 0;     // of the header: where records begin
  std::size_t points_begin = 0, record_size = 0, count = 0;
  std::uint64_t extended_begin = 0, extended_count = 0;  // records behind the points
  glm::dvec3 scale{1}, offset{0};
  std::string content;  // of the file before its points
};

// Throws FileError unless the header is one of LAS 1.0 to 1.4 and the points that it announces, if
// not compressed, are in the file.
LasHeader parse_las_header(const ByteSource& source);

// The content of the first variable length record of that user and number; empty if there is none.
std::string_view find_las_record(const LasHeader& header, std::string_view user, unsigned number);

// The same of the records behind the points, which LAS 1.4 has; those above `most` bytes are taken
// for none.
std::string find_extended_las_record(const ByteSource& source, const LasHeader& header,
                                     std::string_view user, unsigned number, std::uint64_t most);

// What records before and behind the points tell about coordinates.
files::GeoKeys read_las_geo_keys(const ByteSource& source, const LasHeader& header);

}  // namespace delray::delaunay
