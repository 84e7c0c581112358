#include "comm/internal/fiber.h"

#include <cxxabi.h>
#include <sys/mman.h>
#include <ucontext.h>
#include <unistd.h>

#include <cassert>
#include <cstdint>
#include <new>
#include <utility>

#if defined(__SANITIZE_ADDRESS__)
#define DELRAY_FIBER_ASAN 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define DELRAY_FIBER_ASAN 1
#endif
#endif
#if defined(__SANITIZE_THREAD__)
#define DELRAY_FIBER_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define DELRAY_FIBER_TSAN 1
#endif
#endif

#if defined(DELRAY_FIBER_ASAN)
#include <sanitizer/common_interface_defs.h>
#endif
#if defined(DELRAY_FIBER_TSAN)
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
  std::function<void()> body;
  bool finished = false;
  ucontext_t own{}, owner{};
  ExceptionState exceptions;  // of whichever side is not running
  void* memory = nullptr;     // a guard page, then the stack
  std::size_t memory_bytes = 0, guard_bytes = 0;
#if defined(DELRAY_FIBER_ASAN)
  const void* owner_stack = nullptr;
  std::size_t owner_stack_bytes = 0;
#endif
#if defined(DELRAY_FIBER_TSAN)
  void* own_fiber = nullptr;
  void* owner_fiber = nullptr;
#endif

  void* stack() const { return static_cast<std::byte*>(memory) + guard_bytes; }
  std::size_t stack_bytes() const { return memory_bytes - guard_bytes; }

  void enter() {
#if defined(DELRAY_FIBER_TSAN)
    owner_fiber = __tsan_get_current_fiber();
    __tsan_switch_to_fiber(own_fiber, 0);
#endif
#if defined(DELRAY_FIBER_ASAN)
    void* fake_stack = nullptr;
    __sanitizer_start_switch_fiber(&fake_stack, stack(), stack_bytes());
#endif
    swapcontext(&owner, &own);
#if defined(DELRAY_FIBER_ASAN)
    __sanitizer_finish_switch_fiber(fake_stack, nullptr, nullptr);
#endif
  }

  void leave(bool for_good) {
#if defined(DELRAY_FIBER_TSAN)
    __tsan_switch_to_fiber(owner_fiber, 0);
#endif
#if defined(DELRAY_FIBER_ASAN)
    void* fake_stack = nullptr;
    __sanitizer_start_switch_fiber(for_good ? nullptr : &fake_stack, owner_stack,
                                   owner_stack_bytes);
#endif
    (void)for_good;
    swapcontext(&own, &owner);
#if defined(DELRAY_FIBER_ASAN)
    __sanitizer_finish_switch_fiber(fake_stack, &owner_stack, &owner_stack_bytes);
#endif
  }

  // makecontext hands over ints only.
  static void start(unsigned int high, unsigned int low) {
    auto* state = reinterpret_cast<State*>((static_cast<std::uintptr_t>(high) << 32) | low);
#if defined(DELRAY_FIBER_ASAN)
    __sanitizer_finish_switch_fiber(nullptr, &state->owner_stack, &state->owner_stack_bytes);
#endif
    state->body();
    state->finished = true;
    state->leave(true);
  }
};

Fiber::Fiber(std::size_t stack_bytes, std::function<void()> body)
    : state_(std::make_unique<State>()) {
  State& state = *state_;
  state.body = std::move(body);
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  state.guard_bytes = page;
  state.memory_bytes = page + (stack_bytes + page - 1) / page * page;
  state.memory = mmap(nullptr, state.memory_bytes, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_STACK, -1, 0);
  if (state.memory == MAP_FAILED) throw std::bad_alloc();
  mprotect(state.memory, page, PROT_NONE);
  getcontext(&state.own);
  state.own.uc_stack.ss_sp = state.stack();
  state.own.uc_stack.ss_size = state.stack_bytes();
  state.own.uc_link = nullptr;
  const auto address = reinterpret_cast<std::uintptr_t>(&state);
  static_assert(sizeof(void*) == 8);
  makecontext(&state.own, reinterpret_cast<void (*)()>(&State::start), 2,
              static_cast<unsigned int>(address >> 32), static_cast<unsigned int>(address));
#if defined(DELRAY_FIBER_TSAN)
  state.own_fiber = __tsan_create_fiber(0);
#endif
}

Fiber::~Fiber() {
#if defined(DELRAY_FIBER_TSAN)
  __tsan_destroy_fiber(state_->own_fiber);
#endif
  munmap(state_->memory, state_->memory_bytes);
}

void Fiber::resume() {
  assert(!state_->finished);
  exchange_exceptions(state_->exceptions);
  state_->enter();
  exchange_exceptions(state_->exceptions);
}

void Fiber::suspend() { state_->leave(false); }

bool Fiber::finished() const { return state_->finished; }

}  // namespace delray::comm::internal
