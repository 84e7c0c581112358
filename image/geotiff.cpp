// A TIFF file (Adobe, TIFF 6.0; BigTIFF) names in its header where its first directory lies: a list
// of tags, each with a type, a count, and its values or where they are. OpenImageIO hands out none
// of those that GeoTIFF adds.
#include "image/geotiff.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>
#include <string_view>
#include <vector>

#include "files/geo_keys.h"
#include "files/read_file.h"

namespace delray::image {
namespace {

enum GeoTag : std::uint16_t {
  kPixelScale = 33550,
  kTiepoint = 33922,
  kTransformation = 34264,
  kGeoKeyDirectory = 34735,
  kNoData = 42113,
};
enum GeoType : std::uint16_t { kAscii = 2, kShort = 3, kDouble = 12 };

constexpr std::uint64_t kMostValues = 1 << 16;  // what is more is no tag of these
constexpr std::uint64_t kMostTags = 1 << 16;

class TiffTags {
 public:
  TiffTags(const std::filesystem::path& path, const files::MemoryBudget& memory) {
    if (files::is_stream(path)) {
      constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
      file_ = std::make_unique<std::istringstream>(files::read_start(path, kAll, memory));
    } else {
      file_ = std::make_unique<std::ifstream>(path, std::ios::binary);
    }
    char mark[8] = {};
    if (!read(0, mark, sizeof mark)) return;
    const bool little = mark[0] == 'I' && mark[1] == 'I';
    if (!little && !(mark[0] == 'M' && mark[1] == 'M')) return;
    swap_ = little != (std::endian::native == std::endian::little);
    const auto version = value<std::uint16_t>(mark + 2);
    if (version != 42 && version != 43) return;
    big_ = version == 43;
    directory_ = big_ ? at<std::uint64_t>(8) : value<std::uint32_t>(mark + 4);
    tags_ = big_ ? at<std::uint64_t>(directory_) : at<std::uint16_t>(directory_);
    tags_ = std::min(tags_, kMostTags);
  }

  // The values of a tag; none if it is not there or of another type.
  template <class T>
  std::vector<T> find(std::uint16_t tag, std::uint16_t type) {
    const std::uint64_t entry_size = big_ ? 20 : 12, first = directory_ + (big_ ? 8 : 2);
    for (std::uint64_t i = 0; i < tags_; ++i) {
      const std::uint64_t entry = first + i * entry_size;
      if (at<std::uint16_t>(entry) != tag || at<std::uint16_t>(entry + 2) != type) continue;
      const std::uint64_t count =
          big_ ? at<std::uint64_t>(entry + 4) : at<std::uint32_t>(entry + 4);
      if (count == 0 || count > kMostValues) return {};
      const std::uint64_t place = entry + (big_ ? 12 : 8);
      const std::uint64_t inlined = big_ ? 8 : 4;
      const std::uint64_t begin = count * sizeof(T) <= inlined ? place
                                  : big_                       ? at<std::uint64_t>(place)
                                                               : at<std::uint32_t>(place);
      std::vector<char> bytes(count * sizeof(T));
      if (!read(begin, bytes.data(), bytes.size())) return {};
      std::vector<T> values(count);
      for (std::size_t k = 0; k < count; ++k) values[k] = value<T>(bytes.data() + k * sizeof(T));
      return values;
    }
    return {};
  }

 private:
  bool read(std::uint64_t byte, char* to, std::size_t size) {
    constexpr std::uint64_t kFarthest = std::uint64_t{1} << 62;
    if (byte > kFarthest) return false;
    file_->clear();
    file_->seekg(static_cast<std::streamoff>(byte));
    return static_cast<bool>(file_->read(to, static_cast<std::streamsize>(size)));
  }

  template <class T>
  T value(const char* bytes) const {
    char ordered[sizeof(T)];
    std::copy_n(bytes, sizeof(T), ordered);
    if (swap_) std::reverse(ordered, ordered + sizeof(T));
    T result;
    std::memcpy(&result, ordered, sizeof result);
    return result;
  }

  // 0 beyond the end of the file.
  template <class T>
  T at(std::uint64_t byte) {
    char bytes[sizeof(T)] = {};
    return read(byte, bytes, sizeof bytes) ? value<T>(bytes) : T{};
  }

  std::unique_ptr<std::istream> file_;
  bool swap_ = false, big_ = false;
  std::uint64_t directory_ = 0, tags_ = 0;
};

bool usable(const glm::dmat3x2& m) {
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(m[i].x) || !std::isfinite(m[i].y)) return false;
  }
  return m[0].x * m[1].y != m[0].y * m[1].x;
}

// From the coordinates of pixel corners, counted from the left upper one.
std::optional<glm::dmat3x2> ground_of(TiffTags& tags) {
  glm::dmat3x2 m;
  if (const auto matrix = tags.find<double>(kTransformation, kDouble); matrix.size() >= 16) {
    m = {matrix[0], matrix[4], matrix[1], matrix[5], matrix[3], matrix[7]};
  } else {
    const auto scale = tags.find<double>(kPixelScale, kDouble);
    const auto tie = tags.find<double>(kTiepoint, kDouble);  // column, row, 0, x, y, z
    if (scale.size() < 2 || tie.size() < 6) return std::nullopt;
    m = {scale[0], 0, 0, -scale[1], tie[3] - tie[0] * scale[0], tie[4] + tie[1] * scale[1]};
  }
  if (!usable(m)) return std::nullopt;
  return m;
}

}  // namespace

GeoTiff read_geotiff(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  TiffTags tags(path, memory);
  GeoTiff result;
  result.to_ground = ground_of(tags);
  const files::GeoKeys keys =
      files::parse_geo_keys(tags.find<std::uint16_t>(kGeoKeyDirectory, kShort));
  result.geographic = result.to_ground && keys.geographic;
  if (result.to_ground && !keys.pixel_is_point) {
    glm::dmat3x2& m = *result.to_ground;
    m[2] += (m[0] + m[1]) * 0.5;
  }
  const std::vector<char> characters = tags.find<char>(kNoData, kAscii);
  std::string_view text(characters.data(), characters.size());
  text = text.substr(0, text.find('\0'));
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  double value = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec == std::errc()) result.no_data = value;
  return result;
}

}  // namespace delray::image
