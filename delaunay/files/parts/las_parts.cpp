// LAS 1.0 to 1.4 (ASPRS), point formats 0 to 10, and LAZ, formats 0 to 3 and 6 to 8, in parts of
// some 65 536 points. Every part is read by itself: of LAZ its chunks are decoded.
#include "delaunay/files/parts/las_parts.h"

#include <algorithm>
#include <cmath>

#include "delaunay/files/parts/copc.h"

namespace delray::delaunay {
namespace {

// Large enough that reading and starting a part do not count, small enough for memory.
constexpr std::size_t kLasPartRows = 65536;

// Degrees need finer steps than metres: where a file tells nothing, steps a hundred times finer in
// x and y than in z give them away.
bool steps_like_degrees(const LasHeader& header) {
  constexpr double kFinest = 1e-5, kFiner = 100;
  const double across = std::max(std::abs(header.scale.x), std::abs(header.scale.y));
  return across <= kFinest && across * kFiner <= std::abs(header.scale.z);
}

}  // namespace

LasParts::LasParts(ByteSource source, const PointFilter& filter)
    : source_(std::move(source)), header_(parse_las_header(source_)) {
  std::optional<CopcOctree> octree;
  if (header_.compressed) {
    laz_ = laz::parse_laz_file(source_, header_);
    octree = parse_copc(source_, header_);
    if (octree && (filter.bounds || filter.resolution > 0) && !laz_->chunks.empty()) {
      laz_->chunks = wanted_chunks(source_, *octree, std::move(laz_->chunks), filter);
    }
    cut_chunks();
  } else {
    cut_records();
  }
  tell(octree);
}

void LasParts::cut_chunks() {
  std::size_t points = 0;
  for (std::size_t i = 0; i < laz_->chunks.size(); ++i) {
    const std::size_t count = laz_->chunks[i].count;
    if (runs_.empty() || points + count > kLasPartRows) {
      runs_.push_back({i, i});
      points = 0;
    }
    runs_.back().last = i + 1;
    points += count;
  }
}

void LasParts::cut_records() {
  for (std::size_t first = 0; first < header_.count; first += kLasPartRows) {
    runs_.push_back({first, std::min(header_.count, first + kLasPartRows)});
  }
}

void LasParts::tell(const std::optional<CopcOctree>& octree) {
  const files::GeoKeys keys = read_las_geo_keys(source_, header_);
  facts_.has_z = facts_.has_classes = facts_.has_returns = true;
  facts_.has_nodes = octree.has_value();
  facts_.geographic = keys.known && keys.geographic;
  facts_.degrees_if_within = !keys.known && steps_like_degrees(header_);
  facts_.has_ranges = header_.format.colour > 0 || facts_.degrees_if_within;
  PointFileFacts& told = facts_.told;
  told.file = source_.name();
  told.format = "LAS";
  told.version = "1." + std::to_string(header_.minor);
  told.point_format = static_cast<int>(header_.format_number);
  told.compression = octree ? "COPC" : laz_ ? "LAZ" : "";
  told.scale = header_.scale;
  told.offset = header_.offset;
  told.coordinate_system = keys.name;
  told.epsg = keys.epsg;
}

std::uint64_t LasParts::most_rows(std::size_t part) const {
  const Run& run = runs_[part];
  if (!laz_) return run.last - run.first;
  std::uint64_t points = 0;
  for (std::size_t i = run.first; i < run.last; ++i) points += laz_->chunks[i].count;
  return points;
}

void LasParts::append(std::string_view records, std::size_t first, std::size_t count,
                      PartPoints& points) const {
  const std::size_t begin = points.cloud.size(), end = begin + count;
  const bool coloured = header_.format.colour > 0;
  points.cloud.positions.resize(end);
  points.cloud.intensity.resize(end);
  points.cloud.classification.resize(end);
  points.cloud.returns.resize(end);
  constexpr float kFullIntensity = 65535;
  points.cloud.intensity_unit = kFullIntensity;
  if (coloured) points.colours.resize(end);
  std::size_t bad = count;
  for (std::size_t i = count; i-- > 0;) {
    const char* record = records.data() + i * header_.record_size;
    glm::dvec3& position = points.cloud.positions[begin + i];
    for (int k = 0; k < 3; ++k) {
      const double steps = laz::load<std::int32_t>(record + 4 * k);
      position[k] = steps * header_.scale[k] + header_.offset[k];
    }
    if (!std::isfinite(position.x + position.y + position.z) &&
        !(std::isfinite(position.x) && std::isfinite(position.y) && std::isfinite(position.z))) {
      bad = i;
    }
    points.cloud.intensity[begin + i] =
        static_cast<float>(laz::load<std::uint16_t>(record + kLasIntensity)) / kFullIntensity;
    points.cloud.classification[begin + i] =
        laz::load<std::uint8_t>(record + header_.format.classification) & header_.format.class_mask;
    const auto returns = laz::load<std::uint8_t>(record + kLasReturns);
    // The formats before 6 have three bits for each number.
    points.cloud.returns[begin + i] =
        header_.format_number >= 6
            ? returns
            : static_cast<std::uint8_t>((returns & 7) | (returns >> 3 & 7) << 4);
    if (coloured) {
      points.colours[begin + i] = laz::load<glm::u16vec3>(record + header_.format.colour);
    }
  }
  if (bad < count) {
    fail(source_.input(), "point " + std::to_string(first + bad), "not a finite number");
  }
}

void LasParts::read(std::size_t part, PartPoints& points) const {
  points = {};
  points.cloud.has_z = true;
  const Run& run = runs_[part];
  std::string buffer;
  if (!laz_) {
    const std::string_view records =
        source_.read(header_.points_begin + run.first * header_.record_size,
                     (run.last - run.first) * header_.record_size, buffer);
    append(records, run.first, run.last - run.first, points);
    return;
  }
  laz::ChunkDecoder decoder(*laz_);
  for (std::size_t i = run.first; i < run.last; ++i) {
    const laz::Chunk& chunk = laz_->chunks[i];
    // A few bytes may stand for many points.
    constexpr std::size_t kBytesPerPoint = 48;
    if (chunk.count > 16 * kLasPartRows) {
      source_.memory().require(chunk.count * (header_.record_size + kBytesPerPoint),
                               source_.name());
    }
    const std::string_view records =
        decoder.decode(source_.read(chunk.begin, chunk.size, buffer), chunk.count);
    if (records.empty()) {
      fail(source_.input(), "chunk " + std::to_string(chunk.number),
           "is damaged: its " + std::to_string(chunk.size) + " bytes do not hold " +
               std::to_string(chunk.count) + " points");
    }
    append(records, chunk.first, chunk.count, points);
  }
}

}  // namespace delray::delaunay
