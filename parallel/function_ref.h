// A callable that is borrowed for the time of a call, of two words and without allocation: what a
// function that is not a template takes for "call this".
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace delray::parallel {

template <class Signature>
class FunctionRef;

// REQUIRES: the callable outlives the reference.
template <class Result, class... Args>
class FunctionRef<Result(Args...)> {
 public:
  template <class F>
  requires(!std::is_same_v<std::remove_cvref_t<F>, FunctionRef> &&
           std::is_invocable_r_v<Result, F&, Args...>)
      FunctionRef(
          F&& f)  // NOLINT(google-explicit-constructor): a lambda is passed where one is taken
      : callable_(const_cast<void*>(static_cast<const void*>(std::addressof(f)))),
        call_([](void* callable, Args... args) -> Result {
          return (*static_cast<std::remove_reference_t<F>*>(callable))(std::forward<Args>(args)...);
        }) {}

  Result operator()(Args... args) const { return call_(callable_, std::forward<Args>(args)...); }

 private:
  void* callable_;
  Result (*call_)(void*, Args...);
};

}  // namespace delray::parallel
