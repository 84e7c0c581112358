// LAS 1.0 to 1.4 (ASPRS), point formats 0 to 10, not compressed.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "delaunay/files/point_readers.h"
#include "files/geo_keys.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

// Where a point format keeps what is read, in bytes from the start of a record.
struct PointFormat {
  std::size_t size;            // smallest record
  std::size_t colour;          // three uint16; 0 if there is none
  std::size_t classification;  // one byte
  std::uint8_t class_mask;     // the formats before 6 keep flags in the upper bits
};
constexpr std::array kFormats = {
    PointFormat{20, 0, 15, 0x1f},  PointFormat{28, 0, 15, 0x1f},  PointFormat{26, 20, 15, 0x1f},
    PointFormat{34, 28, 15, 0x1f}, PointFormat{57, 0, 15, 0x1f},  PointFormat{63, 28, 15, 0x1f},
    PointFormat{30, 0, 16, 0xff},  PointFormat{36, 30, 16, 0xff}, PointFormat{38, 30, 16, 0xff},
    PointFormat{59, 0, 16, 0xff},  PointFormat{67, 30, 16, 0xff},
};

constexpr std::size_t kIntensityOffset = 12;

struct Header {
  PointFormat format;
  std::size_t points_begin = 0, record_size = 0, count = 0;
  glm::dvec3 scale, offset;
};

template <class T>
T load(std::string_view content, std::size_t byte) {
  T value;
  std::memcpy(&value, content.data() + byte, sizeof value);
  return value;
}

Header parse_header(const Input& input) {
  constexpr std::size_t kSmallest = 227, kSmallest14 = 375;
  const std::string_view content = input.content;
  if (!content.starts_with("LASF")) fail(input, at_byte(0), "does not begin with \"LASF\"");
  if (content.size() < kSmallest) fail(input, at_byte(content.size()), "the header is cut off");
  const int major = load<std::uint8_t>(content, 24), minor = load<std::uint8_t>(content, 25);
  if (major != 1 || minor > 4) {
    fail(
        input, at_byte(24),
        "LAS version " + std::to_string(major) + "." + std::to_string(minor) + " is not supported");
  }
  const unsigned number = load<std::uint8_t>(content, 104);
  if (number >= 128 || (number & 64) != 0) {
    fail(input, at_byte(104), "compressed LAS (LAZ) is not supported; decompress it first");
  }
  if (number >= kFormats.size()) {
    fail(input, at_byte(104), "unknown point format " + std::to_string(number));
  }
  Header header;
  header.format = kFormats[number];
  header.points_begin = load<std::uint32_t>(content, 96);
  header.record_size = load<std::uint16_t>(content, 105);
  header.count = load<std::uint32_t>(content, 107);
  if (minor == 4) {
    if (content.size() < kSmallest14) fail(input, at_byte(content.size()), "the header is cut off");
    if (const auto count = load<std::uint64_t>(content, 247); count != 0) header.count = count;
  }
  for (int k = 0; k < 3; ++k) {
    header.scale[k] = load<double>(content, 131 + 8 * k);
    header.offset[k] = load<double>(content, 155 + 8 * k);
    if (!std::isfinite(header.scale[k]) || !std::isfinite(header.offset[k])) {
      fail(input, at_byte(131 + 8 * k), "scale or offset is not a finite number");
    }
  }
  const std::size_t smallest = minor == 4 ? kSmallest14 : kSmallest;
  const std::size_t size = load<std::uint16_t>(content, 94);
  if (size < smallest) {
    fail(input, at_byte(94),
         "the header claims to have " + std::to_string(size) + " bytes, but takes " +
             std::to_string(smallest));
  }
  if (header.points_begin < size) fail(input, at_byte(96), "points cannot begin inside the header");
  if (header.record_size < header.format.size) {
    fail(input, at_byte(105), "records are too short for their point format");
  }
  if (header.points_begin > content.size() ||
      header.count > (content.size() - header.points_begin) / header.record_size) {
    fail(input, at_byte(107),
         "the header announces " + std::to_string(header.count) +
             " points, more than the file holds");
  }
  return header;
}

// From the records between header and points that tell about coordinates.
files::GeoKeys read_geo_keys(const Input& input, const Header& header) {
  constexpr std::size_t kUser = 2, kNumber = 18, kLength = 20, kSize = 54;  // of a record's head
  constexpr std::uint16_t kDirectory = 34735, kWellKnownText = 2112;
  files::GeoKeys keys;
  std::size_t byte = load<std::uint16_t>(input.content, 94);
  for (auto left = load<std::uint32_t>(input.content, 100); left > 0; --left) {
    if (byte + kSize > header.points_begin) break;
    const std::string_view record = input.content.substr(byte, header.points_begin - byte);
    const auto number = load<std::uint16_t>(record, kNumber);
    const std::string_view content = record.substr(kSize, load<std::uint16_t>(record, kLength));
    if (record.substr(kUser).starts_with("LASF_Projection")) {
      if (number == kDirectory) {
        std::vector<std::uint16_t> numbers(content.size() / sizeof(std::uint16_t));
        if (!numbers.empty())
          std::memcpy(numbers.data(), content.data(), numbers.size() * sizeof(std::uint16_t));
        keys = files::parse_geo_keys(numbers);
      } else if (number == kWellKnownText) {
        keys = files::parse_well_known_text(content);
      }
      if (keys.known) return keys;
    }
    byte += kSize + load<std::uint16_t>(record, kLength);
  }
  return keys;
}

// Degrees need finer steps than metres: where a file tells nothing, steps a hundred times finer in
// x and y than in z give them away.
bool steps_like_degrees(const Header& header, const std::vector<glm::dvec3>& positions) {
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

}  // namespace

PointCloud read_las_points(const Input& input) {
  const Header header = parse_header(input);
  PointCloud cloud;
  cloud.has_z = true;
  input.require_points(header.count);
  cloud.positions.resize(header.count);
  cloud.intensity.resize(header.count);
  cloud.classification.resize(header.count);
  std::vector<glm::u16vec3> colours(header.format.colour > 0 ? header.count : 0);
  constexpr std::size_t kGrain = 16384;  // about 0.2 ms
  const std::size_t bad = parallel::parallel_reduce(
      0, header.count, kGrain, header.count,
      [&](std::size_t first, std::size_t last) {
        std::size_t first_bad = header.count;
        for (std::size_t i = first; i < last; ++i) {
          const std::size_t byte = header.points_begin + i * header.record_size;
          for (int k = 0; k < 3; ++k) {
            const double steps = load<std::int32_t>(input.content, byte + 4 * k);
            const double value = steps * header.scale[k] + header.offset[k];
            if (!std::isfinite(value)) first_bad = std::min(first_bad, i);
            cloud.positions[i][k] = value;
          }
          const auto intensity = load<std::uint16_t>(input.content, byte + kIntensityOffset);
          cloud.intensity[i] = static_cast<float>(intensity) / 65535.0F;
          cloud.classification[i] =
              load<std::uint8_t>(input.content, byte + header.format.classification) &
              header.format.class_mask;
          if (!colours.empty()) {
            colours[i] = load<glm::u16vec3>(input.content, byte + header.format.colour);
          }
        }
        return first_bad;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
  if (bad < header.count) fail(input, "point " + std::to_string(bad), "not a finite number");
  narrow_colours(colours, cloud.colours);
  const files::GeoKeys keys = read_geo_keys(input, header);
  cloud.geographic = keys.known ? keys.geographic : steps_like_degrees(header, cloud.positions);
  return cloud;
}

}  // namespace delray::delaunay
