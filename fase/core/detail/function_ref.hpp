#pragma once
/// A non-owning reference to a callable.
#include <memory>
#include <type_traits>
#include <utility>

namespace fase {

template <class Signature> class FunctionRef;

/// Refers to a callable that outlives the call that receives it; two pointers, copied by value, never empty. For
/// callbacks through non-template code; a template parameter is faster where one is possible.
template <class Result, class... Arguments> class FunctionRef<Result(Arguments...)> {
public:
    template <class F>
    requires(!std::is_same_v<std::remove_cvref_t<F>, FunctionRef> && std::is_invocable_r_v<Result, F&, Arguments...> &&
             !std::is_function_v<std::remove_reference_t<F>>)
        FunctionRef(F&& callable)  // NOLINT(google-explicit-constructor): callers pass any callable
        : object_(const_cast<void*>(static_cast<const void*>(std::addressof(callable)))),
          call_([](void* object, Arguments... arguments) -> Result {
              return (*static_cast<std::remove_reference_t<F>*>(object))(std::forward<Arguments>(arguments)...);
          }) {}

    Result operator()(Arguments... arguments) const { return call_(object_, std::forward<Arguments>(arguments)...); }

private:
    void* object_;
    Result (*call_)(void*, Arguments...);
};

}  // namespace fase
