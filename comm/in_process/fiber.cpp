// Stackful coroutines by Boost.Context, with a guard page below each stack. Every switch also
// exchanges the list of exceptions that are being handled and tells the sanitizers of the new
// stack.
#include "comm/in_process/fiber.h"

#include <cxxabi.h>

#include <boost/context/fiber.hpp>
#include <boost/context/protected_fixedsize_stack.hpp>
#include <cassert>
#include <cstddef>
#include <memory>
#include <utility>

#ifdef DELRAY_ASAN
#include <sanitizer/common_interface_defs.h>
#endif
#ifdef DELRAY_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace delray::comm::internal {
namespace {

// The exceptions that are being handled are a list per thread; fibers would tie their lists
// together. Layout: Itanium C++ ABI, Exception Handling, 2.2.2.
struct ExceptionState {
  void* caught = nullptr;
  unsigned int uncaught = 0;
};

void exchange_exceptions(ExceptionState& state) {
  auto* current = reinterpret_cast<ExceptionState*>(abi::__cxa_get_globals());
  std::swap(current->caught, state.caught);
  std::swap(current->uncaught, state.uncaught);
}

}  // namespace

struct Fiber::State {
  boost::context::fiber own, owner;  // the one that is not running; `own` is none when finished
  ExceptionState exceptions;         // of that one
#ifdef DELRAY_ASAN
  const void* stack = nullptr;
  const void* owner_stack = nullptr;
  std::size_t stack_bytes = 0, owner_stack_bytes = 0;
#endif
#ifdef DELRAY_TSAN
  void* own_fiber = nullptr;
  void* owner_fiber = nullptr;
#endif

  void enter() {
#ifdef DELRAY_TSAN
    owner_fiber = __tsan_get_current_fiber();
    __tsan_switch_to_fiber(own_fiber, 0);
#endif
#ifdef DELRAY_ASAN
    void* fake_stack = nullptr;
    __sanitizer_start_switch_fiber(&fake_stack, stack, stack_bytes);
#endif
    own = std::move(own).resume();
#ifdef DELRAY_ASAN
    __sanitizer_finish_switch_fiber(fake_stack, nullptr, nullptr);
#endif
  }

  // `fake_stack`: null when the fiber leaves for good.
  void announce_leaving([[maybe_unused]] void** fake_stack) const {
#ifdef DELRAY_TSAN
    __tsan_switch_to_fiber(owner_fiber, 0);
#endif
#ifdef DELRAY_ASAN
    __sanitizer_start_switch_fiber(fake_stack, owner_stack, owner_stack_bytes);
#endif
  }

  void announce_entering([[maybe_unused]] void* fake_stack) {
#ifdef DELRAY_ASAN
    __sanitizer_finish_switch_fiber(fake_stack, &owner_stack, &owner_stack_bytes);
#endif
  }
};

Fiber::Fiber(std::size_t stack_bytes, std::function<void()> body)
    : state_(std::make_unique<State>()) {
  namespace context = boost::context;
  State& state = *state_;
  context::protected_fixedsize_stack stacks(stack_bytes);
  const context::stack_context stack = stacks.allocate();
#ifdef DELRAY_ASAN
  state.stack = static_cast<const std::byte*>(stack.sp) - stack.size;
  state.stack_bytes = stack.size;
#endif
#ifdef DELRAY_TSAN
  state.own_fiber = __tsan_create_fiber(0);
#endif
  state.own = context::fiber(std::allocator_arg, context::preallocated(stack.sp, stack.size, stack),
                             stacks, [&state, body = std::move(body)](context::fiber&& owner) {
                               state.announce_entering(nullptr);
                               state.owner = std::move(owner);
                               body();
                               state.announce_leaving(nullptr);
                               return std::move(state.owner);
                             });
}

Fiber::~Fiber() {
#ifdef DELRAY_TSAN
  __tsan_destroy_fiber(state_->own_fiber);
#endif
}

void Fiber::resume() {
  assert(!finished());
  exchange_exceptions(state_->exceptions);
  state_->enter();
  exchange_exceptions(state_->exceptions);
}

void Fiber::suspend() {
  void* fake_stack = nullptr;
  state_->announce_leaving(&fake_stack);
  state_->owner = std::move(state_->owner).resume();
  state_->announce_entering(fake_stack);
}

bool Fiber::finished() const { return !state_->own; }

}  // namespace delray::comm::internal
