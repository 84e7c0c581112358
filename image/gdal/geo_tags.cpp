// Well-known text goes to GDAL as it is; GeoTIFF's keys as the tags of a picture of one pixel in
// memory, as it has no other door for them.
#include "image/gdal/geo_tags.h"

#include <cpl_vsi.h>
#include <gdal.h>

#include <algorithm>
#include <string>
#include <vector>

namespace delray::image::gdal {
namespace {

// A TIFF of one pixel (Adobe, TIFF 6.0) with tags of its own, little-endian.
class TinyTiff {
 public:
  TinyTiff() {
    constexpr std::uint16_t kShort = 3, kLong = 4;
    for (const std::uint16_t tag : {256, 257, 258, 259, 262, 277, 278}) {
      // Width, length, bits, no compression, black is zero, samples and rows: 1, but 8 bits.
      add(tag, kShort, 1, pack<std::uint32_t>(tag == 258 ? 8 : 1));
    }
    add(273, kLong, 1, pack<std::uint32_t>(kPixelAt));
    add(279, kLong, 1, pack<std::uint32_t>(1));
  }
  // By ascending tags, above those of the pixel.
  void add(std::uint16_t tag, std::uint16_t type, std::size_t count, std::string value) {
    tags_.push_back({tag, type, static_cast<std::uint32_t>(count), std::move(value)});
  }
  std::string bytes() {
    std::sort(tags_.begin(), tags_.end(), [](const Tag& a, const Tag& b) { return a.tag < b.tag; });
    constexpr std::size_t kHead = 12, kEntry = 12;
    std::string out = std::string("II*\0", 4) + pack<std::uint32_t>(kHead);
    out.resize(kHead);  // the pixel is among these
    std::string values;
    const std::size_t values_at = kHead + 2 + tags_.size() * kEntry + 4;
    out += pack(static_cast<std::uint16_t>(tags_.size()));
    for (const Tag& tag : tags_) {
      out += pack(tag.tag) + pack(tag.type) + pack(tag.count);
      if (tag.value.size() <= 4) {
        out += tag.value + std::string(4 - tag.value.size(), '\0');
      } else {
        out += pack(static_cast<std::uint32_t>(values_at + values.size()));
        values += tag.value;
        values.resize((values.size() + 7) / 8 * 8);
      }
    }
    return out + pack(std::uint32_t{0}) + values;
  }
  template <class T>
  static std::string pack(T value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
  }

 private:
  static constexpr std::uint32_t kPixelAt = 8;
  struct Tag {
    std::uint16_t tag, type;
    std::uint32_t count;
    std::string value;
  };
  std::vector<Tag> tags_;
};

template <class T>
std::string packed(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

OGRSpatialReferenceH of_raster(const char* name) {
  const char* const drivers[] = {"GTiff", nullptr};
  const GDALDatasetH dataset =
      GDALOpenEx(name, GDAL_OF_RASTER | GDAL_OF_READONLY, drivers, nullptr, nullptr);
  if (dataset == nullptr) return nullptr;
  const OGRSpatialReferenceH found = GDALGetSpatialRef(dataset);
  const OGRSpatialReferenceH copy = found == nullptr ? nullptr : OSRClone(found);
  GDALClose(dataset);
  return copy;
}

OGRSpatialReferenceH of_geo_keys(const files::CoordinateSystem& system) {
  constexpr std::uint16_t kAscii = 2, kShort = 3, kDouble = 12;
  TinyTiff tiff;
  tiff.add(34735, kShort, system.geo_keys.size(), packed(system.geo_keys));
  if (!system.geo_numbers.empty()) {
    tiff.add(34736, kDouble, system.geo_numbers.size(), packed(system.geo_numbers));
  }
  if (!system.geo_texts.empty()) {
    tiff.add(34737, kAscii, system.geo_texts.size(), system.geo_texts);
  }
  std::string bytes = tiff.bytes();
  const char* const name = "/vsimem/delray_geo_keys.tif";
  VSILFILE* const file =
      VSIFileFromMemBuffer(name, reinterpret_cast<GByte*>(bytes.data()), bytes.size(), FALSE);
  if (file == nullptr) return nullptr;
  VSIFCloseL(file);
  const OGRSpatialReferenceH found = of_raster(name);
  VSIUnlink(name);
  return found;
}

OGRSpatialReferenceH of_text(const std::string& text) {
  const OGRSpatialReferenceH reference = OSRNewSpatialReference(nullptr);
  std::string copy = text;
  char* at = copy.data();
  if (OSRImportFromWkt(reference, &at) == OGRERR_NONE) return reference;
  OSRRelease(reference);
  return nullptr;
}

}  // namespace

OGRSpatialReferenceH read_coordinate_system(const files::CoordinateSystem& system) {
  OGRSpatialReferenceH found = nullptr;
  if (!system.well_known_text.empty()) found = of_text(system.well_known_text);
  if (found == nullptr && !system.geo_keys.empty()) found = of_geo_keys(system);
  if (found == nullptr && !system.raster.empty()) found = of_raster(system.raster.c_str());
  return found;
}

}  // namespace delray::image::gdal
