// LAS 1.0 to 1.4 (ASPRS), point formats 0 to 10, and LAZ, formats 0 to 3 and 6 to 8.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "delaunay/files/las_header.h"
#include "delaunay/files/laz/laz_file.h"
#include "delaunay/files/point_readers.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

// Degrees need finer steps than metres: where a file tells nothing, steps a hundred times finer in
// x and y than in z give them away.
bool steps_like_degrees(const LasHeader& header, const std::vector<glm::dvec3>& positions) {
  constexpr double kFinest = 1e-5, kFiner = 100;
  const double across = std::max(std::abs(header.scale.x), std::abs(header.scale.y));
  if (across > kFinest || across * kFiner > std::abs(header.scale.z)) return false;
  return std::ranges::all_of(
      positions, [](const glm::dvec3& p) { return std::abs(p.x) <= 180 && std::abs(p.y) <= 90; });
}

// Colours are 16 bits a channel, but many files hold 8-bit values there.
void narrow_colours(const std::vector<glm::u16vec3>& wide, std::vector<glm::u8vec4>& colours) {
  std::uint16_t top = 0;
  for (const glm::u16vec3& c : wide) top = std::max({top, c.r, c.g, c.b});
  const std::uint16_t divisor = top > 255 ? 257 : 1;
  colours.resize(wide.size());
  for (std::size_t i = 0; i < wide.size(); ++i) {
    const glm::uvec3 rounded =
        (glm::uvec3(wide[i]) + glm::uvec3(divisor / 2)) / glm::uvec3(divisor);
    colours[i] = glm::u8vec4(glm::u8vec3(rounded), 255);
  }
}

// The attributes of points while they are read, one of each per point.
struct LasPoints {
  PointCloud cloud;
  std::vector<glm::u16vec3> colours;  // or none

  explicit LasPoints(const LasHeader& header)
      : colours(header.format.colour > 0 ? header.count : 0) {
    cloud.has_z = true;
    cloud.positions.resize(header.count);
    cloud.intensity.resize(header.count);
    cloud.classification.resize(header.count);
  }
};

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// Reads `count` records into the points from `first` on. Returns the first point that is not
// finite, or kNone.
std::size_t read_records(const LasHeader& header, std::string_view records, std::size_t first,
                         std::size_t count, LasPoints& points) {
  std::size_t bad = kNone;
  for (std::size_t i = 0; i < count; ++i) {
    const char* record = records.data() + i * header.record_size;
    glm::dvec3& position = points.cloud.positions[first + i];
    for (int k = 0; k < 3; ++k) {
      const double steps = laz::load<std::int32_t>(record + 4 * k);
      position[k] = steps * header.scale[k] + header.offset[k];
      if (!std::isfinite(position[k])) bad = std::min(bad, first + i);
    }
    points.cloud.intensity[first + i] =
        static_cast<float>(laz::load<std::uint16_t>(record + kLasIntensity)) / 65535.0F;
    points.cloud.classification[first + i] =
        laz::load<std::uint8_t>(record + header.format.classification) & header.format.class_mask;
    if (!points.colours.empty()) {
      points.colours[first + i] = laz::load<glm::u16vec3>(record + header.format.colour);
    }
  }
  return bad;
}

std::size_t least(std::size_t a, std::size_t b) { return std::min(a, b); }

std::size_t read_uncompressed(const Input& input, const LasHeader& header, LasPoints& points) {
  constexpr std::size_t kGrain = 16384;  // about 0.2 ms
  return parallel::parallel_reduce(
      0, header.count, kGrain, kNone,
      [&](std::size_t first, std::size_t last) {
        const std::size_t byte = header.points_begin + first * header.record_size;
        return read_records(header, input.content.substr(byte), first, last - first, points);
      },
      &least);
}

std::size_t read_compressed(const Input& input, const LasHeader& header, const laz::LazFile& file,
                            LasPoints& points) {
  std::atomic<std::size_t> damaged = kNone;
  const std::size_t bad = parallel::parallel_reduce(
      0, file.chunks.size(), 1, kNone,
      [&](std::size_t first, std::size_t last) {
        laz::ChunkDecoder decoder(file);
        std::size_t first_bad = kNone;
        for (std::size_t i = first; i < last; ++i) {
          const laz::Chunk& chunk = file.chunks[i];
          const std::string_view records = decoder.decode(chunk);
          if (records.empty()) {
            std::size_t seen = damaged;
            while (i < seen && !damaged.compare_exchange_weak(seen, i)) {
            }
            continue;
          }
          first_bad =
              std::min(first_bad, read_records(header, records, chunk.first, chunk.count, points));
        }
        return first_bad;
      },
      &least);
  if (damaged != kNone) {
    const laz::Chunk& chunk = file.chunks[damaged];
    fail(input, "chunk " + std::to_string(damaged),
         "is damaged: its " + std::to_string(chunk.bytes.size()) + " bytes do not hold " +
             std::to_string(chunk.count) + " points");
  }
  return bad;
}

}  // namespace

PointCloud read_las_points(const Input& input) {
  const LasHeader header = parse_las_header(input);
  input.require_points(header.count);
  const laz::LazFile file = header.compressed ? laz::parse_laz_file(input, header) : laz::LazFile{};
  LasPoints points(header);
  const std::size_t bad = header.compressed ? read_compressed(input, header, file, points)
                                            : read_uncompressed(input, header, points);
  if (bad != kNone) fail(input, "point " + std::to_string(bad), "not a finite number");
  PointCloud& cloud = points.cloud;
  narrow_colours(points.colours, cloud.colours);
  const files::GeoKeys keys = read_las_geo_keys(input, header);
  cloud.geographic = keys.known ? keys.geographic : steps_like_degrees(header, cloud.positions);
  return std::move(cloud);
}

}  // namespace delray::delaunay
