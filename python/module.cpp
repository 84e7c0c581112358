// The module `delray._delray`: triangulations; what the Python half of the package, delray/, calls.
#include "python/module.h"

#include "python/errors.h"

PYBIND11_MODULE(_delray, module) {
  module.doc() = "Compiled half of the package delray; use that.";
  module.attr("__version__") = DELRAY_VERSION;
  delray::python::translate_errors();
  delray::python::add_triangulation(module);
  delray::python::add_dynamic(module);
  delray::python::add_points(module);
}
