// GeoTIFFs beside their names, by the library that knows GDAL.
#include "image/write_geotiff.h"

#include <dlfcn.h>

#include "files/atomic_file.h"
#include "files/error.h"
#include "image/gdal/codec.h"

namespace delray::image {
namespace {

const gdal::Codec& gdal_codec() {
  using Entry = const gdal::Codec* (*)();
  static const gdal::Codec* const loaded = [] {
    // Never unloaded: what it brings registers itself.
    void* library = ::dlopen(gdal::kLibrary, RTLD_LAZY | RTLD_LOCAL);
    void* entry = library ? ::dlsym(library, gdal::kEntry) : nullptr;
    if (!entry) {
      throw files::FileError(files::Cause::device, gdal::kLibrary, "",
                             std::string("cannot be loaded: ") + ::dlerror());
    }
    return reinterpret_cast<Entry>(entry)();
  }();
  return *loaded;
}

}  // namespace

struct GeoTiffWriter::State {
  State(const std::filesystem::path& path, const GeoRaster& raster)
      : file(path), writer(gdal_codec().create(file.temporary(), path.string(), raster)) {}
  files::AtomicFile file;
  std::unique_ptr<gdal::Writer> writer;  // ends before its file
};

GeoTiffWriter::GeoTiffWriter(const std::filesystem::path& path, const GeoRaster& raster)
    : state_(std::make_unique<State>(path, raster)) {}
GeoTiffWriter::~GeoTiffWriter() = default;

const std::string& GeoTiffWriter::warning() const { return state_->writer->warning(); }

void GeoTiffWriter::write_block(std::uint64_t column, std::uint64_t row,
                                std::span<const float> pixels) {
  state_->writer->write_block(static_cast<int>(column), static_cast<int>(row), pixels);
}

void GeoTiffWriter::commit() {
  state_->writer->close();
  state_->file.commit();
}

}  // namespace delray::image
