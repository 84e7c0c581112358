// FileError is OSError where a device fails and ValueError where content is wrong, with the same
// text.
#include "python/errors.h"

#include <pybind11/pybind11.h>

#include <exception>
#include <filesystem>

#include "files/error.h"
#include "parallel/progress.h"

namespace delray::python {
namespace {

using files::Cause;

// Who looks for a file that may not be there catches OSError.
PyObject* type_of(const files::FileError& error) {
  if (error.cause() == Cause::memory) return PyExc_MemoryError;
  if (error.cause() == Cause::device) return PyExc_OSError;
  std::error_code ignored;
  const bool is_there = error.file() == "-" || std::filesystem::exists(error.file(), ignored);
  return is_there ? PyExc_ValueError : PyExc_FileNotFoundError;
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const files::FileError& error) {
    PyErr_SetString(type_of(error), error.what());
  } catch (const parallel::Interrupted&) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
  }
}

}  // namespace

void translate_errors() { pybind11::register_local_exception_translator(translate); }

}  // namespace delray::python
