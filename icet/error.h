// IceT's error mechanism: the first error since icetGetError was asked, and messages on standard
// output.
#pragma once

#include <exception>
#include <string>
#include <string_view>
#include <utility>

#include "icet/interface.h"

namespace delray::icet {

// What a function of the interface ends with; guarded() reports it.
class Error : public std::exception {
 public:
  Error(IceTEnum code, std::string text) : code_(code), text_(std::move(text)) {}
  IceTEnum code() const { return code_; }
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  IceTEnum code_;
  std::string text_;
};

// Keep the code, unless there is one that nobody has asked for yet, and print the text where the
// diagnostics of the current context say so. Never throw.
void raise_error(IceTEnum code, std::string_view text) noexcept;
void raise_warning(IceTEnum code, std::string_view text) noexcept;
// The one of an exception: Error's own, ICET_OUT_OF_MEMORY, ICET_INVALID_OPERATION for arguments
// that ranks do not agree on, ICET_SANITY_CHECK_FAIL for what should not have happened.
void raise_error(const std::exception_ptr& error) noexcept;

// What f returns, or `otherwise` where it throws: no exception passes.
template <class F>
auto guarded(F&& f) noexcept -> decltype(f()) {
  try {
    return f();
  } catch (...) {
    raise_error(std::current_exception());
    return decltype(f())();
  }
}

}  // namespace delray::icet
