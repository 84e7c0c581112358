// The module `delray._render`: scenes, pictures, compositing and comparisons. A module of its own,
// so that triangulating loads neither Embree nor MPI.
#include "python/render/module.h"

#include "python/errors.h"
#include "python/render/log.h"

PYBIND11_MODULE(_render, module) {
  module.doc() = "Compiled half of the package delray; use that.";
  delray::python::translate_errors();
  delray::python::log_to_python();
  delray::python::add_scene(module);
  delray::python::add_renderer(module);
  delray::python::add_communicator(module);
  delray::python::add_compare(module);
}
