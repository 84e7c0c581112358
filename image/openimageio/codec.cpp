// The entry point of the codec's library: the table of its functions.
#include "image/openimageio/codec.h"

// Found by its name: openimageio::kEntry.
extern "C" const delray::image::openimageio::Codec* delray_openimageio_codec() {
  using namespace delray::image;
  static constexpr openimageio::Codec kCodec = {
      .read_info = openimageio::read_info,
      .read_picture = openimageio::read_picture,
      .read_texels = openimageio::read_texels,
      .read_float_channels = openimageio::read_float_channels,
      .write_exr = openimageio::write_exr,
      .write_tiff = openimageio::write_tiff,
      .encode_jpeg = openimageio::encode_jpeg,
      .open_rows = openimageio::open_rows,
  };
  return &kCodec;
}
