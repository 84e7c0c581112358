// Exceptions of the libraries as those of Python.
#pragma once

namespace delray::python {

// In the module that is being made: broken input becomes ValueError, a file that is not there
// FileNotFoundError, a device that fails OSError, what is too large MemoryError, a wish to stop
// KeyboardInterrupt, a rank that was lost RuntimeError, with their texts.
void translate_errors();

}  // namespace delray::python
