// One catch for each kind of exception, the most special first.
#include "c/guard.h"

#include <new>
#include <stdexcept>
#include <string>

#include "comm/bad_message.h"
#include "comm/failure.h"
#include "files/error.h"
#include "parallel/progress.h"

namespace delray::c {
namespace {

// The text of a thread's last failure.
std::string& error_text() {
  thread_local std::string text;
  return text;
}

DelrayStatus code_of(const files::FileError& error) {
  switch (error.cause()) {
    case files::Cause::input:
      return DELRAY_INVALID_INPUT;
    case files::Cause::device:
      return DELRAY_DEVICE_FAILED;
    case files::Cause::memory:
      return DELRAY_OUT_OF_MEMORY;
  }
  return DELRAY_INTERNAL;
}

}  // namespace

DelrayStatus failed(std::exception_ptr error) noexcept {
  const auto keep = [](const char* text, DelrayStatus status) {
    try {
      error_text() = text;
    } catch (...) {  // no memory for it
      error_text().clear();
    }
    return status;
  };
  try {
    std::rethrow_exception(error);
  } catch (const files::FileError& e) {
    return keep(e.what(), code_of(e));
  } catch (const std::invalid_argument& e) {
    return keep(e.what(), DELRAY_INVALID_ARGUMENT);
  } catch (const std::bad_alloc&) {
    return keep("out of memory", DELRAY_OUT_OF_MEMORY);
  } catch (const parallel::Interrupted& e) {
    return keep(e.what(), DELRAY_INTERRUPTED);
  } catch (const comm::RankFailure& e) {
    return keep(e.what(), DELRAY_RANK_LOST);
  } catch (const std::exception& e) {
    return keep(e.what(), DELRAY_INTERNAL);
  } catch (...) {
    return keep("unknown error", DELRAY_INTERNAL);
  }
}

void require(const void* argument, const char* name) {
  if (argument == nullptr) throw std::invalid_argument(std::string(name) + " is NULL");
}

}  // namespace delray::c

extern "C" {

int delrayApiVersion(void) { return DELRAY_API_VERSION; }
const char* delrayVersion(void) { return DELRAY_VERSION; }
const char* delrayErrorText(void) { return delray::c::error_text().c_str(); }

}  // extern "C"
