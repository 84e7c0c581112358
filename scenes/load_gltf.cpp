#include "scenes/internal/load_gltf.h"

namespace delray::scenes::internal {

Scene load_gltf(const Source& source) { source.fail("", "glTF cannot be read yet"); }

}  // namespace delray::scenes::internal
