// Warnings of the code that the program and this package share.
#pragma once

namespace delray::python {

// From now on what is logged as a warning is kept, and the rest is dropped.
void log_to_python();

// Turns warnings that were kept into Python's. With the interpreter's lock. Throws
// pybind11::error_already_set where Python makes errors of them.
void show_warnings();

}  // namespace delray::python
