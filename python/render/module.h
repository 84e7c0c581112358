// The parts that the module `delray._render` is made of.
#pragma once

#include <pybind11/pybind11.h>

namespace delray::python {

void add_scene(pybind11::module_& module);
void add_renderer(pybind11::module_& module);
void add_communicator(pybind11::module_& module);
void add_compare(pybind11::module_& module);

}  // namespace delray::python
