// The parts that the module `delray._delray` is made of.
#pragma once

#include <pybind11/pybind11.h>

namespace delray::python {

void add_triangulation(pybind11::module_& module);
void add_dynamic(pybind11::module_& module);
void add_points(pybind11::module_& module);

}  // namespace delray::python
