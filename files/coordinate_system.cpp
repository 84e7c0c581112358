// The records of a LAS file that tell of its coordinates (ASPRS LAS 1.4, 2.5 and 3): well-known
// text, or the keys of GeoTIFF.
#include "files/coordinate_system.h"

#include <cstring>
#include <fstream>

#include "files/read_file.h"

namespace delray::files {
namespace {

constexpr std::size_t kHeaderSizeAt = 94, kRecordsAt = 100;  // bytes of the LAS header
constexpr std::size_t kRecordHead = 54;
constexpr std::uint16_t kGeoKeys = 34735, kGeoDoubles = 34736, kGeoTexts = 34737, kText = 2112;

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

template <class T>
std::vector<T> numbers_of(const std::string& bytes) {
  std::vector<T> numbers(bytes.size() / sizeof(T));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(T));
  return numbers;
}

bool read_bytes(std::istream& file, std::size_t count, std::string& bytes) {
  bytes.resize(count);
  return static_cast<bool>(file.read(bytes.data(), static_cast<std::streamsize>(count)));
}

}  // namespace

CoordinateSystem read_las_coordinate_system(const std::filesystem::path& path) {
  CoordinateSystem system;
  if (is_stream(path)) return system;
  std::ifstream file(path, std::ios::binary);
  std::string bytes;
  if (!read_bytes(file, kRecordsAt + 4, bytes) || !bytes.starts_with("LASF")) return system;
  const auto records = number_at<std::uint32_t>(bytes, kRecordsAt);
  file.seekg(number_at<std::uint16_t>(bytes, kHeaderSizeAt));
  for (std::uint32_t i = 0; i < records && read_bytes(file, kRecordHead, bytes); ++i) {
    const bool is_projection = bytes.substr(2, 16).starts_with("LASF_Projection");
    const auto kind = number_at<std::uint16_t>(bytes, 18);
    if (!read_bytes(file, number_at<std::uint16_t>(bytes, 20), bytes)) break;
    if (!is_projection) continue;
    if (kind == kText) system.well_known_text = bytes.substr(0, bytes.find('\0'));
    if (kind == kGeoKeys) system.geo_keys = numbers_of<std::uint16_t>(bytes);
    if (kind == kGeoDoubles) system.geo_numbers = numbers_of<double>(bytes);
    if (kind == kGeoTexts) system.geo_texts = bytes;
  }
  return system;
}

}  // namespace delray::files
