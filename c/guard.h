// Where C++ ends: exceptions become codes and texts.
#pragma once

#include <exception>
#include <type_traits>

#include "c/delray.h"

namespace delray::c {

// Keeps what an exception says as this thread's text, and returns its code. Never throws.
DelrayStatus failed(std::exception_ptr error) noexcept;

// DELRAY_SUCCESS, or the code of what f throws.
template <class F>
DelrayStatus guarded(F&& f) noexcept {
  try {
    f();
    return DELRAY_SUCCESS;
  } catch (...) {
    return failed(std::current_exception());
  }
}

// What f returns, or nothing (null, 0) where it throws.
template <class F>
auto guarded_value(F&& f) noexcept -> std::invoke_result_t<F> {
  try {
    return f();
  } catch (...) {
    failed(std::current_exception());
    return {};
  }
}

// Throws std::invalid_argument unless it is there.
void require(const void* argument, const char* name);

}  // namespace delray::c
