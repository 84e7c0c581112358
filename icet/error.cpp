// Errors of the interface. The code that icetGetError gives belongs to no context, and so neither
// here: the first one stays until it is asked for.
#include "icet/error.h"

#include <atomic>
#include <cstdio>
#include <new>
#include <stdexcept>

#include "comm/failure.h"
#include "icet/context.h"

namespace delray::icet {
namespace {

std::atomic<IceTEnum>& first_error() {
  static std::atomic<IceTEnum> code{ICET_NO_ERROR};
  return code;
}

void report(IceTEnum code, std::string_view text, IceTBitField severity, const char* word) {
  IceTEnum none = ICET_NO_ERROR;
  first_error().compare_exchange_strong(none, code);
  const Context* const context = current_or_none();
  const IceTBitField wanted =
      context != nullptr ? context->settings.diagnostics : Settings().diagnostics;
  const int rank = context != nullptr ? context->ranks->rank() : 0;
  constexpr IceTBitField kSeverities = ICET_DIAG_DEBUG;
  if ((wanted & kSeverities) < severity) return;
  if (rank != 0 && (wanted & ICET_DIAG_ALL_NODES) == 0) return;
  std::printf("IceT (Delray), rank %d, %s: %.*s\n", rank, word, static_cast<int>(text.size()),
              text.data());
  std::fflush(stdout);
}

}  // namespace

void raise_error(IceTEnum code, std::string_view text) noexcept {
  report(code, text, ICET_DIAG_ERRORS, "error");
}

void raise_warning(IceTEnum code, std::string_view text) noexcept {
  report(code, text, ICET_DIAG_WARNINGS, "warning");
}

void raise_error(const std::exception_ptr& error) noexcept {
  try {
    std::rethrow_exception(error);
  } catch (const Error& e) {
    raise_error(e.code(), e.what());
  } catch (const std::bad_alloc&) {
    raise_error(ICET_OUT_OF_MEMORY, "out of memory");
  } catch (const std::invalid_argument& e) {
    raise_error(ICET_INVALID_OPERATION, e.what());
  } catch (const std::exception& e) {
    raise_error(ICET_SANITY_CHECK_FAIL, e.what());
  } catch (...) {
    raise_error(ICET_SANITY_CHECK_FAIL, "unknown exception");
  }
}

}  // namespace delray::icet

extern "C" {

IceTEnum icetGetError(void) { return delray::icet::first_error().exchange(ICET_NO_ERROR); }

void icetDiagnostics(IceTBitField mask) {
  delray::icet::guarded([&] { delray::icet::current().settings.diagnostics = mask; });
}

}  // extern "C"
