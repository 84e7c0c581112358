// GeoTIFF files by GDAL's driver, the only one that is registered: nothing else is opened.
#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <gdal_frmts.h>
#include <ogr_srs_api.h>

#include <array>
#include <cstring>
#include <mutex>

#include "files/error.h"
#include "image/gdal/codec.h"
#include "image/gdal/geo_tags.h"

namespace delray::image::gdal {
namespace {

constexpr GIntBig kCacheBytes = GIntBig{64} << 20;  // of blocks that GDAL holds

void set_up() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALRegister_GTiff();
    GDALSetCacheMax64(kCacheBytes);
    CPLSetErrorHandler(CPLQuietErrorHandler);  // what it says is in our exceptions
  });
}

class TiffWriter : public Writer {
 public:
  TiffWriter(const std::filesystem::path& file, std::string name, const GeoRaster& raster)
      : name_(std::move(name)) {
    set_up();
    const std::string block = std::to_string(raster.block);
    char** options = nullptr;
    options = CSLSetNameValue(options, "TILED", "YES");
    options = CSLSetNameValue(options, "BLOCKXSIZE", block.c_str());
    options = CSLSetNameValue(options, "BLOCKYSIZE", block.c_str());
    options = CSLSetNameValue(options, "BIGTIFF", "IF_SAFER");
    CPLErrorReset();
    dataset_ =
        GDALCreate(GDALGetDriverByName("GTiff"), file.c_str(), static_cast<int>(raster.width),
                   static_cast<int>(raster.height), 1, GDT_Float32, options);
    CSLDestroy(options);
    if (dataset_ == nullptr) fail();
    std::array<double, 6> to_ground = {raster.west, raster.cell, 0, raster.north, 0, -raster.cell};
    check(GDALSetGeoTransform(dataset_, to_ground.data()));
    band_ = GDALGetRasterBand(dataset_, 1);
    check(GDALSetRasterNoDataValue(band_, static_cast<double>(raster.no_data)));
    set_coordinate_system(raster.coordinate_system);
  }
  ~TiffWriter() override {
    if (dataset_ != nullptr) GDALClose(dataset_);
  }
  TiffWriter(const TiffWriter&) = delete;
  TiffWriter& operator=(const TiffWriter&) = delete;

  const std::string& warning() const override { return warning_; }
  void write_block(int column, int row, std::span<const float> pixels) override {
    // GDAL takes, and does not change, what is not const.
    check(GDALWriteBlock(band_, column, row, const_cast<float*>(pixels.data())));
  }
  void close() override {
    CPLErrorReset();
    GDALFlushCache(dataset_);
    const bool flushed = CPLGetLastErrorType() < CE_Failure;
    GDALClose(std::exchange(dataset_, nullptr));
    if (!flushed || CPLGetLastErrorType() >= CE_Failure) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw files::FileError(files::Cause::device, name_, "",
                           std::string("cannot write: ") + CPLGetLastErrorMsg());
  }
  void check(CPLErr error) const {
    if (error >= CE_Failure) fail();
  }

  void set_coordinate_system(const files::CoordinateSystem& system) {
    if (system.empty()) return;
    const OGRSpatialReferenceH reference = read_coordinate_system(system);
    if (reference == nullptr || GDALSetSpatialRef(dataset_, reference) >= CE_Failure) {
      warning_ = "its coordinate system is left out: GDAL does not know what it is";
    }
    if (reference != nullptr) OSRRelease(reference);
    CPLErrorReset();
  }

  std::string name_, warning_;
  GDALDatasetH dataset_ = nullptr;
  GDALRasterBandH band_ = nullptr;
};

std::unique_ptr<Writer> create(const std::filesystem::path& file, const std::string& name,
                               const GeoRaster& raster) {
  return std::make_unique<TiffWriter>(file, name, raster);
}

}  // namespace
}  // namespace delray::image::gdal

// Found by its name: gdal::kEntry.
extern "C" const delray::image::gdal::Codec* delray_gdal_codec() {
  static constexpr delray::image::gdal::Codec kCodec = {.create = delray::image::gdal::create};
  return &kCodec;
}
