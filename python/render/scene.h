// A scene that Python fills.
#pragma once

#include <pybind11/numpy.h>

#include "scenes/scene.h"

namespace delray::python {

// Behind delray.Scene.
struct SceneHandle {
  scenes::Scene scene;
};

}  // namespace delray::python
